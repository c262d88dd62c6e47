// SPDX-License-Identifier: Apache-2.0
// Area lights that are the regions of a lat-long map.
#pragma once

#include "image/image.h"
#include "lighting/area/light_areas.h"
#include "lighting/constellation/partition.h"
#include "lighting/constellation/texel_table.h"
#include "probe/map_turn.h"

namespace chromeball {

// Each light has the energy of its region, the sum of radiance x solid angle over the texels; its
// direction is the energy's centroid. Solid angles are exact: those of rectangles of texels. Black
// regions make no lights.
class RegionAreas : public LightAreas {
 public:
  // The partition is of `latLong`. Both are turned, as a Probe.
  RegionAreas(const Image& latLong, Partition partition, const Rotation& rotation);

  Found at(const vec3& wi) const override;
  void split(const vec3& wi, std::span<Rgb> radiances) const override;
  Sample sample(size_t light, double u, double v) const override;

 private:
  // Columns [x0, x1) of rows [y0, y1), and the solid angle of the region up to its end.
  struct Rectangle {
    int x0, x1, y0, y1;
    double sum;
  };
  struct Region {
    std::vector<Rectangle> rectangles;
    TexelSum energy;

    double solidAngle() const { return rectangles.empty() ? 0 : rectangles.back().sum; }
    void add(const Rectangle& run, double runSolidAngle);  // of one row, below those before
  };
  std::vector<Region> regionsOf(const Image& latLong) const;
  uint16_t lightIn(const vec3& wi) const;  // kNoRegion: none

  int width_, height_;
  MapTurn turn_;                 // as the rotation
  Partition partition_;          // afterwards into lights
  std::vector<Region> regions_;  // of each light
  std::vector<Found> found_;     // in each light
};

}  // namespace chromeball
