// SPDX-License-Identifier: Apache-2.0
#include "film/aov.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/text.h"

namespace chromeball {
namespace {

constexpr float kNoDepth = 1e10f;

bool isIndex(Aov aov) { return aov == Aov::Material || aov == Aov::Node; }

// Gives 1 for a zero vector.
double lengthOf(const double* v) {
  const double length = std::hypot(v[0], v[1], v[2]);
  return length > 0 ? length : 1;
}

}  // namespace

const std::vector<AovInfo>& allAovs() {
  using Hit = const FirstHit&;
  static const std::vector<AovInfo> infos{
      {Aov::Albedo, "albedo", "RGB", [](Hit hit) { return hit.albedo; }},
      {Aov::Normal, "normal", "XYZ", [](Hit hit) { return hit.normal; }},
      {Aov::Depth, "depth", "Z", [](Hit hit) { return vec3(hit.depth); }},
      {Aov::Alpha, "alpha", "A", [](Hit) { return vec3(1); }},
      {Aov::Variance, "variance", "RGB"},
      {Aov::Samples, "samples", ""},
      {Aov::Material, "material", ""},
      {Aov::Node, "node", ""},
      {Aov::Invalid, "invalid", "RGB"},
      {Aov::Denoise, "denoise", ""},
      {Aov::AmbientOcclusion, "ao", "", [](Hit hit) { return vec3(hit.ambientOcclusion); }},
      {Aov::BentNormal, "bent_normal", "XYZ", [](Hit hit) { return hit.unoccluded; }},
      {Aov::Irradiance, "irradiance", "RGB", [](Hit hit) { return hit.irradiance; }}};
  return infos;
}

const AovInfo& aovInfo(Aov aov) { return allAovs()[size_t(aov)]; }

Aov aovFromName(const std::string& name, const std::string& location) {
  std::vector<std::string_view> names;
  for (const AovInfo& info : allAovs()) {
    if (name == info.name) return info.aov;
    names.push_back(info.name);
  }
  throwInput("{}: AOV `{}` is not known; {}", location, name, didYouMean(name, names));
}

AovFilm::AovFilm(int width, int height, const std::vector<Aov>& wanted)
    : width_(width), height_(height) {
  const size_t pixels = size_t(width) * height;
  for (Aov aov : wanted) {
    if (aov == Aov::Variance || aov == Aov::Samples || aov == Aov::Denoise) continue;
    const int channels = std::max<int>(1, int(std::strlen(aovInfo(aov).channels)));
    sums_.push_back({aov, channels, longArray<double>(pixels * size_t(channels))});
  }
  if (sums_.empty()) return;
  samples_.resize(pixels);
  hits_.resize(pixels);
}

void AovFilm::add(int x, int y, const FirstHit& first) {
  const size_t index = pixel(x, y);
  ++samples_[index];
  if (!first.hit) return;
  const bool isFirst = hits_[index]++ == 0;
  for (Sum& sum : sums_) {
    double* to = &sum.sums[index * sum.channels];
    if (const auto summed = aovInfo(sum.aov).summed) {
      const vec3 value = summed(first);
      for (int c = 0; c < sum.channels; ++c) to[c] += value[c];
    } else if (isFirst && isIndex(sum.aov)) {
      *to = (sum.aov == Aov::Material ? first.material : first.node) + 1;
    }
  }
}

void AovFilm::add(int x, int y, Defect defect) {
  for (Sum& sum : sums_)
    if (sum.aov == Aov::Invalid) sum.sums[pixel(x, y) * sum.channels + size_t(defect)] += 1;
}

void AovFilm::add(const AovFilm& part, int left, int top) {
  for (int y = 0; y < part.height_ && !empty(); ++y)
    for (int x = 0; x < part.width_; ++x) {
      const size_t from = part.pixel(x, y), to = pixel(left + x, top + y);
      for (size_t i = 0; i < sums_.size(); ++i) {
        Sum& sum = sums_[i];
        if (isIndex(sum.aov) && hits_[to] > 0) continue;
        for (int c = 0; c < sum.channels; ++c)
          sum.sums[to * sum.channels + c] += part.sums_[i].sums[from * sum.channels + c];
      }
      samples_[to] += part.samples_[from];
      hits_[to] += part.hits_[from];
    }
}

void AovFilm::copyPixels(const AovFilm& from, const PixelRect& rect) {
  if (empty()) return;
  for (size_t i = 0; i < sums_.size(); ++i)
    rect.copy(from.sums_[i].sums, sums_[i].sums, width_, size_t(sums_[i].channels));
  rect.copy(from.samples_, samples_, width_);
  rect.copy(from.hits_, hits_, width_);
}

AovFilm AovFilm::part(const PixelRect& rect) const {
  AovFilm part(rect.width, rect.height, {});
  for (const Sum& sum : sums_)
    part.sums_.push_back({sum.aov, sum.channels, rect.of(sum.sums, width_, size_t(sum.channels))});
  part.samples_ = rect.of(samples_, width_);
  part.hits_ = rect.of(hits_, width_);
  return part;
}

void AovFilm::archive(Archive& a, Rows rows) {
  if (empty()) return;
  for (Sum& sum : sums_) a.items(rows.of(sum.sums, size_t(width_ * sum.channels)));
  a.items(rows.of(samples_, size_t(width_)));
  a.items(rows.of(hits_, size_t(width_)));
}

Image AovFilm::finished(Aov aov) const {
  for (const Sum& sum : sums_) {
    if (sum.aov != aov) continue;
    Image image(width_, height_, sum.channels);
    forRanges(image.texels.size(), [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        const size_t index = i / sum.channels;
        double divisor = 1;
        if (aov == Aov::Depth) divisor = hits_[index];
        if (aov == Aov::AmbientOcclusion || aov == Aov::Irradiance)
          divisor = std::max(hits_[index], 1u);
        if (aov == Aov::BentNormal) divisor = lengthOf(&sum.sums[index * sum.channels]);
        if (aov == Aov::Albedo || aov == Aov::Normal || aov == Aov::Alpha)
          divisor = std::max(samples_[index], 1u);  // an interrupted render may have no samples
        image.texels[i] = divisor > 0 ? float(sum.sums[i] / divisor) : kNoDepth;
      }
    });
    return image;
  }
  return {};
}

}  // namespace chromeball
