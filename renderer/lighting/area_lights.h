// SPDX-License-Identifier: Apache-2.0
// Area lights that replace the probe: constellations without the aliasing of delta lights.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "image/image.h"
#include "lighting/constellation/directional_light.h"
#include "lighting/constellation/texel_table.h"
#include "lighting/probe_light.h"
#include "math/cdf.h"
#include "math/vec.h"
#include "math/warp.h"

namespace chromeball {

// The shapes of area lights at infinity: parts of the sphere of directions.

// A light of constant radiance over a solid angle.
struct AreaLight {
  vec3 direction;     // unit, towards its middle
  Rgb power;          // radiance x solid angle
  double solidAngle;  // steradians, above 0

  Rgb radiance() const { return Rgb(glm::dvec3(power) / solidAngle); }
};

class LightAreas {
 public:
  virtual ~LightAreas() = default;

  const std::vector<AreaLight>& lights() const { return lights_; }

  // The sum over all lights in a direction.
  struct Found {
    Rgb radiance{0};
    float density = 0;  // sum of 1 / solid angle: the pdf of one direction in each light
  };
  virtual Found at(const vec3& wi) const = 0;
  // Adds the radiance of each light in a direction to its element.
  virtual void split(const vec3& wi, std::span<Rgb> radiances) const = 0;

  // A direction in a light, uniform over its solid angle, from two numbers in [0, 1).
  struct Sample {
    vec3 direction;
    Found found;  // there
  };
  virtual Sample sample(size_t light, double u, double v) const = 0;

 protected:
  std::vector<AreaLight> lights_;
};

// Area lights that are discs, which may overlap.

class DiscAreas : public LightAreas {
 public:
  // Each light becomes the disc around its direction with its solid angle. At most 65535 lights.
  explicit DiscAreas(std::vector<AreaLight> lights);

  Found at(const vec3& wi) const override;
  void split(const vec3& wi, std::span<Rgb> radiances) const override;
  Sample sample(size_t light, double u, double v) const override;

 private:
  static constexpr int kRows = 64, kColumns = 2 * kRows;

  void listCells();
  const std::vector<uint16_t>& cellOf(const vec3& wi) const;

  std::vector<SphericalCap> discs_;
  std::vector<Found> found_;  // in each disc, without the others
  std::vector<std::vector<uint16_t>>
      cells_;  // the discs that may touch each cell of a lat-long map
};

// Area lights that are the regions of a lat-long map.

// Each light has the energy of its region, the sum of radiance x solid angle over the texels; its
// direction is the energy's centroid. Solid angles are exact: sums over rectangles of texels. Black
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

// Broad lobes are lit by the lights, in place of the probe; the camera, mirrors and lobes narrower
// than mirrorAlpha() see the probe, as with DeltaLights. The pdf of light samples is the sum over
// all samples of a call, and BSDF samples find the lights too.
//
// The first hit samples one direction in each light, uniform over its solid angle: Kollig and
// Keller's stratification with the regions' average colours (2003; HDRI book, section 9.6.2). Later
// hits sample kLater lights, chosen with probability proportional to power.
class AreaLights : public ProbeLight {
 public:
  static constexpr int kLater = 4;

  AreaLights(const Probe& probe, std::unique_ptr<const LightAreas> areas);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;
  float mirrorAlpha() const override;
  bool unbiased() const override { return false; }
  // The lights by number; then what the camera and mirrors see.
  std::vector<std::string> groups() const override;
  void splitEscaped(const LightPoint&, const vec3& wi, std::span<Rgb> radiances) const override {
    areas_->split(wi, radiances);
  }

 private:
  bool samplesAll(int depth) const { return depth == 0 || int(areas_->lights().size()) <= kLater; }
  // The pdf of the samples at a hit, over solid angle.
  float pdf(const LightAreas::Found& found, int depth) const;

  std::unique_ptr<const LightAreas> areas_;
  CdfRows choice_;    // of a light by power
  double power_ = 0;  // luminance of all lights
};

}  // namespace chromeball
