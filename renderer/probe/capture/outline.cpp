// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/outline.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "math/least_squares.h"

namespace chromeball {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr int kUnknowns = 7;                 // of the luminance around an arc
constexpr int kSubsamples = 5;               // along the side of a pixel
constexpr double kInside = 3, kOutside = 3;  // pixels from the outline that an arc's fit reads

// A pixel near an arc: its value, and its subsamples as (distance from the circle, along the arc).
struct ArcPixel {
  Rgb value;
  std::array<dvec2, kSubsamples * kSubsamples> points;
};

struct ArcPoint {
  dvec2 normal;
  double offset;  // of the outline from the circle, outwards, in pixels
  double standardError;
};

using Coefficients = std::array<LeastSquares::Term, kUnknowns>;

// The mean over the pixel of each unknown's coefficient, with the outline at `offset`.
Coefficients coefficientsOf(const ArcPixel& pixel, double offset) {
  std::array<double, kUnknowns> sums{};
  for (const dvec2& p : pixel.points) {
    const double d = p.x - offset;
    if (d >= 0) {
      sums[0] += 1, sums[1] += d, sums[2] += p.y;
    } else {
      sums[3] += 1, sums[4] += std::sqrt(-d), sums[5] -= d, sums[6] += p.y;
    }
  }
  Coefficients row;
  for (int i = 0; i < kUnknowns; ++i)
    row[size_t(i)] = {i, sums[size_t(i)] / double(pixel.points.size())};
  return row;
}

// The sum over pixels and channels of the squared errors of the best model with the outline at
// `offset`.
double errorAt(const std::vector<ArcPixel>& pixels, double offset) {
  std::vector<Coefficients> rows;
  rows.reserve(pixels.size());
  for (const ArcPixel& pixel : pixels) rows.push_back(coefficientsOf(pixel, offset));
  double sum = 0;
  for (int channel = 0; channel < 3; ++channel) {
    LeastSquares equations(kUnknowns);
    for (size_t i = 0; i < rows.size(); ++i)
      equations.add(rows[i], double(pixels[i].value[channel]));
    const std::optional<std::vector<double>> model = equations.solve();
    if (!model) return std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < rows.size(); ++i) {
      double error = -double(pixels[i].value[channel]);
      for (const LeastSquares::Term& term : rows[i])
        error += term.coefficient * (*model)[size_t(term.unknown)];
      sum += error * error;
    }
  }
  return sum;
}

std::vector<ArcPixel> pixelsOfArc(const Image& image, const Circle& circle, double angle,
                                  double halfAngle, double reach) {
  const dvec2 normal(std::cos(angle), std::sin(angle));
  const dvec2 middle = circle.centre + circle.radius * normal;
  const double side = std::hypot(halfAngle * circle.radius, kInside + kOutside + reach) + 1;
  std::vector<ArcPixel> pixels;
  for (int y = int(middle.y - side); y <= int(middle.y + side); ++y)
    for (int x = int(middle.x - side); x <= int(middle.x + side); ++x) {
      if (x < 0 || y < 0 || x >= image.width || y >= image.height) continue;
      const auto polar = [&](const dvec2& p) {
        const dvec2 v = p - circle.centre;
        const double along = std::atan2(normal.x * v.y - normal.y * v.x, glm::dot(normal, v));
        return dvec2(glm::length(v) - circle.radius, along * circle.radius);
      };
      const dvec2 centre = polar({x + 0.5, y + 0.5});
      if (std::fabs(centre.y) > halfAngle * circle.radius || centre.x < -kInside - reach ||
          centre.x > kOutside + reach)
        continue;
      ArcPixel pixel{image.rgb(x, y), {}};
      for (int j = 0; j < kSubsamples; ++j)
        for (int i = 0; i < kSubsamples; ++i)
          pixel.points[size_t(j * kSubsamples + i)] =
              polar({x + (i + 0.5) / kSubsamples, y + (j + 0.5) / kSubsamples});
      pixels.push_back(pixel);
    }
  return pixels;
}

constexpr double kOffsetStep = 0.2;  // between the offsets of an arc

// The errors of an arc at the offsets kOffsetStep (i - half).
struct Arc {
  dvec2 normal;
  size_t pixels;
  int half;
  std::vector<double> errors;

  // Minus the logarithm of the likelihood, with normal errors of unknown variance.
  double doubt(double offset) const {
    const double at = std::clamp(offset / kOffsetStep + half, 0.0, double(2 * half) - 1e-9);
    const size_t i = size_t(at);
    const double part = at - double(i);
    return 0.5 * double(pixels) *
           ((1 - part) * std::log(errors[i]) + part * std::log(errors[i + 1]));
  }

  // The offset with the least error.
  std::optional<ArcPoint> point() const {
    const size_t least = size_t(std::ranges::min_element(errors) - errors.begin());
    if (least == 0 || least + 1 == errors.size()) return std::nullopt;
    const double a = errors[least - 1], b = errors[least], c = errors[least + 1];
    const double curvature = a - 2 * b + c;
    if (!(curvature > 0)) return std::nullopt;
    const double offset = (double(least) - half + 0.5 * (a - c) / curvature) * kOffsetStep;
    const double noise = b / double(3 * (pixels - kUnknowns) - 1);
    return ArcPoint{normal, offset, kOffsetStep * std::sqrt(2 * noise / curvature)};
  }
};

