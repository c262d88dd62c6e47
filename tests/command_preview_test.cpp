// SPDX-License-Identifier: Apache-2.0
// chromeball render --preview: what the server answers.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <optional>
#include <thread>

#include "base/json.h"
#include "image/io/read_image.h"
#include "json_file.h"
#include "preview_render.h"
#include "tcp.h"

namespace chromeball::command_preview_test {
namespace {

using nlohmann::json;

// What the server answers about the last image.
struct LastAnswers {
  HttpAnswer values, picture;
};
// It waits a few seconds for these requests, and on a busy machine they may come later.
std::optional<LastAnswers> lastAnswers(PreviewRender& preview, const std::string& view) {
  preview.start({"--samples", "1000000", "--aov", "normal,depth,samples,variance"});
  preview.waitForImage();
  EXPECT_EQ(preview.post("/stop").status, 200);
  HttpAnswer status;
  do {
    status = preview.get("/status.json");
  } while (status.status == 200 && parseJson(status.body)["isLast"] != true);
  const LastAnswers answers{preview.get("/pixel.json?x=17&y=12"), preview.get(view)};
  EXPECT_EQ(preview.result().status, 130);
  if (answers.values.status == 0 || answers.picture.status == 0) return {};
  return answers;
}

// A pixel of the last image, and its picture, equal the files'.
void expectFilesView(const std::string& layer, const std::vector<std::string>& options,
                     const std::string& query) {
  SCOPED_TRACE(layer);
  std::optional<PreviewRender> render;
  std::optional<LastAnswers> answers;
  for (int tries = 0; !answers && tries < 10; ++tries)
    answers = lastAnswers(render.emplace(),
                          "/image.png?layer=" + (layer == "color" ? "" : layer) + query);
  ASSERT_TRUE(answers);
  const PreviewRender& preview = *render;
  const json values = parseJson(answers->values.body);

  const ImageFile file = readImageFile(preview.out());
  const Rgb color = findColor(file)->rgb(17, 12);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(values[""][c], fmt::format("{:.6g}", color[c]));
  EXPECT_EQ(values["depth"][0], fmt::format("{:.6g}", *findLayer(file, "depth")->at(17, 12)));
  std::vector<std::string> view{"image", "view", preview.out(), preview.folder / "view.png"};
  view.insert(view.end(), options.begin(), options.end());
  ASSERT_EQ(runCommand(view).status, 0);
  EXPECT_EQ(answers->picture.body, fileContents(preview.folder / "view.png"));
}

TEST(SlowPreview, ShowsWhatImageViewShows) {
  expectFilesView("color", {"--exposure", "-1.5", "--tonemap", "aces"},
                  "&exposure=-1.5&tonemap=aces");
  expectFilesView("variance", {"--layer", "variance"}, "");
  expectFilesView("depth", {"--layer", "depth"}, "&width=40");  // of 40 pixels: as they are
}

TEST(Preview, SavesWhileItRenders) {
  PreviewRender preview;
  preview.start({"--samples", "1000000"});
  preview.waitUntil([](const json&) { return true; });
  EXPECT_EQ(preview.post("/save").status, 200);  // perhaps before the end of the first pass
  preview.waitUntil([](const json& status) { return status["filesWritten"] == 1; });
  EXPECT_GT(std::get<int>(readImageFile(preview.out()).metadata.at("samples")), 0);
  preview.post("/stop");
  EXPECT_EQ(preview.result().status, 130);
}

TEST(SlowPreview, GoesOnWhereItCannotSave) {
  PreviewRender preview;
  std::filesystem::create_directory(preview.folder / "sub");
  preview.start({"--samples", "1000000"}, "sub/o.exr");
  preview.waitForImage();
  std::filesystem::remove(preview.folder / "sub");
  preview.post("/save");
  preview.waitUntil([](const json& status) { return status["filesWritten"] == 1; });
  std::filesystem::create_directory(preview.folder / "sub");
  preview.post("/stop");
  const CommandResult result = preview.result();
  EXPECT_EQ(result.status, 130);
  EXPECT_NE(result.error.find("warning: while rendering: "), std::string::npos) << result.error;
  EXPECT_TRUE(std::filesystem::exists(preview.out()));
}

// A request that never ends.
TEST(SlowPreview, EndsWithoutTheEndOfRequests) {
  PreviewRender preview;
  preview.start({"--samples", "1000000"});
  preview.waitForImage();
  const Socket socket = connectTo(preview.port());
  socket.write("GET / HTTP/1.1\r\nX: ");
  std::atomic<bool> ended = false;
  std::thread dripping([&] {
    for (; !ended; usleep(100'000)) socket.write("x");
  });
  preview.post("/stop");
  EXPECT_EQ(preview.result().status, 130);
  ended = true;
  dripping.join();
}

TEST(SlowPreview, ReducesWideImages) {
  PreviewRender preview;
  preview.start({"--samples", "1000000"});
  preview.waitForImage();
  const auto widthOf = [&](const std::string& query) {
    std::ofstream(preview.folder / "p.png", std::ios::binary) << preview.get(query).body;
    return readImageFile(preview.folder / "p.png").image.width;
  };
  EXPECT_EQ(widthOf("/image.png"), 40);
  EXPECT_EQ(widthOf("/image.png?width=39"), 20);
  EXPECT_EQ(widthOf("/image.png?width=13"), 10);
  EXPECT_EQ(widthOf("/image.png?width=1"), 1);
  preview.post("/stop");
  EXPECT_EQ(preview.result().status, 130);
}

// Pages of other servers, and requests that make no sense.
TEST(SlowPreview, Refuses) {
  PreviewRender preview;
  preview.start({"--samples", "1000000"});
  preview.waitForImage();
  EXPECT_EQ(preview.get("/status.json", "Host: example.com\r\n").status, 403);
  EXPECT_EQ(preview.get("/status.json", "Host: LocalHost:1234\r\n").status, 200);
  const std::string own = "Host: localhost\r\n";
  EXPECT_EQ(preview.post("/stop", own + "Origin: http://example.com\r\n").status, 403);
  EXPECT_EQ(preview.post("/stop", own + "Origin: null\r\n").status, 403);
  for (const char* target :
       {"/image.png?layer=none", "/image.png?exposure=nan", "/image.png?exposure=1x",
        "/image.png?tonemap=x", "/image.png?width=1e99", "/pixel.json?x=40&y=0", "/pixel.json?x=-1",
        "/pixel.json?y=99999999999"})
    EXPECT_EQ(preview.get(target).status, 400) << target;
  EXPECT_EQ(preview.get("/nothing").status, 404);
  EXPECT_EQ(preview.get("/stop").status, 404);  // is no link
  EXPECT_EQ(preview.post("/stop", own, std::string(5000, 'x')).status, 413);

  const CommandResult second = expectError(
      {"render", preview.folder / "m.gltf", "--preview=" + std::to_string(preview.port()), "-o",
       preview.folder / "other.png"},
      "is in use");
  expectError(
      {"render", preview.folder / "m.gltf", "--preview=65536", "-o", preview.folder / "other.png"},
      "from 0 to 65535");
  preview.post("/stop");
  EXPECT_EQ(preview.result().status, 130);
}

// A render that nobody looks at makes no images, and does not wait at its end.
TEST(Preview, WaitsForNobody) {
  PreviewRender preview;
  preview.start({"--samples", "64"});
  const CommandResult result = preview.result();
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.error.find("preview at http://127.0.0.1:"), std::string::npos);
}

TEST(SlowPreview, ShowsOneFrameAfterTheOther) {
  PreviewRender preview;
  preview.start({"--samples", "20000", "--frames", "0:1", "--orbit", "90"}, "f.#.exr");
  preview.waitForImage();
  EXPECT_EQ(preview.post("/save").status, 409);  // a file that exists is a finished frame
  preview.waitUntil(
      [](const json& status) { return jsonText(status["name"]).ends_with("f.1.exr\""); });
  preview.post("/stop");
  EXPECT_EQ(preview.result().status, 130);
  EXPECT_TRUE(std::filesystem::exists(preview.folder / "f.0.exr"));
}

}  // namespace
}  // namespace chromeball::command_preview_test
