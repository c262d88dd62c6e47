// SPDX-License-Identifier: Apache-2.0
#include "lighting/sky_discs.h"

namespace chromeball {
namespace {

constexpr size_t kMaxSampledEach = 2;  // of more discs, one is chosen by power

// Rotation about +Y, the same as Probe's.
vec3 rotated(const dvec3& d, double degrees) {
  const double angle = degrees * kPiD / 180, sine = std::sin(angle), cosine = std::cos(angle);
  return vec3(dvec3(d.x * cosine + d.z * sine, d.y, d.z * cosine - d.x * sine));
}

}  // namespace

SkyDiscs::SkyDiscs(const std::vector<Sun>& suns, double rotationDegrees) {
  std::vector<double> powers;
  double power = 0;
  for (const Sun& sun : suns) {
    powers.push_back(luminance(Rgb(sun.irradiance)));
    power += powers.back();
  }
  const bool chooses = power > 0 && powers.size() > kMaxSampledEach;
  if (chooses) choice_.emplace(1, int(powers.size())).setRow(0, powers);
  for (size_t i = 0; i < powers.size(); ++i) {
    const Sun& sun = suns[i];
    const double chord = 2 * std::sin(sun.angle * kPiD / 720);
    const double probability = chooses ? powers[i] / power : 1;
    discs_.push_back({{Frame(rotated(sun.direction, rotationDegrees)), float(chord * chord)},
                      Rgb(sun.radiance()),
                      float(probability / (kPiD * chord * chord))});
  }
}

SkyDiscs::Light SkyDiscs::at(const vec3& wi) const {
  Light light;
  for (const Disc& disc : discs_)
    if (disc.cap.contains(wi)) {
      light.radiance += disc.radiance;
      light.pdf += disc.pdf;
    }
  return light;
}

}  // namespace chromeball
