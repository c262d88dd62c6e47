// SPDX-License-Identifier: Apache-2.0
// Light stages in bands of rows equal, bit for bit, stages in one piece.
#include <gtest/gtest.h>

#include "base/error.h"
#include "image/io/write_image.h"
#include "relight/stage/relit_stage.h"
#include "relight/stage/stage_file.h"
#include "small_scenes.h"
#include "sphere_test.h"
#include "temporary_folder.h"
#include "whole_stage.h"

namespace chromeball::stage_bands_test {
namespace {

constexpr int kWidth = 20, kHeight = 35;

Camera cameraOf() { return Camera::lookAt({0, 2, 4}, {0, 0.4f, 0}, {0, 1, 0}, 0.6f); }

RenderSettings settingsOf() {
  RenderSettings s = smallRender(kWidth, kHeight, 5, 3, 1);
  s.guiding = Guiding::Off;
  return s;
}

void append(Image& all, const Image& rows) {
  all.width = rows.width, all.channels = rows.channels, all.height += rows.height;
  all.texels.insert(all.texels.end(), rows.texels.begin(), rows.texels.end());
}

TEST(BasisRenderer, BandsOfAnyHeightAreTheWhole) {
  for (const NamedScene& named : threeScenes()) {
    const World world(named.scene, {}, allTables());
    const Camera camera = cameraOf();
    for (const char* basis : {"lat-long:8x4", "sh:2"}) {
      const BasisRenderer renderer(world, camera, DirectionBasis(basis, "test"), settingsOf());
      const auto render = [&](int top, int count) {
        return renderer.render(
            top, count, [](double) {}, false);
      };
      const BasisRender whole = render(0, kHeight);
      for (const int height : {1, 7, 16, 32}) {
        SCOPED_TRACE(fmt::format("{}, {}, {} rows", named.name, basis, height));
        Image elements, own, color;
        for (int top = 0; top < kHeight; top += height) {
          const BasisRender band = render(top, std::min(height, kHeight - top));
          append(elements, band.stage.elements);
          append(own, band.stage.own);
          append(color, band.color);
        }
        ASSERT_EQ(elements.texels, whole.stage.elements.texels);
        ASSERT_EQ(own.texels, whole.stage.own.texels);
        ASSERT_EQ(color.texels, whole.color.texels);
      }
    }
  }
}

TEST(BasisRenderer, StopsAndSaysSo) {
  const Scene scene = threeScenes()[0].scene;
  const World world(scene, {}, allTables());
  const Camera camera = cameraOf();
  const BasisRenderer renderer(world, camera, DirectionBasis("sh:0", "test"), settingsOf());
  EXPECT_TRUE(renderer
                  .render(
                      0, 16, [](double) {}, true)
                  .interrupted);
  EXPECT_FALSE(renderer
                   .render(
                       0, 16, [](double) {}, false)
                   .interrupted);
}

// The elements in one piece, transformed in place, then all but the largest dropped.
RelitStage inOnePiece(const LightStage& stage, std::vector<Rgb> weights, RelightDomain domain,
                      const KeptShares& kept) {
  RelitStage relit;
  const Image whole = weightedSum(stage.elements, weights);
  transform(weights, stage.basis, domain);
  if (kept.light < 1) relit.lightZeros = keepLargest(floatsOf(weights), kept.light);
  Image elements = stage.elements;
  std::vector<Rgb> pixel(weights.size());
  for (int y = 0; y < elements.height; ++y)
    for (int x = 0; x < elements.width; ++x) {
      std::copy_n(elements.at(x, y), elements.channels, floatsOf(pixel).data());
      transform(pixel, stage.basis, domain);
      std::ranges::copy(floatsOf(pixel), elements.at(x, y));
    }
  if (kept.stage < 1) relit.zeros = keepLargest(elements.texels, kept.stage);
  relit.picture = weightedSum(elements, weights);
  if (!kept.isAll()) relit.error = relativeDifference(relit.picture, whole);
  addOwnLight(relit.picture, stage.own);
  return relit;
}

void expectEqual(const RelitStage& a, const RelitStage& b) {
  EXPECT_EQ(a.picture.texels, b.picture.texels);
  EXPECT_EQ(a.zeros, b.zeros);
  EXPECT_EQ(a.lightZeros, b.lightZeros);
  EXPECT_EQ(a.error, b.error);
}

TEST(StageBands, RelightAsOnePieceDoesInEachDomain) {
  const TemporaryFolder folder;
  const Scene scene = threeScenes()[2].scene;
  const World world(scene, {}, allTables());
  using Case = std::pair<const char*, const char*>;
  for (const auto& [basis, name] : {Case("lat-long:8x8", "pixel"), Case("lat-long:8x8", "dct"),
                                    Case("cube:4", "haar"), Case("sh:2", "sh")}) {
    const BasisRender render = renderBasis(world, cameraOf(), basis, settingsOf());
    ASSERT_FALSE(render.stage.own.empty());
    writeStage(folder / "s.exr", render.stage, render.color, false);
    const RelightDomain domain = parseDomain(name, render.stage.basis);
    std::vector<Rgb> weights;
    for (int i = 0; i < render.stage.basis.size(); ++i)
      weights.emplace_back(random2(i, 1).x, random2(i, 2).x, random2(i, 3).x);
    for (const KeptShares& kept :
         {KeptShares{}, KeptShares{0.02, 1}, KeptShares{1, 0.2}, KeptShares{0.05, 0.5}}) {
      SCOPED_TRACE(fmt::format("{}, {}, {}", name, kept.stage, kept.light));
      const RelitStage expected = inOnePiece(render.stage, weights, domain, kept);
      if (kept.stage < 1) {
        EXPECT_GT(expected.error, 0);
      }
      StageBands inMemory(render.stage);
      expectEqual(relitStage(inMemory, weights, domain, kept), expected);
      for (const int rows : {1, 4, 34, 35}) {
        StageReader file(folder / "s.exr");
        const double memory = file.bufferBytes() + (rows + 0.5) * file.rowBytes();
        StageBands bands(std::move(file), memory, "test");
        expectEqual(relitStage(bands, weights, domain, kept), expected);
        int count = 0;
        bands.forEach([&](const LightStage& band, int top) {
          EXPECT_EQ(top, count * rows);
          EXPECT_LE(band.height(), rows);
          ++count;
        });
        EXPECT_EQ(count, (kHeight + rows - 1) / rows);
      }
    }
  }
}

TEST(StageBands, RefuseWhatTheyCannotRead) {
  const TemporaryFolder folder;
  const std::string path = folder / "s.exr";
  LightStage stage{DirectionBasis("lat-long:2x1", "test"), Image(4, 40, 6), {}};
  stage.elements.at(3, 32)[5] = INFINITY;
  writeStage(path, stage, Image(4, 40, 3), false);
  const auto error = [&](double rows) -> std::string {
    try {
      StageReader file(path);
      const double memory = file.bufferBytes() + rows * file.rowBytes();
      StageBands(std::move(file), memory, path).forEach([](const LightStage&, int) {});
    } catch (const InputError& refused) {
      return refused.what();
    }
    return "";
  };
  EXPECT_NE(error(0.9).find("a row of 4 pixels with 2 elements takes"), std::string::npos);
  for (const double rows : {1, 16, 100})
    EXPECT_NE(error(rows).find("pixel 3, 32 has values that are not finite"), std::string::npos)
        << error(rows);
}

TEST(StageFile, QuotesAnUnknownBasisInOneLine) {
  const TemporaryFolder folder;
  writeImage(
      folder / "s.exr",
      OutputImage{
          {{"", "RGB", Image(4, 4, 3)}}, {{"basis", std::string("lat-long\n:2x1")}}, {}, {}});
  try {
    StageReader(folder / "s.exr");
    ADD_FAILURE() << "was read";
  } catch (const InputError& refused) {
    EXPECT_NE(std::string(refused.what()).find("`lat-long :2x1` is not"), std::string::npos);
  }
}

TEST(StageSize, ExceedsNoFileAndNoMemory) {
  const DirectionBasis basis("lat-long:32x16", "test");
  EXPECT_NO_THROW(checkStageSize(basis, 800, 600, "test"));  // 7e8 numbers
  EXPECT_NO_THROW(checkStageSize(basis, 6000, 6000, "test"));
  EXPECT_THROW(checkStageSize(basis, 8000, 8000, "test"), InputError);
  EXPECT_NO_THROW(checkInMemory(basis, 80, 60, 80 * 60 * 512 * 12, "test"));
  EXPECT_THROW(checkInMemory(basis, 80, 60, 80 * 60 * 512 * 12 - 1, "test"), InputError);
}

}  // namespace
}  // namespace chromeball::stage_bands_test
