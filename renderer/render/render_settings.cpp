// SPDX-License-Identifier: Apache-2.0
#include "render/render_settings.h"

#include <algorithm>

#include "render/guide_training.h"
#include "render/schedule.h"

namespace chromeball {
namespace {

constexpr uint32_t kLeastPilot = 8;  // samples per pixel; with 4, the union has 11% more variance

}  // namespace

void Shard::archive(Archive& a) {
  a(index), a(count), a(samplesOfAll), a(repeated), a(isConsecutive);
}

uint32_t Shard::ofAll(uint32_t taken) const {
  if (isConsecutive || count == 1 || taken <= repeated) return taken;
  return uint32_t(std::min<uint64_t>(samplesOfAll, repeated + uint64_t(taken - repeated) * count));
}

uint32_t Shard::kept(uint32_t taken) const {
  return index == 0 || taken <= repeated ? taken : taken - repeated;
}

uint32_t Shard::samples() const {
  if (isConsecutive) return (index + 1 == count ? samplesOfAll : firstOf(index + 1)) - first();
  return repeated + (samplesOfAll - repeated + count - 1) / count;
}

RenderSettings shardOf(RenderSettings whole, uint32_t index, uint32_t count) {
  RenderSettings settings = std::move(whole);
  Shard& shard = settings.shard;
  shard = {.index = index, .count = count, .samplesOfAll = settings.samples};
  shard.isConsecutive = !settings.adaptive && settings.usedGuiding() == Guiding::Off;
  settings.samples /= count;
  if (const uint32_t pilot = Schedule::pilotSamples(settings))
    shard.repeated = std::max(pilot, kLeastPilot);
  shard.repeated = std::max(shard.repeated, GuideTraining::samplesOf(settings));
  settings.samples = shard.samples();
  return settings;
}

}  // namespace chromeball
