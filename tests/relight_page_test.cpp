// SPDX-License-Identifier: Apache-2.0
// The page of chromeball relight --preview in a browser, if one is installed.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <future>
#include <iostream>
#include <sstream>

#include "browser.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "image/tonemap.h"
#include "probe/synth.h"
#include "run_command.h"
#include "small_model.h"
#include "tcp.h"

namespace chromeball::relight_page_test {
namespace {

// Uses the page as a person does, and appends what it saw.
constexpr const char* kUse = R"(
  const failures = [];
  addEventListener('error', e => failures.push(e.message));
  addEventListener('unhandledrejection', e => failures.push(String(e.reason)));
  const element = document.getElementById('picture');
  const until = async holds => {
    for (let i = 0; i < 2000 && !holds(); ++i) {
      await fetch('stage.json').catch(() => {});  // takes real time
      await new Promise(done => setTimeout(done, 20));
    }
    return Boolean(holds());
  };
  const shows = text => until(() => (element.dataset.shown || '').includes(text));
  const pixels = () => [[3, 4], [12, 9], [20, 20]].map(
      ([x, y]) => [...element.getContext('2d').getImageData(x, y, 1, 1).data].join(' ')).join(' ');
  const choose = async (id, value) => {
    const control = document.getElementById(id);
    control.value = value;
    control.dispatchEvent(new Event('input'));
    return shows(`${id}=${value}`);
  };
  const use = async () => {
    const verdict = {};
    verdict.shown = await shows('yaw=0');
    verdict.first = pixels();
    verdict.turns = await choose('yaw', 90);
    verdict.turned = pixels();
    verdict.swaps = await choose('probe', 1);
    verdict.swapped = pixels();
    document.getElementById('map').dispatchEvent(new PointerEvent('pointermove', {
      buttons: 1, movementX: 64, bubbles: true}));
    verdict.drags = await shows('yaw=0');
    verdict.milliseconds = element.dataset.milliseconds;
    document.getElementById('stop').click();
    await until(() => document.getElementById('time').textContent === 'stopped');
    verdict.failures = failures.join('; ');
    const pre = document.createElement('pre');
    pre.id = 'verdict';
    pre.textContent = Object.entries(verdict).map(([k, v]) => `[${k}: ${v}]`).join('\n');
    document.body.append(pre);
  };
  use();
)";

// The page's pixels: R, G, B, A of each, as text.
std::string bytesOf(const Image& image) {
  std::string text;
  for (const auto& [x, y] : {std::array{3, 4}, std::array{12, 9}, std::array{20, 20}})
    for (int c = 0; c < 4; ++c)
      text += fmt::format("{} ", c < 3 ? std::lround(255 * linearToSrgb(image.rgb(x, y)[c])) : 255);
  return text;
}

void expectNear(const std::string& found, const std::string& expected) {
  std::istringstream a(found), b(expected);
  for (int i = 0; i < 12; ++i) {
    int x = -1, y = -1;
    a >> x;
    b >> y;
    EXPECT_NEAR(x, y, 2) << found << " / " << expected;
  }
}

TEST(SlowRelightPage, turnsAndSwapsProbesInABrowser) {
  const std::string chromium = findChromium();
  if (chromium.empty()) GTEST_SKIP() << kNoChromium;
  const TemporaryFolder folder;
  writeSmallModel(folder / "m.gltf");
  writeImage(folder / "a.exr", gradientProbe({64, 32}, Rgb(0.3f), {0.9, 0, 0.3}));
  writeImage(folder / "b.exr", gradientProbe({64, 32}, Rgb(0.1f, 0.2f, 0.4f), {0, 0.8, 0}));
  ASSERT_EQ(runCommand({"basis", folder / "m.gltf", "--size", "32x24", "--samples", "16",
                        "--directions", "lat-long:16x8", "-o", folder / "s.exr"})
                .status,
            0);
  const auto relit = [&](const std::string& probe, const std::string& rotation) {
    EXPECT_EQ(runCommand({"relight", folder / "s.exr", "--probe", folder / probe, "--rotation",
                          rotation, "-o", folder / "o.png"})
                  .status,
              0);
    return bytesOf(readImage(folder / "o.png"));
  };
  const int port = freePort();
  auto command = std::async(std::launch::async, [&] {
    return runCommand({"relight", folder / "s.exr", "--probe", folder / "a.exr", "--probe",
                       folder / "b.exr", fmt::format("--preview={}", port)});
  });
  for (int i = 0; i < 1000 && !connectTo(port).isOpen(); ++i) usleep(20'000);
  const std::string dom = dumpedPage(chromium, folder, fmt::format("http://127.0.0.1:{}/", port),
                                     extensionIn(folder, kUse), 600);
  connectTo(port).write("POST /stop HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 0\r\n\r\n");
  EXPECT_EQ(command.get().status, 0);

  const size_t verdict = dom.find("<pre id=\"verdict\">");
  ASSERT_NE(verdict, std::string::npos) << dom << fileContents(folder / "log");
  SCOPED_TRACE(dom.substr(verdict));
  const auto found = [&](const std::string& name) {
    const size_t begin = dom.find("[" + name + ": ", verdict) + name.size() + 3;
    return dom.substr(begin, dom.find(']', begin) - begin);
  };
  for (const char* name : {"shown", "turns", "swaps", "drags"}) EXPECT_EQ(found(name), "true");
  EXPECT_EQ(found("failures"), "");
  EXPECT_NE(found("first"), found("turned"));
  expectNear(found("first"), relit("a.exr", "0"));
  expectNear(found("turned"), relit("a.exr", "90"));
  expectNear(found("swapped"), relit("b.exr", "90"));
  std::cout << "an update as the page measures it: " << found("milliseconds") << " ms\n";
}

}  // namespace
}  // namespace chromeball::relight_page_test
