// SPDX-License-Identifier: Apache-2.0
// Moments of a lat-long map over rectangles of its texels, in a quadtree.
#pragma once

#include <vector>

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

// A rectangle of a lat-long map. Azimuth phi = 2 pi u; the direction is (-sin(theta) sin(phi),
// cos(theta), sin(theta) cos(phi)).
struct MapRectangle {
  double phi0, phi1, theta0, theta1;  // radians

  MapRectangle quarter(int i) const;  // 0 to 3
};

struct RectangleGeometry {
  dvec3 centre;  // unit
  double solidAngle;
  double directionLength;  // the integral of the direction is centre times this
  double radius;           // no point is further from the centre (chord)

  explicit RectangleGeometry(const MapRectangle& r);
};

// The integrals of radiance L over a rectangle, per channel.
struct RadianceMoments {
  dvec3 flux{0};         // of L
  dvec3 offset[3] = {};  // of L times the components of (direction - centre)

  RadianceMoments() = default;
  RadianceMoments(const dvec3& radiance, const RectangleGeometry& geometry);  // constant
};

// How far the light of a rectangle is from its centre, how unevenly it fills it, and how much of
// the map's it is; channels are summed.
struct LightSpread {
  double squared;        // the mean squared chord from the centre, weighted by radiance
  double concentration;  // the largest radiance relative to the mean; 1: constant
  double share;          // of the map's flux
};

// Level 0 is the texels, for which nothing is stored; a node of level k is 2^k texels wide and
// high, less at the map's edges. Takes a third of 104 bytes a texel.
class MapMoments {
 public:
  explicit MapMoments(const Image& latLong);  // `latLong` must outlive this

  struct Node {
    int level, x, y;
  };
  Node root() const { return {levels() - 1, 0, 0}; }
  MapRectangle rectangle(const Node& node) const;
  RectangleGeometry geometry(const Node& node) const;
  RadianceMoments moments(const Node& node, const RectangleGeometry& geometry) const;
  dvec3 radiance(const Node& texel) const;  // of a node of level 0
  LightSpread spread(const Node& node, const RectangleGeometry& geometry) const;
  // Of a part of a texel.
  LightSpread spread(const dvec3& radiance, const RectangleGeometry& geometry) const;

  // Calls `visit` with each child of a node above level 0.
  template <class Visit>
  void forChildren(const Node& node, const Visit& visit) const {
    const int level = node.level - 1, columns = columnsOf(level), rows = rowsOf(level);
    for (int y = 2 * node.y; y < std::min(2 * node.y + 2, rows); ++y)
      for (int x = 2 * node.x; x < std::min(2 * node.x + 2, columns); ++x) visit(Node{level, x, y});
  }

 private:
  struct Stored {
    RectangleGeometry geometry;
    Rgb flux, offset[3];        // as RadianceMoments
    float squaredSpread, peak;  // LightSpread::squared; the largest radiance, summed over channels
  };
  int levels() const { return int(stored_.size()) + 1; }
  int columnsOf(int level) const { return ((map_->width - 1) >> level) + 1; }
  int rowsOf(int level) const { return ((map_->height - 1) >> level) + 1; }
  const Stored& stored(const Node& node) const {
    return stored_[size_t(node.level) - 1][size_t(node.y) * columnsOf(node.level) + node.x];
  }
  Stored sumOfChildren(const Node& node) const;

  const Image* map_;
  std::vector<std::vector<Stored>> stored_;  // of the levels from 1 on
  double flux_ = 0;                          // of the map, over all channels
};

}  // namespace chromeball
