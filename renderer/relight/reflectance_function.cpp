// SPDX-License-Identifier: Apache-2.0
#include "relight/reflectance_function.h"

namespace chromeball {

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
