// SPDX-License-Identifier: Apache-2.0
#include "job/merge.h"

#include <algorithm>
#include <tuple>

#include "base/error.h"
#include "job/image_memory.h"
#include "job/job_description.h"

namespace chromeball {
namespace {

struct Header {
  std::string path, identity;
  RenderSettings settings;

  auto position() const {
    const Crop w = settings.window();
    return std::tuple(w.y, w.x, w.height, w.width);
  }
  auto order() const { return std::tuple(position(), settings.shard.index); }
};

std::string nameOf(const Crop& w) {
  return fmt::format("{},{},{},{}", w.x, w.y, w.width, w.height);
}

void checkSameRender(const std::vector<Header>& parts) {
  for (const Header& part : parts) {
    if (part.identity != parts[0].identity)
      throwInput("{}: is a part of another render than {}: {}", part.path, parts[0].path,
                 differenceOf(parts[0].identity, part.identity));
    const Shard &one = parts[0].settings.shard, &other = part.settings.shard;
    if (one.count != other.count || one.samplesOfAll != other.samplesOfAll)
      throwInput("{}: is one of {} shards of {} samples per pixel, and {} one of {} of {}",
                 part.path, other.count, other.samplesOfAll, parts[0].path, one.count,
                 one.samplesOfAll);
  }
}

// All shards of one crop, in order.
void checkShards(std::span<const Header> parts) {
  const Shard& shard = parts[0].settings.shard;
  std::vector<std::string> missing;
  size_t next = 0;
  for (uint32_t index = 0; index < shard.count; ++index) {
    if (next == parts.size() || parts[next].settings.shard.index != index) {
      missing.push_back(fmt::format("{}/{}", index + 1, shard.count));
      continue;
    }
    if (++next < parts.size() && parts[next].settings.shard.index == index)
      throwInput("{}: is the same part as {}", parts[next].path, parts[next - 1].path);
  }
  constexpr size_t kMostNamed = 20;
  const size_t count = missing.size();
  if (count > kMostNamed) missing.resize(kMostNamed);
  if (count > 0)
    throwInput(
        "{}{} of {} shards missing: {}{}",
        parts[0].settings.crop ? fmt::format("crop {}: ", nameOf(*parts[0].settings.crop)) : "",
        count, shard.count, fmt::join(missing, ", "), count > kMostNamed ? ", ..." : "");
}

bool overlap(const Crop& a, const Crop& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

// `crops`: one part of each.
void checkCrops(const std::vector<const Header*>& crops) {
  uint64_t covered = 0;
  for (size_t i = 0; i < crops.size(); ++i) {
    const Crop w = crops[i]->settings.window();
    for (size_t j = 0; j < i; ++j)
      if (overlap(w, crops[j]->settings.window()))
        throwInput("{}: overlaps {}", crops[i]->path, crops[j]->path);
    covered += uint64_t(w.width) * uint64_t(w.height);
  }
  const RenderSettings& s = crops[0]->settings;
  const uint64_t all = uint64_t(s.width) * uint64_t(s.height);
  if (covered < all)
    throwInput("crops missing: {} of {} pixels are in none of the parts", all - covered, all);
}

void paste(const Image& part, const Crop& at, Image& whole) {
  for (int y = 0; y < part.height && !whole.empty(); ++y)
    std::copy_n(part.at(0, y), part.width * part.channels, whole.at(at.x, at.y + y));
}

// Of the whole image, with the plate and the reflectance still empty.
FinishPlan wholePlan(FinishPlan plan) {
  RenderSettings& s = plan.settings;
  s.crop.reset();
  s.samples = s.samplesOfAll();
  s.shard = {};
  if (plan.composite)
    for (Image* image : {&plan.composite->plate, &plan.composite->reflectance})
      if (!image->empty()) *image = Image(s.width, s.height, image->channels);
  return plan;
}

}  // namespace

PartSet::PartSet(const std::vector<std::string>& paths) {
  std::vector<Header> parts;
  for (const std::string& path : paths) {
    RenderPart part = readPartHeader(path);
    parts.push_back({path, withoutParts(part.identity), std::move(part.plan.settings)});
  }
  checkSameRender(parts);
  std::ranges::stable_sort(parts, {}, &Header::order);
  std::vector<const Header*> crops;
  for (auto begin = parts.begin(); begin != parts.end();) {
    const auto end = std::find_if(
        begin, parts.end(), [&](const Header& p) { return p.position() != begin->position(); });
    checkShards({begin, end});
    crops.push_back(&*begin);
    begin = end;
  }
  checkCrops(crops);
  for (const Header& part : parts) paths_.push_back(part.path);
}

StoredPart merge(const PartSet& parts, const Progress& progress) {
  const RenderPart first = readPartHeader(parts.paths().front());
  RenderPart whole{withoutParts(first.identity), wholePlan(first.plan)};
  if (const double needed = imageBytes(whole.plan.settings); needed > memoryBudget())
    throwInput("{}: an image of {}x{} takes {:.3g} GB of memory", parts.paths().front(),
               whole.plan.settings.width, whole.plan.settings.height, needed * 1e-9);
  RenderResult result(whole.plan.settings, whole.plan.layers());
  uint32_t samples = 0;  // of the shards of one crop
  for (size_t i = 0; i < parts.paths().size(); ++i) {
    StoredPart stored = readPart(parts.paths()[i]);
    const RenderSettings& settings = stored.part.plan.settings;
    const Crop window = settings.window();
    result.add(stored.result, window.x, window.y);
    samples = settings.shard.index == 0 ? stored.result.samples : samples + stored.result.samples;
    if (settings.shard.index + 1 == settings.shard.count)
      result.samples = result.samples == 0 ? samples : std::min(result.samples, samples);
    if (whole.plan.composite) {
      paste(stored.part.plan.composite->plate, window, whole.plan.composite->plate);
      paste(stored.part.plan.composite->reflectance, window, whole.plan.composite->reflectance);
    }
    progress(double(i + 1) / double(parts.paths().size()));
  }
  return {std::move(whole), std::move(result)};
}

}  // namespace chromeball
