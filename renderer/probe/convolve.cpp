// SPDX-License-Identifier: Apache-2.0
#include "probe/convolve.h"

#include <limits>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "math/vec.h"
#include "probe/irradiance.h"
#include "probe/map_moments.h"

namespace chromeball {

ZonalKernel ZonalKernel::phong(double exponent) {
  if (!(exponent >= 1 && exponent <= 1e8))
    throwInput("phong: the exponent {} should be from 1 to 1e8", exponent);
  return {Kind::Phong, exponent};
}

ZonalKernel ZonalKernel::ggx(double roughness) {
  if (!(roughness >= 0.01 && roughness <= 1))
    throwInput("ggx: the roughness {} should be from 0.01 to 1; a mirror shows the map as it is",
               roughness);
  const double alpha = roughness * roughness;
  return {Kind::Ggx, alpha * alpha};
}

double ZonalKernel::width() const {
  return kind_ == Kind::Phong ? 1 / std::sqrt(parameter_) : std::sqrt(parameter_);
}

// With the half vector at half the angle, D is proportional to 1 / q^2, q = 1 - (1 - alpha^2)
// cos^2(angle / 2) = alpha^2 + (1 - alpha^2)(1 - cos) / 2.
ZonalKernel::Value ZonalKernel::at(double cosine) const {
  if (cosine <= 0) return {0, 0, 0};
  if (kind_ == Kind::Phong) {
    const double n = parameter_, power = std::pow(cosine, n - 1);
    return {power * cosine, n * power, n * (n - 1) * power / cosine};
  }
  // alpha^4 / q^2, which is 1 on the axis.
  const double b = (1 - parameter_) / parameter_, q = 1 + b * (1 - cosine) / 2, bq = b / q;
  return {cosine / (q * q), (1 + cosine * bq) / (q * q), bq * (2 + 1.5 * cosine * bq) / (q * q)};
}

std::array<double, 3> ZonalKernel::legendreMoments() const {
  if (kind_ == Kind::Phong || isCosine()) {  // a cosine is the lobe of exponent 1
    const double n = parameter_, zero = 2 * kPiD / (n + 1);
    return {zero, 2 * kPiD / (n + 2), (3 * 2 * kPiD / (n + 3) - zero) / 2};
  }
  // Integrates over t = (1 - cos) / 2 = (exp(s) - 1) / b, where 1 / q^2 = exp(-2 s), by Simpson's
  // rule in s, to 1e-9.
  constexpr int kSteps = 2048;
  const double b = 1 / parameter_ - 1, step = std::log1p(b / 2) / kSteps;
  std::array<double, 3> moments{};
  for (int i = 0; i <= kSteps; ++i) {
    const double s = step * i, cosine = 1 - 2 * std::expm1(s) / b;
    const double weight = (i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2) * step / 3;
    const double value = 4 * kPiD * weight * cosine * std::exp(-s) / b;
    moments[0] += value;
    moments[1] += value * cosine;
    moments[2] += value * (3 * cosine * cosine - 1) / 2;
  }
  return moments;
}

namespace {

// A kernel, with the numbers that the sums of all directions need.
struct Lobe {
  const ZonalKernel& kernel;
  double error;
  double mean;           // over the sphere
  double slope;          // to which it jumps from 0 at the horizon
  double horizonRadius;  // of rectangles there, if the light is everywhere

  // Over a strip 2 r wide the error is up to pi / 2 slope r^2, of an integral of 4 pi mean; it is
  // slope r for the light of a point.
  Lobe(const ZonalKernel& k, double allowed)
      : kernel(k),
        error(allowed),
        mean(k.integral() / (4 * kPiD)),
        slope(k.at(std::numeric_limits<double>::min()).slope) {
    horizonRadius = std::sqrt(8 * error * mean / slope);  // infinite without a jump
  }
};

// The integrals under the kernel around one direction, by a walk through the map's quadtree.
class KernelSum {
 public:
  KernelSum(const MapMoments& map, const Lobe& lobe, const vec3& axis)
      : map_(map), lobe_(lobe), axis_(glm::normalize(dvec3(axis))) {
    visit(map.root());
  }

  // Where the kernel ends, its tangents may give a little less than nothing.
  dvec3 mean() const { return glm::max(radiance_ / weight_, dvec3(0)); }

 private:
  // Whether no part of the rectangle is above the horizon, where the kernel is 0.
  bool isBelow(const RectangleGeometry& g) const {
    return glm::dot(axis_, g.centre) + g.radius <= 0;
  }

