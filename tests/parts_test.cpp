// SPDX-License-Identifier: Apache-2.0
// Shards and crops of a render, put together again.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/archive.h"
#include "base/error.h"
#include "measure/image_error.h"
#include "measure/statistics.h"
#include "parts/merge.h"
#include "render/pixel_renderer.h"
#include "run_command.h"
#include "session/finish.h"
#include "small_scenes.h"
#include "test_probes.h"

namespace chromeball::parts_test {
namespace {

constexpr int kWidth = 48, kHeight = 36;
const Camera kCamera = Camera::lookAt({0, 1.5f, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.8f);

// A render without adaptation and guides, so that parts have the samples of the whole.
RenderSettings fixedSettings(uint32_t samples) {
  RenderSettings settings = smallRender(kWidth, kHeight, samples, 5);
  settings.adaptive = false;
  settings.guiding = Guiding::Off;
  settings.aovs = {Aov::Albedo, Aov::Depth, Aov::Alpha, Aov::Node, Aov::Denoise};
  return settings;
}

RenderResult renderSmall(const NamedScene& small, const RenderSettings& settings) {
  return renderScene(small.scene, kCamera, Probe(small.probe), "importance", settings);
}

RenderResult merged(const NamedScene& small, const RenderSettings& whole, uint32_t shards) {
  RenderResult sum(whole, {});
  for (uint32_t i = 0; i < shards; ++i)
    sum.add(renderSmall(small, shardOf(whole, i, shards)), 0, 0);
  return sum;
}

void expectNear(const Image& a, const Image& b, float tolerance) {
  ASSERT_EQ(a.texels.size(), b.texels.size());
  for (size_t i = 0; i < a.texels.size(); ++i)
    ASSERT_NEAR(a.texels[i], b.texels[i], tolerance * std::max(1.0f, std::fabs(b.texels[i]))) << i;
}

TEST(Shard, SharesAreEqualAndComplete) {
  for (const uint32_t samples : {2u, 7u, 64u, 1000u, 2'000'000'000u})
    for (uint32_t count = 1; count <= std::min(samples / 2, 13u); ++count) {
      uint64_t next = 0;
      for (uint32_t i = 0; i < count; ++i) {
        const Shard shard{.index = i, .count = count, .samplesOfAll = samples};
        EXPECT_EQ(shard.first(), next);
        EXPECT_EQ(shard.first() % 2, 0u);
        EXPECT_NEAR(double(shard.samples()), double(samples) / count, 3);
        EXPECT_GT(shard.samples(), 0u);
        next += shard.samples();
      }
      EXPECT_EQ(next, samples);
    }
}

// The points of all shards are the first points of the whole, once each, however many a pixel of an
// adaptive render has, and in whatever passes they are taken.
TEST(Shard, TakesPointsOfItsOwn) {
  RenderSettings whole = smallRender(8, 8, 400, 3);
  whole.adaptive = true;
  for (const uint32_t samples : {50u, 51u, 399u, 20'003u})
    for (const int half : {0, 1}) {
      std::vector<uint64_t> points;
      for (uint32_t i = 0; i < 3; ++i) {
        const RenderSettings settings = shardOf(whole, i, 3);
        const SampleSequence sequence(settings);
        const uint32_t common = settings.shard.repeated;
        ASSERT_EQ(common, 16u);
        uint32_t from = i == 0 ? 0 : samplesOf(half, common);
        for (const uint32_t to : {common, common + 7, samples}) {
          sequence.forRuns(half, from, samplesOf(half, to), [&](const SampleSequence::Run& run) {
            for (uint32_t k = 0; k < run.count; ++k)
              points.push_back(run.table * sequence.tableSize() + run.first + k * run.stride);
          });
          from = samplesOf(half, to);
        }
      }
      std::ranges::sort(points);
      ASSERT_EQ(points.size(), samplesOf(half, samples));
      for (size_t i = 0; i < points.size(); ++i) ASSERT_EQ(points[i], i);
    }
}

TEST(Shard, UnionHasTheSamplesOfTheWhole) {
  for (const NamedScene& small : threeScenes()) {
    SCOPED_TRACE(small.name);
    for (const auto& [samples, shards] :
         {std::pair(32u, 4u), std::pair(30u, 4u), std::pair(7u, 3u)}) {
      const RenderSettings settings = fixedSettings(samples);
      const RenderResult whole = renderSmall(small, settings);
      const RenderResult sum = merged(small, settings, shards);
      expectNear(sum.film.mean(), whole.film.mean(), 1e-6f);
      expectNear(sum.film.halfDifference(), whole.film.halfDifference(), 1e-5f);
      EXPECT_EQ(sum.film.sampleCounts().texels, whole.film.sampleCounts().texels);
      for (const Aov aov : {Aov::Albedo, Aov::Depth, Aov::Alpha})
        expectNear(sum.aovs.finished(aov), whole.aovs.finished(aov), 1e-5f);
      expectNear(sum.features.direct().mean, whole.features.direct().mean, 1e-5f);
      EXPECT_EQ(sum.rays.camera, whole.rays.camera);
      EXPECT_NEAR(sum.film.noise().noise / whole.film.noise().noise, 1, 1e-6);
    }
  }
}

// All shards allot samples alike: a pixel has the same number in each, give or take the last of
// each half, and none has no samples; the first keeps the samples that all begin with.
TEST(SlowShard, LearnsFromTheSamplesOfAll) {
  const NamedScene small = threeScenes()[2];
  RenderSettings whole = smallRender(kWidth, kHeight, 400, 4);
  whole.adaptive = true;
  whole.guiding = Guiding::On;
  constexpr uint32_t kShards = 4;
  std::vector<Image> counts;
  uint32_t common = 0;
  for (uint32_t i = 0; i < kShards; ++i) {
    const RenderSettings settings = shardOf(whole, i, kShards);
    common = settings.shard.repeated;
    const RenderResult result = renderSmall(small, settings);
    EXPECT_FALSE(result.isRepeated);
    counts.push_back(result.film.sampleCounts());
  }
  ASSERT_EQ(common, 16u);
  const auto [least, most] = std::ranges::minmax(counts[1].texels);
  EXPECT_GE(least, 2);
  EXPECT_GT(most, 4 * least);  // or there would be nothing to allot alike
  for (size_t i = 0; i < counts[0].texels.size(); ++i) {
    for (uint32_t k = 2; k < kShards; ++k)
      ASSERT_NEAR(counts[k].texels[i], counts[1].texels[i], 2) << i;
    ASSERT_NEAR(counts[0].texels[i] - float(common), counts[1].texels[i], 2) << i;
  }
}

// Before its own samples, a shard has nothing that can be merged.
TEST(Shard, StoppedAtItsBeginningSaysSo) {
  const NamedScene small = threeScenes()[0];
  RenderSettings whole = smallRender(kWidth, kHeight, 400, 4);
  whole.adaptive = true;
  for (const uint32_t index : {0u, 1u}) {
    const std::atomic<bool> stop = true;
    const World world(small.scene);
    const Probe probe(small.probe);
    const auto lighting = makeStrategy("importance", probe, Mis::Balance, "test");
    const RenderResult result = render(
        world, kCamera, *lighting, shardOf(whole, index, 4), [](double) {}, stop);
    EXPECT_EQ(result.isRepeated, index == 1);
  }
}

// The variance of a union of adaptive shards is at most 10% above one render's; the differences to
// a reference of many images measure it to some percent.
TEST(SlowShard, UnionOfAdaptiveShardsIsAsGoodAsOneRender) {
  const NamedScene small = threeScenes()[0];
  RenderSettings settings = smallRender(kWidth, kHeight, 128, 4);
  settings.adaptive = true;
  RenderSettings best = settings;
  best.samples = 8192;
  best.seed = 99;
  const Image reference = renderSmall(small, best).film.mean();
  std::vector<double> ratios;
  for (settings.seed = 0; settings.seed < 24; ++settings.seed) {
    const auto relMse = [&](const RenderResult& r) {
      return imageError(r.film.mean(), reference, nullptr, nullptr).relMse;
    };
    ratios.push_back(relMse(merged(small, settings, 4)) / relMse(renderSmall(small, settings)));
  }
  const Moments ratio = Moments::of(ratios);
  const double error = std::sqrt(ratio.variance / ratio.count);
  EXPECT_LT(ratio.mean, 1.1 + 2.5 * error);
  EXPECT_LT(error, 0.05);
}

TEST(Crop, HasThePixelsOfTheWhole) {
  for (const NamedScene& small : threeScenes()) {
    SCOPED_TRACE(small.name);
    RenderSettings settings = fixedSettings(8);
    const RenderResult whole = renderSmall(small, settings);
    RenderResult sum(settings, {});
    for (const Crop crop : {Crop{0, 0, 17, 36}, Crop{17, 0, 31, 5}, Crop{17, 5, 31, 31}}) {
      settings.crop = crop;
      const RenderResult part = renderSmall(small, settings);
      ASSERT_EQ(part.film.width(), crop.width);
      sum.add(part, crop.x, crop.y);
    }
    EXPECT_EQ(sum.film.mean().texels, whole.film.mean().texels);
    EXPECT_EQ(sum.film.errors().luminances, whole.film.errors().luminances);
    for (const Aov aov : {Aov::Albedo, Aov::Depth, Aov::Node})
      EXPECT_EQ(sum.aovs.finished(aov).texels, whole.aovs.finished(aov).texels);
    EXPECT_EQ(sum.features.albedo().half.texels, whole.features.albedo().half.texels);
  }
}

// A part whose header asks for layers that it does not have is refused before they are made.
TEST(FinishPlan, IsReadOnlyIfItFitsTogether) {
  const auto isRefused = [](FinishPlan plan) {
    MemoryWriter writer;
    plan.archive(writer);
    MemoryReader reader(writer.contents);
    FinishPlan read;
    try {
      read.archive(reader);
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  FinishPlan plan{fixedSettings(4), {}};
  plan.settings.hideProbe = true;
  EXPECT_FALSE(isRefused(plan));
  plan.settings.aovs = {Aov::Albedo};
  EXPECT_TRUE(isRefused(plan));
  plan.settings.hideProbe = false;
  plan.composite.emplace();
  EXPECT_TRUE(isRefused(plan));  // without a plate
  plan.composite->plate = Image(kWidth, kHeight, 3);
  plan.composite->layers = {"l_obj", "albedo", "variance"};
  EXPECT_FALSE(isRefused(plan));
  for (const char* name : {"reflectance", "depth", "unknown"}) {
    plan.composite->layers = {name};
    EXPECT_TRUE(isRefused(plan)) << name;
  }
}

// Some of the missing ones are named, however many a header claims.
TEST(PartSet, NamesSomeOfFourBillionShards) {
  const TemporaryFolder folder;
  const std::string path = folder / "part.exr";
  RenderPart part{"{}", {fixedSettings(4), {}}};
  part.plan.settings.shard = {1, 4'000'000'000u, 4'000'000'000u};
  RenderResult result(part.plan.settings, {});
  OutputImage image{
      .layers = {{"", "RGB", Image(1, 1, 3)}}, .metadata = {}, .placement = {}, .state = {}};
  image.state = partState(part, result);
  writeImage(path, image, {});
  try {
    const PartSet parts({path});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "3999999999 of 4000000000 shards missing: 1/4000000000, 3/4000000000, "
                 "4/4000000000, 5/4000000000, 6/4000000000, 7/4000000000, 8/4000000000, "
                 "9/4000000000, 10/4000000000, 11/4000000000, 12/4000000000, 13/4000000000, "
                 "14/4000000000, 15/4000000000, 16/4000000000, 17/4000000000, 18/4000000000, "
                 "19/4000000000, 20/4000000000, 21/4000000000, ...");
  }
}

// Guided and adaptive parts are other estimates of the same image.
TEST(SlowShard, GuidedShardsAreUnbiased) {
  const NamedScene small = threeScenes()[2];  // with a mirror
  RenderSettings settings = smallRender(kWidth, kHeight, 512, 4);
  settings.adaptive = true;
  settings.guiding = Guiding::On;
  const RenderResult sum = merged(small, settings, 4);
  EXPECT_GT(sum.causticFraction, 0);
  settings.adaptive = false;
  settings.guiding = Guiding::Off;
  settings.seed = 5;
  const RenderResult whole = renderSmall(small, settings);
  const PixelErrors a = sum.film.errors(), b = whole.film.errors();
  double difference = 0, variance = 0;
  for (size_t i = 0; i < a.luminances.size(); ++i) {
    difference += a.luminances[i] - b.luminances[i];
    variance += a.scatter[i].w + b.scatter[i].w;
  }
  EXPECT_LT(std::fabs(difference) / std::sqrt(variance), 3.3);
}

}  // namespace
}  // namespace chromeball::parts_test
