// SPDX-License-Identifier: Apache-2.0
// The lighting conditions under which a light stage shows a scene: functions on the sphere of
// directions, whose weighted sum approximates a probe (HDRI book, section 9.9.2).
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/parallel.h"
#include "math/rotation.h"
#include "probe/mapping.h"

namespace chromeball {

// Real spherical harmonics of any order.

constexpr int shCount(int order) { return (order + 1) * (order + 1); }

// Y_lm of a unit direction at l (l + 1) + m, for l up to `order`: orthonormal over the sphere, with
// the signs of shBasis() (probe/irradiance.h), whose nine functions are the first. By the
// recurrence of the normalised Legendre functions (Sloan 2013, "Efficient Spherical Harmonic
// Evaluation", section 2). `out` has shCount(order) elements.
void shBasis(const dvec3& direction, int order, std::span<double> out);

// Either cells: functions that are 1 in one part of the sphere and 0 elsewhere; or spherical
// harmonics.
class DirectionBasis {
 public:
  enum Kind {
    LatLong,    // W x H boxes of a lat-long map, by rows
    Cube,       // 6 faces (+X -X +Y -Y +Z -Z, each from inside) of N x N squares, by faces and rows
    Icosphere,  // the faces of icosphereNormals()
    Nearest,    // the directions nearest to each of a list: Voronoi cells
    Sh          // spherical harmonics up to an order
  };
  static constexpr int kMaxElements = 8192, kMaxOrder = 16;

  // "lat-long:WxH", "cube:N", "icosphere:SUBDIVISIONS", "sh:ORDER". Throws InputError, begun by
  // `location`.
  DirectionBasis(std::string_view name, std::string_view location);
  // The kind Nearest: the Voronoi cells of unit directions, at least one.
  explicit DirectionBasis(std::vector<vec3> directions);

  Kind kind() const { return kind_; }
  bool hasCells() const { return kind_ != Sh; }
  const std::string& name() const { return name_; }
  int size() const { return size_; }
  int columns() const { return columns_; }  // W; N of a cube
  int rows() const { return rows_; }        // H; N of a cube

  // The cell that contains a unit direction.
  int cell(const vec3& direction) const;

  // Calls visit(element, value) for the functions that are not 0 at a unit direction.
  template <class Visit>
  void forValues(const vec3& direction, const Visit& visit) const {
    if (hasCells()) return visit(cell(direction), 1.0f);
    std::array<double, shCount(kMaxOrder)> values;
    shBasis(dvec3(direction), order_, std::span(values).first(size_t(size_)));
    for (int i = 0; i < size_; ++i) visit(i, float(values[size_t(i)]));
  }

 private:
  Kind kind_;
  std::string name_;
  int size_ = 0, columns_ = 0, rows_ = 0;
  int order_ = 0;  // of the harmonics, or the subdivisions of the icosphere
  std::vector<vec3> directions_;
};

// The solid angle of each cell, sr: exact for boxes of a lat-long map, else by quadrature, to about
// 1e-3 of a cell of a hundredth of the sphere.
std::vector<double> cellSolidAngles(const DirectionBasis& basis);

// Sums over the texels of a lat-long grid, on all threads.

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
