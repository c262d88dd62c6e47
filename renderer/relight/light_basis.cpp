// SPDX-License-Identifier: Apache-2.0
#include "relight/light_basis.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <numeric>

#include "base/error.h"
#include "probe/sh_bands.h"
#include "probe/solid_angle.h"
#include "relight/haar.h"

namespace chromeball {
namespace {

constexpr size_t kFaces = 6;

std::optional<int> wholeNumber(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return number;
}

}  // namespace

LightBasis LightBasis::parse(std::string_view text, std::string_view location) {
  const size_t colon = text.find(':');
  const std::string_view kind = text.substr(0, colon);
  const auto number = colon == text.npos ? std::nullopt : wholeNumber(text.substr(colon + 1));
  if (number && kind == "sh" && *number >= 0 && *number <= kMaxOrder)
    return {Kind::Harmonics, *number};
  if (number && kind == "haar" && *number >= 1 && *number <= kMaxCells &&
      std::has_single_bit(unsigned(*number)))
    return {Kind::Haar, *number};
  throwInput("{}: `{}` is not sh:ORDER, of order 0 to {}, or haar:N, N a power of two from 1 to {}",
             location, text, kMaxOrder, kMaxCells);
}

size_t LightBasis::size() const {
  const auto n = size_t(number_);
  return kind_ == Kind::Harmonics ? (n + 1) * (n + 1) : kFaces * n * n;
}

std::string LightBasis::name() const {
  return fmt::format("{}:{}", kind_ == Kind::Harmonics ? "sh" : "haar", number_);
}

size_t LightBasis::cellOf(const vec3& direction) const {
  const dvec2 uv = directionToUv(Mapping::VerticalStrip, dvec3(direction));
  const auto at = [](double position, int count) {
    return size_t(std::clamp(int(position * count), 0, count - 1));
  };
  return at(uv.y, int(kFaces) * number_) * size_t(number_) + at(uv.x, number_);
}

void LightBasis::add(const vec3& direction, const dvec3& weight, std::span<dvec3> sums) const {
  if (kind_ == Kind::Haar) {
    sums[cellOf(direction)] += weight;
    return;
  }
  std::array<double, shCountOf(kMaxOrder)> basis;
  shBasis(dvec3(direction), number_, basis);
  for (size_t k = 0; k < sums.size(); ++k) sums[k] += basis[k] * weight;
}

void LightBasis::transform(std::span<dvec3> sums) const {
  if (kind_ == Kind::Harmonics) return;
  const size_t cells = size_t(number_) * size_t(number_);
  std::vector<double> grid(cells);
  for (size_t face = 0; face < kFaces; ++face)
    for (int channel = 0; channel < 3; ++channel) {
      const std::span<dvec3> part = sums.subspan(face * cells, cells);
      for (size_t i = 0; i < cells; ++i) grid[i] = part[i][channel];
      haarForward(std::span(grid), number_);
      for (size_t i = 0; i < cells; ++i) part[i][channel] = grid[i];
    }
}

// Texels are divided until a cell has about eight rows of them, so that its border is sharp enough.
std::vector<dvec3> LightBasis::cellMeans(const Image& latLong, const Rotation& rotation) const {
  const int parts = std::max(1, (16 * number_ + latLong.height - 1) / latLong.height);
  const ImageSize fine{latLong.width * parts, latLong.height * parts};
  std::vector<dvec3> sums(size(), dvec3(0));
  std::vector<double> solidAngles(size());
  for (int y = 0; y < fine.height; ++y) {
    const double solidAngle = texelSolidAngle(y, fine.width, fine.height);
    for (int x = 0; x < fine.width; ++x) {
      const size_t cell = cellOf(vec3(rotation(texelDirection(fine, x, y))));
      sums[cell] += solidAngle * dvec3(latLong.rgb(x / parts, y / parts));
      solidAngles[cell] += solidAngle;
    }
  }
  for (size_t i = 0; i < sums.size(); ++i) sums[i] /= solidAngles[i];
  return sums;
}

std::vector<dvec3> LightBasis::project(const Image& latLong, const Rotation& rotation) const {
  if (kind_ == Kind::Harmonics) return projectSh(latLong, number_, rotation);
  std::vector<dvec3> light = cellMeans(latLong, rotation);
  transform(light);
  return light;
}

double LightBasis::support(size_t function) const {
  if (kind_ == Kind::Harmonics) return 1;
  const auto n = size_t(number_);
  const size_t largest = std::max(function % n, function / n % n);
  const auto blocks = double(std::bit_floor(std::max<size_t>(largest, 1)));  // along an edge
  return 1 / (blocks * blocks);
}

void keepLargest(const LightBasis& basis, size_t keep, std::span<dvec3> light) {
  std::vector<size_t> order(light.size());
  std::iota(order.begin(), order.end(), size_t(0));
  const auto importance = [&](size_t i) { return glm::length(light[i]) * basis.support(i); };
  std::ranges::stable_sort(order,
                           [&](size_t a, size_t b) { return importance(a) > importance(b); });
  for (size_t i = keep; i < order.size(); ++i) light[order[i]] = dvec3(0);
}

}  // namespace chromeball
