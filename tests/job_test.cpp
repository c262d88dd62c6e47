// SPDX-License-Identifier: Apache-2.0
// A job rendered with the library, without the command.
#include "job/job.h"

#include <gtest/gtest.h>

#include "image/io/write_image.h"
#include "probe/synth.h"
#include "run_command.h"
#include "small_model.h"

namespace chromeball {
namespace {

TEST(Job, RendersASceneFileToAnImageAndPrintsNothing) {
  const TemporaryFolder folder;
  writeSmallModel(folder / "model.gltf");
  writeImage(folder / "probe.exr", constantProbe({8, 4}, Rgb(0.5f, 1, 2)));
  std::ofstream(folder / "scene.toml") << "model = 'model.gltf'\n[probe]\nfile = 'probe.exr'\n"
                                          "[render]\nsize = [12, 8]\nsamples = 2\n"
                                          "[output]\naovs = ['depth']\n";
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  RenderJob job = planJob(openScene(folder / "scene.toml"));
  const LoadedScene loaded = loadScene(job);
  const JobResult result = renderJob(job, loaded);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");

  EXPECT_EQ(result.color().width, 12);
  EXPECT_EQ(result.color().height, 8);
  EXPECT_EQ(result.color().rgb(0, 0), Rgb(0.5f, 1, 2));
  EXPECT_EQ(result.render.samples, 2u);
  ASSERT_EQ(result.image.layers.size(), 2u);
  EXPECT_EQ(result.image.layers[1].name, "depth");
  ASSERT_EQ(loaded.messages.size(), 1u) << "the mapping was detected";
  EXPECT_EQ(loaded.messages[0].kind, Message::Kind::Note);

  ASSERT_EQ(runCommand({"render", folder / "scene.toml", "-o", folder / "a.pfm"}).status, 0);
  EXPECT_EQ(readImage(folder / "a.pfm").texels, result.color().texels);
}

TEST(Job, ErrorsSuggestASetting) {
  const TemporaryFolder folder;
  writeSmallModel(folder / "model.gltf");
  try {
    RenderJob job = planJob(openScene(folder / "model.gltf"));
    loadScene(job);
    ADD_FAILURE() << "nothing lights the scene";
  } catch (const InputError& error) {
    ASSERT_TRUE(error.remedy);
    EXPECT_EQ(error.remedy->setting, "probe.file");
    EXPECT_EQ(std::string(error.what()).find("--"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace chromeball
