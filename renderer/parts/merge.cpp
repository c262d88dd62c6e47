// SPDX-License-Identifier: Apache-2.0
#include "parts/merge.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "base/error.h"
#include "base/parallel.h"
#include "image/io/exr_state.h"
#include "session/image_header.h"
#include "session/memory_estimate.h"

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

std::string inWords(const Shard& shard) {
  if (shard.samplesOfAll == 0) return "no shard";
  return fmt::format("one of {} shards of {} samples per pixel", shard.count, shard.samplesOfAll);
}

void checkSameRender(const std::vector<Header>& parts) {
  for (const Header& part : parts) {
    if (part.identity != parts[0].identity)
      throwInput("{}: is a part of another render than {}: {}", part.path, parts[0].path,
                 differenceOf(parts[0].identity, part.identity));
    const Shard &one = parts[0].settings.shard, &other = part.settings.shard;
    if (one.count != other.count || one.samplesOfAll != other.samplesOfAll)
      throwInput("{}: is {}, and {} is {}", part.path, inWords(other), parts[0].path, inWords(one));
  }
}

// All shards of one crop, in order.
void checkShards(std::span<const Header> parts) {
  const auto indexOf = [&](size_t part) { return parts[part].settings.shard.index; };
  for (size_t i = 1; i < parts.size(); ++i)
    if (indexOf(i) == indexOf(i - 1))
      throwInput("{}: is the same part as {}", parts[i].path, parts[i - 1].path);
  const uint32_t count = parts[0].settings.shard.count;
  const size_t missing = count - parts.size();
  if (missing == 0) return;
  constexpr size_t kMostNamed = 20;
  std::vector<std::string> names;
  size_t next = 0;
  for (uint32_t index = 0; names.size() < std::min(missing, kMostNamed); ++index)
    if (next < parts.size() && indexOf(next) == index)
      ++next;
    else
      names.push_back(fmt::format("{}/{}", index + 1, count));
  throwInput(
      "{}{} of {} shards missing: {}{}",
      parts[0].settings.crop ? fmt::format("crop {}: ", nameOf(*parts[0].settings.crop)) : "",
      missing, count, fmt::join(names, ", "), missing > kMostNamed ? ", ..." : "");
}

bool overlap(const Crop& a, const Crop& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

// `crops`: one part of each crop.
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

// The plan for the whole image, without the plate and the reflectance.
FinishPlan wholePlan(FinishPlan plan) {
  RenderSettings& s = plan.settings;
  s.crop.reset();
  s.samples = s.samplesOfAll();
  s.shard = {};
  return plan;
}

// The images of a composite, its layers and light groups are not counted by imageBytes().
double bytesOf(const FinishPlan& plan) {
  const RenderSettings& s = plan.settings;
  double perPixel = 0;
  if (const size_t layers = plan.layers().size(); layers > 0)
    perPixel += double(LayerFilm::bytesPerPixel(layers, s.wantsFeatures()));
  perPixel += 2 * double(plan.groups.size() * sizeof(Rgb));
  if (const auto& composite = plan.composite)
    perPixel +=
        2 * sizeof(float) * double(composite->plate.channels + composite->reflectance.channels);
  return imageBytes(s) + perPixel * s.width * s.height;
}

// Whether the films of a part can be added to the whole's.
bool fits(const FinishPlan& part, const FinishPlan& whole) {
  const RenderSettings &a = part.settings, &b = whole.settings;
  return a.width == b.width && a.height == b.height && a.aovs == b.aovs && a.denoise == b.denoise &&
         part.groups == whole.groups && part.composite.has_value() == whole.composite.has_value() &&
         (!part.composite ||
          (part.composite->plate.channels == whole.composite->plate.channels &&
           part.composite->reflectance.channels == whole.composite->reflectance.channels));
}

void addImages(FinishPlan& part, Archive& a, CompositeFinish& whole) {
  part.archiveImages(a);
  const Crop window = part.settings.window();
  paste(part.composite->plate, window, whole.plate);
  paste(part.composite->reflectance, window, whole.reflectance);
}

// Adds a part band by band, so that it is never in memory as a whole. Each pixel gets the parts in
// the order of the calls.
void addPart(const std::string& path, MergedParts& whole) {
  readExrState(path, [&](Archive& a) {
    RenderPart part;
    part.archive(a);
    a.check(fits(part.plan, whole.part.plan));
    const Crop window = part.plan.settings.window();
    if (whole.part.plan.composite) addImages(part.plan, a, *whole.part.plan.composite);

    const RenderSettings& settings = part.plan.settings;
    const auto filmsOf = [&](Rows rows) {
      RenderSettings band = settings;
      band.crop = {window.x, window.y + rows.begin, window.width, rows.count};
      return RenderResult(band, part.plan.layers());
    };
    RenderResult totals = filmsOf({0, 1});
    totals.archiveTotals(a);
    if (totals.isRepeated)
      throwInput("{}: has no samples of its own yet; let its render go on", path);
    const bool isWeighed = totals.film.isWeighed();
    if (isWeighed) whole.result.film.beWeighed();
    whole.result.addTotals(totals);
    whole.addSamples(settings, totals.samples);

    const Bands bands{window.width, window.height};
    PerThread<std::optional<RenderResult>> films;  // of one band each
    a.blocks(bands.count(), [&](Archive& block, size_t index) {
      const Rows rows = bands.rows(index);
      std::optional<RenderResult>& band = films.local();
      if (!band || band->film.height() != rows.count) band.emplace(filmsOf(rows));
      if (isWeighed) band->film.beWeighed();
      band->archivePixels(block, {0, rows.count});
      whole.result.addPixels(*band, window.x, window.y + rows.begin);
    });
  });
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

MergedParts merge(const PartSet& parts, const Progress& progress) {
  const RenderPart first = readPartHeader(parts.paths().front());
  const FinishPlan plan = wholePlan(first.plan);
  const RenderSettings& s = plan.settings;
  if (const double needed = bytesOf(plan); needed > memoryBudget())
    throwInput("{}: an image of {}x{} takes {:.3g} GB of memory", parts.paths().front(), s.width,
               s.height, needed * 1e-9);
  MergedParts whole{{withoutParts(first.identity), plan}, RenderResult(s, plan.layers())};
  if (auto& composite = whole.part.plan.composite)
    for (Image* image : {&composite->plate, &composite->reflectance})
      if (image->channels > 0) *image = Image(s.width, s.height, image->channels);
  for (size_t i = 0; i < parts.paths().size(); ++i) {
    addPart(parts.paths()[i], whole);
    progress(double(i + 1) / double(parts.paths().size()));
  }
  return whole;
}

void MergedParts::addSamples(const RenderSettings& ofPart, uint32_t samples) {
  const Shard& shard = ofPart.shard;
  samplesOfCrop = shard.index == 0 ? samples : samplesOfCrop + samples;
  if (shard.count > 1) samplesOfCrop = std::min(samplesOfCrop, shard.samplesOfAll);  // rounded up
  if (shard.index + 1 < shard.count) return;
  const Crop window = ofPart.window();
  samplesOfPixels += double(samplesOfCrop) * window.width * window.height;
  result.samples =
      uint32_t(std::lround(samplesOfPixels / (double(ofPart.width) * double(ofPart.height))));
}

}  // namespace chromeball
