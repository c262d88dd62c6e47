// SPDX-License-Identifier: Apache-2.0
#include "lighting/constellation/cube_grid.h"

#include "probe/mapping.h"

namespace chromeball {
namespace {

// Faces are numbered 2 axis + (negative ? 1 : 0); squares row by row along the other two axes.
int squareOf(const dvec3& d, int n) {
  const dvec3 size = glm::abs(d);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto index = [&](double s) {
    return std::clamp(int((s / size[axis] + 1) / 2 * n), 0, n - 1);
  };
  const int face = 2 * axis + (d[axis] < 0);
  return (face * n + index(d[(axis + 1) % 3])) * n + index(d[(axis + 2) % 3]);
}

dvec3 middleOf(int square, int n) {
  const int face = square / (n * n), axis = face / 2;
  dvec3 d;
  d[axis] = face % 2 ? -1 : 1;
  d[(axis + 1) % 3] = 2 * (square / n % n + 0.5) / n - 1;
  d[(axis + 2) % 3] = 2 * (square % n + 0.5) / n - 1;
  return glm::normalize(d);
}

}  // namespace

Constellation cubeGrid(const TexelTable& table, int n) {
  std::vector<TexelSum> squares(size_t(6) * n * n);
  for (const TexelSum& cell : table.cells())
    if (cell.weight > 0) squares[squareOf(cell.moment, n)] += cell;
  Constellation lights;
  for (size_t i = 0; i < squares.size(); ++i)
    if (squares[i].weight > 0) lights.push_back(makeLight(middleOf(int(i), n), squares[i].power));
  return lights;
}

Partition cubeGridRegions(const Image& latLong, int n) {
  Partition partition{6 * n * n, {}};
  partition.label.reserve(size_t(latLong.width) * latLong.height);
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x)
      partition.label.push_back(
          uint16_t(squareOf(texelDirection({latLong.width, latLong.height}, x, y), n)));
  return partition;
}

}  // namespace chromeball
