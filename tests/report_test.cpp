// SPDX-License-Identifier: Apache-2.0
// The report of `chromeball compare` in a browser, if one is installed.
#include <gtest/gtest.h>

#include <fstream>

#include "browser.h"
#include "image/io/write_image.h"
#include "probe/synth.h"
#include "regular_expression.h"
#include "run_command.h"
#include "small_model.h"

namespace chromeball::report_test {
namespace {

// Records errors of the page's scripts.
constexpr const char* kWatch = R"(<script>
  window.failures = [];
  addEventListener('error', e => failures.push(e.message));
  addEventListener('unhandledrejection', e => failures.push(String(e.reason)));
</script>)";

// When the page is ready: clicks the flip button, moves the mouse over the viewer and a map, and
// appends the results to the page.
constexpr const char* kUse = R"(<script>
  const pixels = () => {
    const canvas = document.querySelector('#viewer canvas');
    return canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.join();
  };
  const move = element => {
    const box = element.getBoundingClientRect();
    element.dispatchEvent(new MouseEvent('mousemove', {
      clientX: box.left + box.width / 2, clientY: box.top + box.height / 2, bubbles: true}));
    return document.getElementById('tip').textContent;
  };
  const wait = setInterval(() => {
    if (document.body.dataset.ready !== 'yes' && failures.length === 0) return;
    clearInterval(wait);
    const verdict = {};
    const divided = pixels();
    document.getElementById('flip').click();
    const a = pixels(), nameA = document.getElementById('nameA').textContent;
    document.getElementById('flip').click();
    const b = pixels(), nameB = document.getElementById('nameB').textContent;
    document.getElementById('flip').click();
    verdict.flips = a !== b && a !== divided && pixels() === a;
    verdict.names = nameA + ' | ' + nameB;
    const stops = document.getElementById('exposure');
    stops.value = 3;
    stops.dispatchEvent(new Event('input'));
    verdict.exposes = pixels() !== a;
    verdict.tip = move(document.querySelector('#viewer canvas'));
    verdict.mapTip = move(document.querySelector('#errors canvas'));
    verdict.curves = [...document.querySelectorAll('#plots svg')]
        .map(svg => svg.querySelectorAll('.series').length).join();
    verdict.rows = document.querySelectorAll('#results tbody tr').length;
    verdict.maps = document.querySelectorAll('#errors canvas').length;
    verdict.biases = document.querySelectorAll('#bias canvas').length;
    verdict.probes = document.querySelectorAll('.probe svg').length;
    verdict.failures = failures.join('; ');
    const pre = document.createElement('pre');
    pre.id = 'verdict';
    pre.textContent = Object.entries(verdict).map(([k, v]) => `<${k}: ${v}>`).join('\n');
    document.body.append(pre);
  }, 20);
</script>)";

TEST(SlowReport, worksInABrowser) {
  const std::string chromium = findChromium();
  if (chromium.empty()) GTEST_SKIP() << kNoChromium;
  const TemporaryFolder folder;
  writeSmallModel(folder / "plate.gltf");
  writeImage(folder / "probe.exr", gradientProbe({32, 16}, Rgb(0.5f), {0.3, 0.6, 0.6}));
  ASSERT_EQ(runCommand({"compare", folder / "plate.gltf", "--probe", folder / "probe.exr", "--size",
                        "24x16", "-o", folder / "report", "--quiet", "--strategies",
                        "bsdf,importance,median-cut:4", "--samples", "1,4", "--repeats", "3",
                        "--reference-samples", "64"})
                .status,
            0);
  std::string page = fileContents(folder / "report/index.html");
  EXPECT_EQ(page.find("{{"), std::string::npos) << "a placeholder was not replaced";
  EXPECT_FALSE(containsMatch(page, R"((src|href)="?(http|//))"))
      << "the page must be self-contained";
  page.replace(page.find("<head>"), 6, std::string("<head>") + kWatch);
  page.replace(page.rfind("</body>"), 7, std::string(kUse) + "</body>");
  std::ofstream(folder / "page.html") << page;

  const std::string dom = dumpedPage(chromium, folder, "file://" + (folder / "page.html"));
  const auto hasResult = [&](const std::string& verdict) {
    return dom.find("&lt;" + verdict) != std::string::npos;
  };
  const size_t verdict = dom.find("<pre id=\"verdict\">");
  ASSERT_NE(verdict, std::string::npos) << fileContents(folder / "log");
  SCOPED_TRACE(dom.substr(verdict));
  EXPECT_TRUE(hasResult("failures: &gt;"));
  EXPECT_TRUE(hasResult("flips: true"));
  EXPECT_TRUE(hasResult("names: bsdf, "));
  EXPECT_TRUE(hasResult("exposes: true"));
  EXPECT_TRUE(hasResult("tip: pixel 12, 7\nreference ") ||
              hasResult("tip: pixel 11, 7\nreference "));
  EXPECT_TRUE(hasResult("mapTip: pixel 12, 7\nerror ") || hasResult("mapTip: pixel 11, 7\nerror "));
  EXPECT_TRUE(hasResult("curves: 3,3"));
  EXPECT_TRUE(hasResult("rows: 3"));
  EXPECT_TRUE(hasResult("maps: 3"));
  EXPECT_TRUE(hasResult("biases: 1"));
  EXPECT_TRUE(hasResult("probes: 3"));
}

}  // namespace
}  // namespace chromeball::report_test
