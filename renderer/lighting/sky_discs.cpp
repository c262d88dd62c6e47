// SPDX-License-Identifier: Apache-2.0
#include "lighting/sky_discs.h"

namespace chromeball {
namespace {

constexpr size_t kMaxSampledEach = 2;  // of more discs, one is chosen by power

}  // namespace

SkyDiscs::SkyDiscs(const std::vector<Sun>& suns, const Rotation& rotation) {
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
    discs_.push_back({{Frame(vec3(rotation(sun.direction))), float(chord * chord)},
                      Rgb(sun.radiance()),
                      float(probability / (kPiD * chord * chord))});
  }
}

}  // namespace chromeball
