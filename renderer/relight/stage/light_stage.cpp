// SPDX-License-Identifier: Apache-2.0
#include "relight/stage/light_stage.h"

#include <algorithm>

#include "base/error.h"
#include "relight/stage/direction_basis.h"

namespace chromeball {

int stageChannels(const DirectionBasis& basis) {
  constexpr int kOthers = 6;  // colour, and the scene's own light
  return 3 * basis.size() + kOthers;
}

void checkStageSize(const DirectionBasis& basis, int width, int height, std::string_view location) {
  const uint64_t numbers = uint64_t(width) * uint64_t(height) * uint64_t(stageChannels(basis));
  if (numbers > kMaxStageNumbers)
    throwInput(
        "{}: {} x {} pixels with {} elements are {} numbers; the limit is {}: take a smaller "
        "size or fewer directions",
        location, width, height, basis.size(), numbers, kMaxStageNumbers);
}

double elementBytes(const DirectionBasis& basis) { return 3. * sizeof(float) * basis.size(); }

void checkInMemory(const DirectionBasis& basis, int width, int height, double memory,
                   std::string_view location) {
  const double bytes = elementBytes(basis) * width * height;
  if (bytes > memory)
    throwInput("{}: {} elements of {} x {} pixels take {:.3g} GB of memory; {:.3g} GB are left",
               location, basis.size(), width, height, 1e-9 * bytes, 1e-9 * std::max(memory, 0.0));
}

std::vector<Rgb> lightWeights(const DirectionBasis& basis, const Image& latLong,
                              const Rotation& rotation, int leastWidth) {
  const Probe probe(latLong);
  const auto fine = [](int texels, int least) { return texels * ((least + texels - 1) / texels); };
  // The harmonics are smooth, and a search for the nearest direction is slow.
  if (!basis.hasCells() || basis.kind() == DirectionBasis::Nearest)
    leastWidth = std::min(leastWidth, 1024);
  const ImageSize grid{fine(latLong.width, leastWidth), fine(latLong.height, leastWidth / 2)};
  const auto count = size_t(basis.size());
  const auto sums = sumOverSphere<glm::dvec4>(
      grid, count, [&](const dvec3& d, double solidAngle, std::vector<glm::dvec4>& elements) {
        const glm::dvec4 light(dvec3(probe.radiance(vec3(d))), 1);
        basis.forValues(vec3(rotation(d)), [&](int element, float value) {
          elements[size_t(element)] += solidAngle * double(value) * light;
        });
      });
  std::vector<Rgb> weights(count, Rgb(0));
  for (size_t i = 0; i < count; ++i) {
    if (!basis.hasCells()) weights[i] = Rgb(sums[i]);
    // A cell that is smaller than the grid's texels may have none.
    else if (sums[i].w > 0)
      weights[i] = Rgb(dvec3(sums[i]) / sums[i].w);
  }
  return weights;
}

Image reflectanceFunction(const LightStage& stage, int x, int y) {
  const DirectionBasis& basis = stage.basis;
  const bool isBoxes = basis.kind() == DirectionBasis::LatLong;
  Image map(isBoxes ? basis.columns() : 64, isBoxes ? basis.rows() : 32, 3);
  const std::vector<double> solidAngles =
      basis.hasCells() ? cellSolidAngles(basis) : std::vector<double>(size_t(basis.size()), 1);
  const float* elements = stage.elements.at(x, y);
  for (int row = 0; row < map.height; ++row)
    for (int column = 0; column < map.width; ++column) {
      Rgb sum(0);
      basis.forValues(
          vec3(texelDirection({map.width, map.height}, column, row)), [&](int i, float value) {
            const Rgb element(elements[3 * i], elements[3 * i + 1], elements[3 * i + 2]);
            sum += element * (value / float(solidAngles[size_t(i)]));
          });
      map.setRgb(column, row, sum);
    }
  return map;
}

}  // namespace chromeball
