// SPDX-License-Identifier: Apache-2.0
// The lighting conditions under which a light stage shows a scene: functions on the sphere of
// directions, whose weighted sum approximates a probe (HDRI book, section 9.9.2).
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "math/rotation.h"
#include "probe/mapping.h"
#include "relight/sh_basis.h"

namespace chromeball {

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
  // Nearest; at least one unit direction.
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

}  // namespace chromeball
