// SPDX-License-Identifier: Apache-2.0
#include "probe/convolve.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "base/error.h"
#include "probe/irradiance.h"
#include "probe/map_moments.h"
#include "probe/solid_angle.h"
#include "probe/spherical_harmonics.h"

namespace chromeball {
namespace {

// The integrals under the kernel around one direction, by a walk through the map's quadtree.
class KernelSum {
 public:
  // `meanKernel`: of the kernel over the sphere.
  KernelSum(const MapMoments& map, const ZonalKernel& kernel, double meanKernel, const vec3& axis)
      : map_(map), kernel_(kernel), meanKernel_(meanKernel), axis_(glm::normalize(dvec3(axis))) {
    visit(map.root());
  }

  dvec3 mean() const { return radiance_ / weight_; }

 private:
  enum class Step { Skip, Add, Divide };
  // Add where the kernel is linear in the cosine over the rectangle: to 1e-3 of the geometric mean
  // of its value and its peak, which is 1, or to 1e-3 of its mean over the sphere.
  Step stepAt(const RectangleGeometry& g) const {
    constexpr double kError = 1e-3, kNextToHorizon = 0.02;
    const double cosine = glm::dot(axis_, g.centre), r = g.radius;
    if (cosine + r <= 0) return Step::Skip;
    if (cosine - r < 0 && r > kNextToHorizon) return Step::Divide;
    const double distance = std::max(glm::distance(axis_, g.centre) - r, 0.0);
    if (r > (kernel_.width() + distance) / 4) return Step::Divide;
    const ZonalKernel::Value k = kernel_.at(cosine);
    // The change over the rectangle; the mean of its square's share in the error is 1/8.
    const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0)), change = k.slope * sine * r;
    return change * change <= 8 * kError * k.value * std::max(std::sqrt(k.value), meanKernel_)
               ? Step::Add
               : Step::Divide;
  }

  void visit(const MapMoments::Node& node) {
    const RectangleGeometry g = map_.geometry(node);
    const Step step = stepAt(g);
    if (step == Step::Add)
      add(g, map_.moments(node, g));
    else if (step == Step::Divide && node.level > 0)
      map_.forChildren(node, [this](const MapMoments::Node& child) { visit(child); });
    else if (step == Step::Divide)
      divide(map_.rectangle(node), map_.radiance(node));
  }

  void divide(const MapRectangle& r, const dvec3& radiance) {
    for (int i = 0; i < 4; ++i) {
      const RectangleGeometry g(r.quarter(i));
      const Step step = stepAt(g);
      if (step == Step::Add)
        add(g, {radiance, g});
      else if (step == Step::Divide)
        divide(r.quarter(i), radiance);
    }
  }

  // The kernel to first order around the centre. The weight has the same error, so that the mean of
  // a constant map has none.
  void add(const RectangleGeometry& g, const RadianceMoments& m) {
    const double cosine = glm::dot(axis_, g.centre);
    const ZonalKernel::Value k = kernel_.at(cosine);
    radiance_ += k.value * m.flux;
    for (int i = 0; i < 3; ++i) radiance_ += k.slope * axis_[i] * m.offset[i];
    weight_ += k.value * g.solidAngle + k.slope * cosine * (g.directionLength - g.solidAngle);
  }

  const MapMoments& map_;
  const ZonalKernel& kernel_;
  const double meanKernel_;
  const dvec3 axis_;
  dvec3 radiance_{0};
  double weight_ = 0;
};

}  // namespace

std::vector<dvec3> convolve(const Image& latLong, const ZonalKernel& kernel,
                            std::span<const vec3> directions) {
  if (kernel.isCosine()) {
    std::vector<dvec3> means = exactIrradiance(latLong, directions);
    for (dvec3& mean : means) mean /= kPiD;
    return means;
  }
  const MapMoments map(latLong);
  const double meanKernel = kernel.integral() / (4 * kPiD);
  std::vector<dvec3> means(directions.size());
  tbb::parallel_for(tbb::blocked_range<size_t>(0, directions.size(), 16),
                    [&](const tbb::blocked_range<size_t>& range) {
                      for (size_t i = range.begin(); i < range.end(); ++i)
                        means[i] = KernelSum(map, kernel, meanKernel, directions[i]).mean();
                    });
  return means;
}

std::vector<dvec3> shConvolve(const Image& latLong, const ZonalKernel& kernel,
                              std::span<const vec3> directions) {
  const ShCoefficients radiance = projectSh(latLong);
  const auto [zero, one, two] = kernel.legendreMoments();
  const std::array<double, kShCount> factors{zero, one, one, one, two, two, two, two, two};
  std::vector<dvec3> means;
  means.reserve(directions.size());
  for (const vec3& direction : directions) {
    const std::array<double, kShCount> basis = shBasis(dvec3(direction));
    dvec3 sum(0);
    for (int i = 0; i < kShCount; ++i) sum += factors[i] / zero * basis[i] * radiance[i];
    means.push_back(sum);
  }
  return means;
}

Image reduced(const Image& latLong, const ImageSize& size) {
  if (size.width > latLong.width || size.height > latLong.height)
    throwInput("{}x{} is larger than the map, {}x{}", size.width, size.height, latLong.width,
               latLong.height);
  Image out(size.width, size.height, 3);
  // Overlaps in units of the source's texels: columns are of equal width, rows of solid angle.
  const double columns = double(latLong.width) / size.width,
               rows = double(latLong.height) / size.height;
  tbb::parallel_for(0, size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) {
      dvec3 sum(0);
      double total = 0;
      for (int j = int(y * rows); j < std::min(int(std::ceil((y + 1) * rows)), latLong.height);
           ++j) {
        const double top = std::max(double(j), y * rows),
                     bottom = std::min(j + 1.0, (y + 1) * rows);
        const double band =
            std::cos(kPiD * top / latLong.height) - std::cos(kPiD * bottom / latLong.height);
        for (int i = int(x * columns);
             i < std::min(int(std::ceil((x + 1) * columns)), latLong.width); ++i) {
          const double w =
              band * (std::min(i + 1.0, (x + 1) * columns) - std::max(double(i), x * columns));
          sum += w * dvec3(latLong.rgb(i, j));
          total += w;
        }
      }
      out.setRgb(x, y, Rgb(sum / total));
    }
  });
  return out;
}

}  // namespace chromeball
