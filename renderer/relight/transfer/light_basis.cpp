// SPDX-License-Identifier: Apache-2.0
#include "relight/transfer/light_basis.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "base/error.h"

namespace chromeball {
namespace {

// "haar:16" is the transform of "cube:16".
DirectionBasis directionsOf(const std::string& name, const std::string& location) {
  const auto is = [&](const char* kind, int number) {
    return name == fmt::format("{}:{}", kind, number);
  };
  for (int order = 0; order <= LightBasis::kMaxOrder; ++order)
    if (is("sh", order)) return {name, location};
  for (int cells = 1; cells <= LightBasis::kMaxCells; cells *= 2)
    if (is("haar", cells)) return {fmt::format("cube:{}", cells), location};
  throwInput("{}: `{}` is not sh:ORDER, of order 0 to {}, or haar:N, N a power of two from 1 to {}",
             location, name, LightBasis::kMaxOrder, LightBasis::kMaxCells);
}

}  // namespace

LightBasis::LightBasis(const std::string& name, const std::string& location)
    : name_(name),
      directions_(directionsOf(name, location)),
      domain_(directions_.hasCells() ? RelightDomain::Haar : RelightDomain::Sh) {}

std::vector<Rgb> LightBasis::project(const Image& latLong, const Rotation& rotation) const {
  std::vector<Rgb> light = lightWeights(directions_, latLong, rotation);
  transform(light);
  return light;
}

double LightBasis::support(size_t function) const {
  if (!isHaar()) return 1;
  const auto n = size_t(directions_.columns());
  const size_t largest = std::max(function % n, function / n % n);
  const auto blocks = double(std::bit_floor(std::max<size_t>(largest, 1)));  // along an edge
  return 1 / (blocks * blocks);
}

void keepMostImportant(const LightBasis& basis, size_t keep, std::span<Rgb> light) {
  std::vector<size_t> order(light.size());
  std::iota(order.begin(), order.end(), size_t(0));
  const auto importance = [&](size_t i) { return glm::length(dvec3(light[i])) * basis.support(i); };
  std::ranges::stable_sort(order,
                           [&](size_t a, size_t b) { return importance(a) > importance(b); });
  for (size_t i = keep; i < order.size(); ++i) light[order[i]] = Rgb(0);
}

}  // namespace chromeball