  // Whether a kernel that is smooth at the horizon rises there by more than the error: x^n at a
  // height x, over the strip of rectangles at the horizon, 4 pi r, has a mean of r^n / (2 (n + 1)),
  // and its tangent at the centre may be 0.
  bool risesFast(double cosine, double r, double concentration) const {
    const double highest = lobe_.kernel.at(std::min(cosine + r, 1.0)).value;
    return highest * r * concentration > 4 * lobe_.error * lobe_.mean;
  }

  // The kernel at the centre, where it is linear in the cosine over the rectangle, for its light
  // and for constant light: to the error times the sum of the kernel's value and its mean over the
  // sphere; or, where the light is not brighter than the map's mean, times the geometric mean of
  // its value and its peak, which is 1. (The errors of a sky all around are those of the weight,
  // too.)
  std::optional<ZonalKernel::Value> linearOver(const RectangleGeometry& g,
                                               const LightSpread& light) const {
    const double cosine = glm::dot(axis_, g.centre), r = g.radius;
    if (cosine - r < 0 && (r * std::sqrt(light.concentration) > lobe_.horizonRadius ||
                           r * light.share * lobe_.slope > lobe_.error * lobe_.mean ||
                           risesFast(cosine, r, light.concentration)))
      return {};
    const double distance = std::max(glm::distance(axis_, g.centre) - r, 0.0);
    if (r > (lobe_.kernel.width() + distance) / 4) return {};
    const ZonalKernel::Value k = lobe_.kernel.at(cosine);
    // The second-order term, by the mean square along the kernel's slope: of all light at worst,
    // and of constant light, a disc's.
    const double sine2 = std::max(1 - cosine * cosine, 0.0), even = r * r / 4;
    const double squared = std::max(std::min(light.squared, light.concentration * even), even);
    const double brightness = std::max(light.share * 4 * kPiD / g.solidAngle, 1.0);
    const double allowed = std::max(k.value + lobe_.mean, std::sqrt(k.value) / brightness);
    if (k.curvature * sine2 * squared / 2 > lobe_.error * allowed) return {};
    return k;
  }

  void visit(const MapMoments::Node& node) {
    const RectangleGeometry g = map_.geometry(node);
    if (isBelow(g)) return;
    if (const auto k = linearOver(g, map_.spread(node, g)))
      add(*k, g, map_.moments(node, g));
    else if (node.level > 0)
      map_.forChildren(node, [this](const MapMoments::Node& child) { visit(child); });
    else
      divide(map_.rectangle(node), map_.radiance(node));
  }

  void divide(const MapRectangle& r, const dvec3& radiance) {
    for (int i = 0; i < 4; ++i) {
      const RectangleGeometry g(r.quarter(i));
      if (isBelow(g)) continue;
      if (const auto k = linearOver(g, map_.spread(radiance, g)))
        add(*k, g, {radiance, g});
      else
        divide(r.quarter(i), radiance);
    }
  }

  // The weight has the same error, so that the mean of a constant map has none.
  void add(const ZonalKernel::Value& k, const RectangleGeometry& g, const RadianceMoments& m) {
    radiance_ += k.value * m.flux;
    for (int i = 0; i < 3; ++i) radiance_ += k.slope * axis_[i] * m.offset[i];
    weight_ += k.value * g.solidAngle +
               k.slope * glm::dot(axis_, g.centre) * (g.directionLength - g.solidAngle);
  }

  const MapMoments& map_;
  const Lobe& lobe_;
  const dvec3 axis_;
  dvec3 radiance_{0};
  double weight_ = 0;
};

}  // namespace

std::vector<dvec3> convolve(const Image& latLong, const ZonalKernel& kernel,
                            std::span<const vec3> directions, double error) {
  if (kernel.isCosine()) {
    std::vector<dvec3> means = exactIrradiance(latLong, directions);
    for (dvec3& mean : means) mean /= kPiD;
    return means;
  }
  const MapMoments map(latLong);
  const Lobe lobe(kernel, error);
  std::vector<dvec3> means(directions.size());
  parallelFor(size_t(0), directions.size(),
              [&](size_t i) { means[i] = KernelSum(map, lobe, directions[i]).mean(); });
  return means;
}

std::vector<dvec3> shConvolve(const Image& latLong, const ZonalKernel& kernel,
                              std::span<const vec3> directions) {
  const ShCoefficients radiance = projectSh(latLong);
  std::array<double, 3> moments = kernel.legendreMoments();
  for (double& moment : moments) moment /= kernel.integral();
  std::vector<dvec3> means;
  means.reserve(directions.size());
  for (const vec3& direction : directions)
    means.push_back(shConvolution(radiance, moments, dvec3(direction)));
  return means;
}

}  // namespace chromeball