// All arcs that the picture shows.
std::vector<Arc> arcsAround(const Image& image, const Circle& circle, double reach) {
  constexpr double kArcLength = 10;  // pixels
  constexpr double kLeastShown = 0.9;
  const int count = std::clamp(int(2 * kPiD * circle.radius / kArcLength), 24, 120);
  const double halfAngle = std::min(kPiD / count, 0.5 * kArcLength / circle.radius);
  const double area = 2 * halfAngle * circle.radius * (kInside + kOutside + 2 * reach);
  std::vector<Arc> arcs;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * kPiD * (i + 0.5) / count;
    const auto pixels = pixelsOfArc(image, circle, angle, halfAngle, reach);
    if (double(pixels.size()) < std::max(kLeastShown * area, 2.0 * kUnknowns)) continue;
    Arc arc{{std::cos(angle), std::sin(angle)},
            pixels.size(),
            int(std::lround(reach / kOffsetStep)),
            {}};
    for (int k = -arc.half; k <= arc.half; ++k)
      arc.errors.push_back(std::max(errorAt(pixels, k * kOffsetStep), 1e-30));
    arcs.push_back(std::move(arc));
  }
  return arcs;
}

// The change of the circle (x, y, radius) that is likeliest by all arcs together, on a grid: one
// arc alone may have a stronger edge beside the outline.
dvec3 likeliestChange(const std::vector<Arc>& arcs, double reach) {
  const int half = int(std::lround(reach / kOffsetStep));
  dvec3 best(0);
  double least = std::numeric_limits<double>::infinity();
  for (int r = -half; r <= half; ++r)
    for (int y = -half; y <= half; ++y)
      for (int x = -half; x <= half; ++x) {
        const dvec3 change = kOffsetStep * dvec3(x, y, r);
        double doubt = 0;
        for (const Arc& arc : arcs)
          doubt += arc.doubt(change.x * arc.normal.x + change.y * arc.normal.y + change.z);
        if (doubt < least) least = doubt, best = change;
      }
  return best;
}

double medianSize(std::vector<double> values) {
  for (double& value : values) value = std::fabs(value);
  const auto middle = values.begin() + ptrdiff_t(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

struct CircleFit {
  dvec3 change;  // of x, y and radius
  double standardError;
};

// The circle with the least weighted sum of squared errors of the arcs' points: Tukey's biweight at
// 4.685 standard deviations, which are 1.4826 medians of the errors' sizes.
std::optional<CircleFit> fitPoints(const std::vector<Arc>& arcs) {
  constexpr size_t kLeastPoints = 8;
  constexpr double kModelError = 0.05;  // pixels
  std::vector<ArcPoint> points;
  for (const Arc& arc : arcs)
    if (const std::optional<ArcPoint> point = arc.point()) points.push_back(*point);
  if (points.size() < kLeastPoints) return std::nullopt;

  CircleFit fit{dvec3(0), 0};
  for (int step = 0; step < 30; ++step) {
    std::vector<double> errors;  // in standard deviations
    for (const ArcPoint& p : points)
      errors.push_back((p.offset - glm::dot(fit.change, dvec3(p.normal, 1))) /
                       std::hypot(p.standardError, kModelError));
    const double width = 4.685 * std::max(1.4826 * medianSize(errors), 1.0);
    LeastSquares equations(3);
    double squares = 0;
    int count = 0;
    for (size_t i = 0; i < points.size(); ++i) {
      const ArcPoint& p = points[i];
      const double t = std::min(std::fabs(errors[i]) / width, 1.0);
      const double biweight = (1 - t * t) * (1 - t * t);
      const std::array<LeastSquares::Term, 3> row{{{0, p.normal.x}, {1, p.normal.y}, {2, 1}}};
      const double sd = std::hypot(p.standardError, kModelError);
      equations.add(row, p.offset, biweight / (sd * sd));
      squares += biweight * errors[i] * errors[i];
      count += biweight > 0;
    }
    const auto change = equations.solve(), variances = equations.variances();
    if (!change || !variances || count < 4) return std::nullopt;
    fit.change = {(*change)[0], (*change)[1], (*change)[2]};
    fit.standardError = std::sqrt(squares / (count - 3) * *std::ranges::max_element(*variances));
  }
  return fit;
}

// The share of arcs whose best position, of those within `reach`, is the circle's.
double shareThatAgrees(const std::vector<Arc>& arcs) {
  constexpr double kNear = 0.5;
  const auto agree = std::ranges::count_if(arcs, [](const Arc& arc) {
    const std::optional<ArcPoint> point = arc.point();
    return point && std::fabs(point->offset) < kNear;
  });
  return double(agree) / double(std::max<size_t>(arcs.size(), 1));
}

Circle changed(const Circle& circle, const dvec3& change) {
  return {circle.centre + dvec2(change), circle.radius + change.z};
}

}  // namespace

std::optional<Outline> fitOutline(const Image& image, const Circle& start) {
  constexpr double kFar = 2.4, kNear = 1;
  const Circle likeliest = changed(start, likeliestChange(arcsAround(image, start, kFar), kFar));
  std::optional<Outline> outline = Outline{likeliest, 0, 0};
  for (int step = 0; step < 2; ++step) {
    const std::optional<CircleFit> fit = fitPoints(arcsAround(image, outline->circle, kNear));
    if (!fit) return std::nullopt;
    outline = Outline{changed(outline->circle, fit->change), fit->standardError, 0};
  }
  outline->support = shareThatAgrees(arcsAround(image, outline->circle, kFar));
  return outline;
}

}  // namespace chromeball
