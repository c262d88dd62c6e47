// SPDX-License-Identifier: Apache-2.0
// The page of chromeball render --preview in a browser, if one is installed.
#include <gtest/gtest.h>

#include "browser.h"
#include "preview_render.h"

namespace chromeball::preview_page_test {
namespace {

// Uses the page as a person does, and appends what it saw.
constexpr const char* kUse = R"(
  const failures = [];
  addEventListener('error', e => failures.push(e.message));
  addEventListener('unhandledrejection', e => failures.push(String(e.reason)));
  const text = id => document.getElementById(id).textContent;
  const until = async holds => {
    for (let i = 0; i < 4000 && !holds(); ++i) {
      await fetch('status.json').catch(() => {});  // takes real time, in which the render goes on
      await new Promise(done => setTimeout(done, 50));
    }
    return Boolean(holds());
  };
  const element = document.getElementById('picture');
  const middle = () => {  // of the picture
    const canvas = document.createElement('canvas');
    canvas.width = canvas.height = 1;
    const context = canvas.getContext('2d');
    context.drawImage(element, element.naturalWidth / 2, element.naturalHeight / 2, 1, 1,
                      0, 0, 1, 1);
    return [...context.getImageData(0, 0, 1, 1).data];
  };
  const choose = async (id, value) => {
    const before = element.src;
    const control = document.getElementById(id);
    control.value = value;
    control.dispatchEvent(new Event('input'));
    await until(() => element.src !== before);
    await element.decode();
  };
  const use = async () => {
    const verdict = {};
    verdict.shown = await until(() => element.dataset.image);
    verdict.progress = await until(() => /[1-9]\d* samples, noise .*%, .*elapsed/.test(text('progress')));
    verdict.layers = [...document.getElementById('layer').options].map(o => o.text).join(' ');
    await choose('exposure', -2);
    const dark = middle();
    await choose('exposure', 2);
    const bright = middle();
    verdict.exposes = bright[0] > dark[0] + 20 && text('stops') === '2';
    await choose('layer', 'node');
    verdict.layer = middle().join() !== bright.join();
    await choose('layer', '');
    await choose('zoom', 8);
    verdict.zoom = element.getBoundingClientRect().width;
    const box = element.getBoundingClientRect();
    element.dispatchEvent(new MouseEvent('mousemove', {
      clientX: box.left + 20.5 * 8, clientY: box.top + 15.5 * 8, bubbles: true}));
    await until(() => text('tip') !== '');
    verdict.tip = text('tip').replaceAll('\n', ' ');
    document.getElementById('save').click();
    verdict.saved = await until(() => text('progress').includes('saved'));
    document.getElementById('stop').click();
    verdict.finished = await until(() => text('progress').includes('finished'));
    verdict.disabled = await until(() => document.getElementById('stop').disabled);
    verdict.failures = failures.join('; ');
    const pre = document.createElement('pre');
    pre.id = 'verdict';
    pre.textContent = Object.entries(verdict).map(([k, v]) => `<${k}: ${v}>`).join('\n');
    document.body.append(pre);
  };
  use();
)";

TEST(SlowPreview, worksInABrowser) {
  const std::string chromium = findChromium();
  if (chromium.empty()) GTEST_SKIP() << kNoChromium;
  PreviewRender preview;
  preview.start({"--samples", "1000000", "--aov", "node"});
  preview.waitForImage();
  const TemporaryFolder folder;
  const std::string dom =
      dumpedPage(chromium, folder, fmt::format("http://127.0.0.1:{}/", preview.port()),
                 extensionIn(folder, kUse), 600);
  preview.post("/stop");  // if the page has failed to
  EXPECT_EQ(preview.result().status, 130);

  const size_t verdict = dom.find("<pre id=\"verdict\">");
  ASSERT_NE(verdict, std::string::npos) << dom << fileContents(folder / "log");
  SCOPED_TRACE(dom.substr(verdict));
  for (const char* result :
       {"failures: &gt;", "shown: true", "progress: true", "layers: color node variance samples",
        "exposes: true", "layer: true", "zoom: 320", "tip: pixel 20, 15 color ", "saved: true",
        "finished: true", "disabled: true"})
    EXPECT_NE(dom.find(std::string("&lt;") + result), std::string::npos) << result;
}

}  // namespace
}  // namespace chromeball::preview_page_test
