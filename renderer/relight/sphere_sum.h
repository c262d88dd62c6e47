// SPDX-License-Identifier: Apache-2.0
// Sums over the texels of a lat-long grid, on all threads.
#pragma once

#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "probe/solid_angle.h"

namespace chromeball {

// Calls add(direction, solidAngle, sums) for every texel's centre and exact solid angle; `sums` has
// `count` elements, which start at 0. The same bits for any number of threads: the rows are divided
// into a fixed number of parts.
template <class T, class Add>
std::vector<T> sumOverSphere(const ImageSize& grid, size_t count, const Add& add) {
  constexpr int kParts = 32;
  std::vector<dvec3> columns(static_cast<size_t>(grid.width));  // directions of the equator
  for (int x = 0; x < grid.width; ++x) columns[size_t(x)] = texelDirection({grid.width, 1}, x, 0);
  std::vector<std::vector<T>> parts(kParts, std::vector<T>(count, T(0)));
  parallelFor(0, kParts, [&](int part) {
    for (int y = grid.height * part / kParts; y < grid.height * (part + 1) / kParts; ++y) {
      const double solidAngle = texelSolidAngle(y, grid.width, grid.height);
      const dvec3 row = texelDirection({1, grid.height}, 0, y);
      const double sine = std::hypot(row.x, row.z);
      for (const dvec3& column : columns)
        add(dvec3(sine * column.x, row.y, sine * column.z), solidAngle, parts[size_t(part)]);
    }
  });
  for (size_t part = 1; part < kParts; ++part)
    for (size_t i = 0; i < count; ++i) parts[0][i] += parts[part][i];
  return std::move(parts[0]);
}

}  // namespace chromeball
