// SPDX-License-Identifier: Apache-2.0
#include "probe/sky.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "probe/rasterize.h"
#include "probe/solid_angle.h"

namespace chromeball {
namespace {

constexpr double kUnit = 100 / kPiD;  // kcd/m^2

double radians(double degrees) { return degrees * kPiD / 180; }

// Perez's distribution (the paper's eq. 3); theta from the zenith, gamma from the sun.
double perez(const std::array<double, 5>& c, double cosTheta, double gamma) {
  const double cosGamma = std::cos(gamma);
  return (1 + c[0] * std::exp(c[1] / std::max(cosTheta, 1e-3))) *
         (1 + c[2] * std::exp(c[3] * gamma) + c[4] * cosGamma * cosGamma);
}

double cubic(double x, double c3, double c2, double c1, double c0) {
  return ((c3 * x + c2) * x + c1) * x + c0;
}

dvec3 xyYToRec709(double x, double y, double luminance) {
  const double X = luminance * x / y, Z = luminance * (1 - x - y) / y;
  const dvec3 rgb(3.2404542 * X - 1.5371385 * luminance - 0.4985314 * Z,
                  -0.9692660 * X + 1.8760108 * luminance + 0.0415560 * Z,
                  0.0556434 * X - 0.2040259 * luminance + 1.0572252 * Z);
  return glm::max(rgb, dvec3(0));
}

// Irradiance of the sky alone on level ground, by the midpoint rule in (sin^2 theta, phi), which
// makes cos(theta) d(omega) uniform.
dvec3 skyIrradiance(const SkyRadiance& radiance) {
  constexpr int kRings = 64, kSectors = 128;
  dvec3 sum(0);
  for (int ring = 0; ring < kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) {
      const double sinSquared = (ring + 0.5) / kRings, phi = 2 * kPiD * (sector + 0.5) / kSectors;
      const double r = std::sqrt(sinSquared);
      sum += radiance({r * std::cos(phi), std::sqrt(1 - sinSquared), r * std::sin(phi)});
    }
  return sum * (kPiD / (kRings * kSectors));
}

}  // namespace

dvec3 sunDirection(const ClearSky& sky) { return directionAt(sky.sunAzimuth, sky.sunElevation); }

SkyRadiance::SkyRadiance(const ClearSky& sky) : sun_(sunDirection(sky)) {
  const double t = sky.turbidity, s = radians(90 - sky.sunElevation);
  const double chi = (4.0 / 9 - t / 120) * (kPiD - 2 * s);
  const double zenithLuminance = (4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192;
  const double zenithX = t * t * cubic(s, 0.00166, -0.00375, 0.00209, 0) +
                         t * cubic(s, -0.02903, 0.06377, -0.03202, 0.00394) +
                         cubic(s, 0.11693, -0.21196, 0.06052, 0.25886);
  const double zenithY = t * t * cubic(s, 0.00275, -0.00610, 0.00317, 0) +
                         t * cubic(s, -0.04214, 0.08970, -0.04153, 0.00516) +
                         cubic(s, 0.15346, -0.26756, 0.06670, 0.26688);
  channels_ = {{{{0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251,
                  0.1206 * t - 2.5771, -0.0670 * t + 0.3703},
                 std::max(zenithLuminance, 0.0) / kUnit},
                {{-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125,
                  -0.0641 * t - 0.8989, -0.0033 * t + 0.0452},
                 zenithX},
                {{-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102,
                  -0.0441 * t - 1.6537, -0.0109 * t + 0.0529},
                 zenithY}}};
  for (Channel& channel : channels_) channel.scale /= perez(channel.perez, 1, s);
}

dvec3 SkyRadiance::operator()(const dvec3& direction) const {
  const double gamma = std::acos(std::clamp(glm::dot(direction, sun_), -1.0, 1.0));
  std::array<double, 3> found;
  for (int i = 0; i < 3; ++i)
    found[i] = channels_[i].scale * perez(channels_[i].perez, direction.y, gamma);
  return xyYToRec709(found[1], found[2], found[0]);
}

dvec3 sunIrradiance(const ClearSky& sky) {
  constexpr double kOutside = 128;  // klx
  const double zenithDegrees = 90 - sky.sunElevation;
  const double airMass =
      1 / (std::cos(radians(zenithDegrees)) + 0.15 * std::pow(93.885 - zenithDegrees, -1.253));
  const double haze = 0.04608 * sky.turbidity - 0.04586;
  dvec3 irradiance;
  for (int c = 0; c < 3; ++c) {
    const double micrometres = std::array{0.610, 0.550, 0.465}[c];
    irradiance[c] = kOutside / kUnit *
                    std::exp(-airMass * (0.008735 * std::pow(micrometres, -4.08) +
                                         haze * std::pow(micrometres, -1.3)));
  }
  return irradiance;
}

void addSunDisc(Image& latLong, const dvec3& direction, double diameterDegrees,
                const dvec3& irradiance) {
  const int w = latLong.width, h = latLong.height;
  const double radius = 0.5 * radians(diameterDegrees), cosRadius = std::cos(radius);
  const double theta = std::acos(std::clamp(direction.y, -1.0, 1.0));
  const int top = std::clamp(int((theta - radius) / kPiD * h), 0, h - 1);
  const int bottom = std::clamp(int((theta + radius) / kPiD * h), 0, h - 1);
  // About 16 samples across the disc, and no more than 1024 across a texel.
  const auto samplesAlong = [&](double texelAngle) {
    return int(std::clamp(std::ceil(8 * texelAngle / radius), 4.0, 1024.0));
  };
  const int samplesX = samplesAlong(2 * kPiD / w), samplesY = samplesAlong(kPiD / h);

  // The fraction of each texel that the disc covers, estimated from the samples.
  struct Covered {
    int x, y;
    double fraction;
  };
  std::vector<Covered> covered;
  double facing = 0;  // sum of fraction x solid angle x cosine
  const auto add = [&](int x, int y, double fraction) {
    const dvec3 centre = texelDirection({w, h}, x, y);
    covered.push_back({x, y, fraction});
    facing += fraction * texelSolidAngle(y, w, h) * std::max(glm::dot(centre, direction), 1e-3);
  };
  const double centreU = directionToUv(Mapping::LatLong, direction).x;
  for (int y = top; y <= bottom; ++y) {
    // Half the range of u that the disc may reach in this row: the whole row if it contains a pole.
    const double sinTheta = std::sin(std::clamp(theta, radius, kPiD - radius));
    const bool containsPole = theta < 2 * radius || theta > kPiD - 2 * radius;
    const double reach = containsPole ? 0.5 : std::asin(std::sin(radius) / sinTheta) / (2 * kPiD);
    const int first = int(std::floor((centreU - reach) * w)), last = int((centreU + reach) * w);
    for (int column = first; column <= std::min(last, first + w - 1); ++column) {
      const int x = (column % w + w) % w;
      int64_t inside = 0;
      for (int j = 0; j < samplesY; ++j)
        for (int i = 0; i < samplesX; ++i) {
          const dvec2 uv((x + (i + 0.5) / samplesX) / w, (y + (j + 0.5) / samplesY) / h);
          inside += glm::dot(*uvToDirection(Mapping::LatLong, uv), direction) >= cosRadius;
        }
      if (inside > 0) add(x, y, double(inside) / (samplesX * samplesY));
    }
  }
  if (covered.empty())
    add(std::clamp(int(centreU * w), 0, w - 1), std::clamp(int(theta / kPiD * h), 0, h - 1), 1);

  for (const Covered& texel : covered)
    latLong.setRgb(
        texel.x, texel.y,
        Rgb(dvec3(latLong.rgb(texel.x, texel.y)) + irradiance * (texel.fraction / facing)));
}

Image clearSkyProbe(const ImageSize& size, const ClearSky& sky, bool withSun) {
  if (!(sky.sunElevation >= 0 && sky.sunElevation <= 90))
    throwInput("sun elevation: {} should be 0 to 90 degrees", sky.sunElevation);
  if (!(sky.turbidity >= 2 && sky.turbidity <= 10))
    throwInput("turbidity: {} should be 2 to 10", sky.turbidity);

  const SkyRadiance radiance(sky);
  const dvec3 sun = withSun ? sunIrradiance(sky) : dvec3(0), direction = sunDirection(sky);
  const dvec3 ground = sky.groundAlbedo / kPiD * (skyIrradiance(radiance) + sun * direction.y);
  // An even number of samples per side, so that the horizon halves the texels that it crosses.
  Image image = rasterize(Mapping::LatLong, size, 2,
                          [&](const dvec3& d) { return d.y < 0 ? ground : radiance(d); });
  if (withSun) addSunDisc(image, direction, kSunDiameter, sun);
  return image;
}

}  // namespace chromeball
