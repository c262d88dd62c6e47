// SPDX-License-Identifier: Apache-2.0
// The sun that photographs of a probe have clipped, from a photograph of a diffuse ball in its
// light.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "probe/capture/photograph.h"
#include "probe/load.h"
#include "probe/mapping.h"
#include "probe/sun_extraction.h"

namespace chromeball {

// A photograph of a diffuse ball, as measurements of irradiance.

struct DiffuseBall {
  Circle circle;  // its outline, in pixels from the top left corner
  dvec3 paint;    // reflectance, above 0
  CameraPosition camera = {};
  double distance = std::numeric_limits<double>::infinity();  // to its centre, in radii; above 1

  // The normal (unit) at a point of the circle, x right and y up, of radius 1.
  dvec3 normalAt(const dvec2& point) const;
};

// A pixel, or the mean of a block of them.
struct BallSample {
  int x, y;        // of the block, from the top left corner of the circle's square
  vec3 normal;     // in the world
  dvec3 radiance;  // of a white ball: the photograph's / paint
};

struct BallSamples {
  std::vector<BallSample> samples;
  int side = 0;        // blocks across the circle's square
  int block = 1;       // pixels across a block: the circle's radius is at most 128 blocks
  size_t invalid = 0;  // pixels that are not finite or negative: their blocks are left out
};

// The blocks that are inside the circle. `photograph` is linear; `excluded` (one channel, of its
// size; empty: nothing) is above 0.5 where pixels do not count. Throws InputError, begun by `name`,
// if the circle is not inside the photograph, or fewer than a hundred blocks are left.
BallSamples sampleBall(const DiffuseBall& ball, const Image& photograph, const Image& excluded,
                       const std::string& name);

struct SunFromBall {
  Sun sun;
  dvec3 alpha;  // of each channel: the sun's irradiance / pi

  // Root mean square over pixels and channels, relative to the mean, of what the ball shows without
  // the light of the probe; and of the residual, without the light of the sun either.
  double rmsOfProbe, rms;
  double explained;  // the fraction of the pixels whose residual is within 2% of the mean
  Image residual;    // signed, of a white ball; black outside; a pixel for each block

  dvec3 radiance() const { return sun.radiance(); }
};

// The fraction of the mean within which a residual counts as explained (HDRI book, section 9.3.5).
inline constexpr double kExplained = 0.02;

// HDRI book, section 9.3.5: the ball's white radiance minus irradiance / pi of the clipped probe,
// exact at each normal, is due to the sun alone: on average over the samples, alpha times the
// radiance due to a sun of irradiance pi. For a whole orthographic ball whose camera is at the
// angle g from the sun, the mean of the latter is 2/(3 pi) (sin g + (pi - g) cos g).
//
// `clipped` is lat-long, finite and not negative; `direction` is unit; `angle` is the diameter of
// the sun in degrees. Throws InputError if the sun lights hardly any of the samples, and if the
// ball is darker than it would be under the probe alone.
SunFromBall solveSun(const Image& clipped, const BallSamples& ball, const dvec3& direction,
                     double angle);

// The position of the sun in a probe whose photographs it saturated.

// A connected region of texels that are as bright as the probe can show.
struct ClippedSun {
  dvec3 direction;    // unit, towards the centroid of its solid angle
  double width;       // degrees, twice from the centroid to the furthest texel
  size_t rivals = 0;  // other regions with at least half of its solid angle
};

// The layer `clipped` of an .exr, which `probe merge` writes, as the map that the probe was loaded
// as; one channel. nullopt if the file has none. Throws InputError.
std::optional<Image> loadClippedLayer(const std::filesystem::path& path, const LoadedProbe& probe);

// The largest region of the texels that `clipped` (one channel; null: none) marks with more than
// 0.5, else of the texels with at least 0.98 of the largest luminance. `latLong` is finite and not
// negative. Throws InputError, begun by `name`, if there is none.
ClippedSun findClippedSun(const Image& latLong, const Image* clipped, const std::string& name);

}  // namespace chromeball
