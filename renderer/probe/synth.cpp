// SPDX-License-Identifier: Apache-2.0
#include "probe/synth.h"

#include <limits>
#include <vector>

#include "base/error.h"
#include "probe/convert.h"

namespace chromeball {
namespace {

constexpr int kSamplesPerSide = 8;  // anti-aliases edges

// A panel that faces the origin from distance 1.
struct SoftBox {
  dvec3 centre, right, up;
  double halfWidth, halfHeight;
  dvec3 radiance;

  // Azimuth in degrees, counter-clockwise from -Z seen from above; elevation in degrees.
  SoftBox(double azimuth, double elevation, double width, double height, const dvec3& light)
      : centre(directionAt(azimuth, elevation)),
        halfWidth(0.5 * width),
        halfHeight(0.5 * height),
        radiance(light) {
    const double a = azimuth * kPiD / 180;
    right = {std::cos(a), 0, -std::sin(a)};
    up = glm::cross(right, centre);
  }

  bool isSeenAlong(const dvec3& d) const {
    const double depth = glm::dot(d, centre);
    return depth > 0 && std::fabs(glm::dot(d, right)) < depth * halfWidth &&
           std::fabs(glm::dot(d, up)) < depth * halfHeight;
  }
};

}  // namespace

Image constantProbe(const ImageSize& size, const Rgb& radiance) {
  return colorImage(size.width, size.height, [&](int, int) { return radiance; });
}

Image oneHotProbe(const ImageSize& size, int x, int y, const Rgb& radiance) {
  Image image(size.width, size.height, 3);
  image.setRgb(x, y, radiance);
  return image;
}

Image gradientProbe(const ImageSize& size, const Rgb& radiance, const dvec3& slope) {
  return rasterize(Mapping::LatLong, size, 1,
                   [&](const dvec3& d) { return dvec3(radiance) * (1 + glm::dot(slope, d)); });
}

Image overcastProbe(const ImageSize& size, const Rgb& zenith, double groundAlbedo) {
  const dvec3 ground = dvec3(zenith) * (groundAlbedo * 7 / 9);  // albedo E / pi
  return rasterize(Mapping::LatLong, size, kSamplesPerSide, [&](const dvec3& d) {
    return d.y < 0 ? ground : dvec3(zenith) * ((1 + 2 * d.y) / 3);
  });
}

Image studioProbe(const ImageSize& size) {
  const std::array boxes = {
      SoftBox(-50, 35, 0.7, 0.7, dvec3(30, 29, 27)), SoftBox(60, 20, 0.8, 1.0, dvec3(7.2, 7.6, 8)),
      SoftBox(165, 30, 0.25, 1.1, dvec3(15)), SoftBox(0, 85, 1.2, 0.8, dvec3(10))};
  return rasterize(Mapping::LatLong, size, kSamplesPerSide, [&](const dvec3& d) {
    for (const SoftBox& box : boxes)
      if (box.isSeenAlong(d)) return box.radiance;
    return dvec3(0.02);
  });
}

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

// How much of the texels of a lat-long map a disc covers: a grid of samples in each texel, about 16
// across the disc and no more than 1024 across a texel. The disc covers one interval of each line
// of samples, whose ends are computed, so that the time is proportional to the number of texels
// that it covers.
class DiscSamples {
 public:
  DiscSamples(const dvec3& direction, double radius, const ImageSize& size)
      : size_(size),
        radius_(radius),
        theta_(std::atan2(std::hypot(direction.x, direction.z), direction.y)),
        centreU_(directionToUv(Mapping::LatLong, direction).x),
        samplesX_(samplesAlong(2 * kPiD / size.width)),
        samplesY_(samplesAlong(kPiD / size.height)) {}

  int top() const { return rowAt(theta_ - radius_); }
  int bottom() const { return rowAt(theta_ + radius_); }

  // Calls found(x, fraction) for each texel of the row that has samples inside the disc.
  template <class Found>
  void forEachCovered(int y, const Found& found) const {
    std::vector<Interval> lines;
    Interval whole{std::numeric_limits<int64_t>::max(), std::numeric_limits<int64_t>::min()};
    for (int j = 0; j < samplesY_; ++j) {
      const Interval line = samplesOfLine(kPiD * (y + (j + 0.5) / samplesY_) / size_.height);
      if (line.last < line.first) continue;
      lines.push_back(line);
      whole = {std::min(whole.first, line.first), std::max(whole.last, line.last)};
    }
    if (lines.empty()) return;
    // Columns continue beyond the seam; one that is reached from both sides is counted once.
    const int64_t w = size_.width, first = columnOf(whole.first), last = columnOf(whole.last);
    std::vector<int64_t> inside(size_t(std::min(last - first + 1, w)));
    for (const Interval& line : lines)
      for (int64_t column = columnOf(line.first); column <= columnOf(line.last); ++column)
        inside[size_t((column - first) % w)] += std::min(line.last, (column + 1) * samplesX_ - 1) -
                                                std::max(line.first, column * samplesX_) + 1;
    for (size_t i = 0; i < inside.size(); ++i)
      if (inside[i] > 0)
        found(int(((first + int64_t(i)) % w + w) % w),
              double(inside[i]) / (double(samplesX_) * samplesY_));
  }

 private:
  // An interval of samples along a line, numbered from u = 0 on; empty if last < first.
  struct Interval {
    int64_t first, last;
  };

  int samplesAlong(double texelAngle) const {
    return int(std::clamp(std::ceil(8 * texelAngle / radius_), 4.0, 1024.0));
  }
  int rowAt(double theta) const {
    return std::clamp(int(theta / kPiD * size_.height), 0, size_.height - 1);
  }
  int64_t columnOf(int64_t sample) const { return int64_t(std::floor(double(sample) / samplesX_)); }

  // The samples at most the radius R from the centre C, by the haversine formula: sin^2(R / 2) =
  // sin^2((theta - thetaC) / 2) + sin(theta) sin(thetaC) sin^2((phi - phiC) / 2).
  Interval samplesOfLine(double theta) const {
    const auto haversine = [](double angle) { return std::pow(std::sin(0.5 * angle), 2); };
    const double left = haversine(radius_) - haversine(theta - theta_);
    if (left < 0) return {0, -1};
    const double most = std::sin(theta) * std::sin(theta_);
    const double along = double(size_.width) * samplesX_;
    if (left >= most) {
      const auto first = int64_t(std::ceil((centreU_ - 0.5) * along - 0.5));
      return {first, first + int64_t(along) - 1};
    }
    const double reach = std::asin(std::sqrt(left / most)) / kPiD;  // in u
    return {int64_t(std::ceil((centreU_ - reach) * along - 0.5)),
            int64_t(std::floor((centreU_ + reach) * along - 0.5))};
  }

  ImageSize size_;
  double radius_, theta_, centreU_;
  int samplesX_, samplesY_;
};

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
  const DiscSamples disc(direction, 0.5 * radians(diameterDegrees), {w, h});

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
  for (int y = disc.top(); y <= disc.bottom(); ++y)
    disc.forEachCovered(y, [&](int x, double fraction) { add(x, y, fraction); });
  if (covered.empty()) {
    const dvec2 uv = directionToUv(Mapping::LatLong, direction);
    add(std::clamp(int(uv.x * w), 0, w - 1), std::clamp(int(uv.y * h), 0, h - 1), 1);
  }

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
