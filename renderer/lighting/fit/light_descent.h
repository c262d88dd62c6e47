// SPDX-License-Identifier: Apache-2.0
// Optimises directional lights: the colours for given directions, and the directions by descent.
#pragma once

#include <span>
#include <vector>

#include "image/image.h"
#include "lighting/constellation/directional_light.h"
#include "probe/mapping.h"

namespace chromeball {

// A probe as a small number of directional lights, for repeated sums over all of them.

// The integral over all normals of the probe's irradiance x the pattern max(0, n . d) of a light
// from d (CosinePair), and its derivative: along a unit tangent t of d, channel c of the
// product changes by dot(t, slope[c]).
struct PatternProduct {
  dvec3 product;   // RGB
  dvec3 slope[3];  // of R, G, B
};

// Four points in one register (vector extension of GCC and Clang).
inline constexpr int kRadianceLanes = 4;
typedef double RadianceLanes __attribute__((vector_size(kRadianceLanes * sizeof(double))));

class RadiancePoints {
 public:
  // Merges blocks of texels so that at most `maxRows` rows and twice as many columns remain. The
  // direction of a block is the mean, weighted by the sum of the channels. A smaller map keeps its
  // texels, which are divided if it has fewer than 16 rows or 32 columns. `scale` multiplies all
  // radiance.
  RadiancePoints(const Image& latLong, int maxRows, double scale);

  PatternProduct productWith(const dvec3& direction) const;
  const dvec3& flux() const { return flux_; }  // the sum of all irradiances

 private:
  // A structure of arrays; the last group is padded with black points.
  struct Group {
    RadianceLanes x{}, y{}, z{};  // unit direction
    RadianceLanes rgb[3]{};       // irradiance on a surface that faces it
  };
  void add(size_t index, const dvec3& direction, const dvec3& irradiance);

  std::vector<Group> groups_;
  dvec3 flux_{0};
};

// The fit.

// Lights fitted to a probe's irradiance over all surface orientations.
struct FittedLights {
  std::vector<dvec3> directions;   // unit
  std::vector<dvec3> irradiances;  // RGB, not negative; one for each direction
  dvec3 ambient{0};                // radiance from all directions
  // The integral over all normals, summed over RGB, of (E_lights - E_probe)^2 / 2, without the term
  // that depends on the probe alone.
  double misfit = 0;
};

// Sets the optimal colours for the directions (and the optimal ambient radiance, if `ambient`). The
// current ones are the starting point.
void solveColors(FittedLights& lights, const RadiancePoints& probe, bool ambient);

// The derivatives of the misfit along the tangents of tangentsOf(), two per light, with constant
// colours.
std::vector<double> misfitGradient(const FittedLights& lights, const RadiancePoints& probe);

struct Tangents {
  dvec3 s, u;  // unit, perpendicular to each other and to the direction
};
Tangents tangentsOf(const dvec3& direction);

// Moves the directions by the Levenberg-Marquardt method with the colours always optimal (variable
// projection: Golub and Pereyra 1973; Kaufman's approximation 1975). Never increases the misfit.
// Stops after `maxSteps`, or when a step gains almost nothing.
void descend(FittedLights& lights, const RadiancePoints& probe, bool ambient, int maxSteps);

// The error of irradiance of lights that replace a probe (Madsen and Laursen 2007, section 5).

// Irradiance, W/m^2, on surfaces with these unit normals, from the lights (as if their angles were
// 0) and the radiance `ambient` from all directions.
std::vector<dvec3> irradianceOf(const Constellation& lights, const Rgb& ambient,
                                std::span<const vec3> normals);

// Percent of the probe's mean irradiance (over normals and RGB).
struct LightError {
  double mean, max;
};

// Mean and maximum over the normals of |E_lights - E_probe| per channel, averaged over RGB. Both
// lists have one irradiance per normal. For a black probe the percentage is 0 if the lights are
// black too, else infinite.
LightError lightError(std::span<const dvec3> lights, std::span<const dvec3> probe);

// The irradiance of a directional light as a function of the normal, and inner products of two such
// functions.

// A light of unit irradiance from direction d gives a surface with normal n the irradiance
// max(0, n . d): its pattern. The integral of the product of two patterns over all normals has a
// closed form (the arc-cosine kernel of degree one, Cho and Saul 2009), so no set of normals is
// needed. With t the angle between a and b, and tangents s and u (s . a = 0, u . b = 0):
//   integral of max(0, n.a) max(0, n.b) dn                   = 2/3 (sin t + (pi - t) cos t)
//   its derivative along u, of b                             = 2/3 (pi - t) a.u
//   its derivative along s, of a, and u, of b (the integral of n.s n.u over both hemispheres)
//                                        = 2/3 ((pi - t) s.u + (s.b)(u.a) / sin t)
struct CosinePair {
  double cosine, sine, supplement;  // of t; pi - t

  CosinePair(const dvec3& a, const dvec3& b)
      : cosine(dot(a, b)), sine(length(cross(a, b))), supplement(std::atan2(sine, -cosine)) {}

  double product() const { return 2.0 / 3 * (sine + supplement * cosine); }
  double slope(double au) const { return 2.0 / 3 * supplement * au; }
  double slopeProduct(double su, double sb, double ua) const {
    const double bend = sine > 1e-12 ? sb * ua / sine : 0;
    return 2.0 / 3 * (supplement * su + bend);
  }
};

// Unit radiance from all directions gives every surface the irradiance pi. The products of this
// pattern with a light's pattern, and with itself.
inline constexpr double kAmbientTimesLight = kPiD * kPiD;
inline constexpr double kAmbientTimesAmbient = 4 * kPiD * kPiD * kPiD;

}  // namespace chromeball
