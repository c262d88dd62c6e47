// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/rim_arc.h"

#include <limits>

namespace chromeball {
namespace {

using glm::dvec2;
using glm::dvec3;

// The model's functions of the distance d from the outline, as means over a pixel.
struct RimFunctions {
  double outside = 0;  // 1 outside, 0 inside
  double outward = 0;  // d outside
  double root = 0;     // sqrt(-d) inside
  double inward = 0;   // -d inside
};

// Along the normal, the square of a pixel is the convolution of two boxes, so that the mean of a
// function is a second difference of its second integral.
class PixelMean {
 public:
  PixelMean(const dvec2& normal, double blur)
      : a_(0.5 * std::max(std::fabs(normal.x), kLeast)),
        b_(0.5 * std::max(std::fabs(normal.y), kLeast)),
        blur_(blur) {}

  // The functions at the pixel with its centre at `distance`. The Gaussian is a sum over nodes 0.75
  // standard deviations apart.
  RimFunctions at(double distance) const {
    RimFunctions mean;
    if (blur_ == 0) {
      addSharp(distance, 1, mean);
      return mean;
    }
    constexpr double kSpacing = 0.75;
    constexpr int kNodes = 4;  // on each side
    constexpr std::array kWeights = {0.29930, 0.22592, 0.09717, 0.02381, 0.00333};
    for (int i = -kNodes; i <= kNodes; ++i)
      addSharp(distance + i * kSpacing * blur_, kWeights[size_t(std::abs(i))], mean);
    return mean;
  }

 private:
  static constexpr double kLeast = 0.02;

  void addSharp(double distance, double weight, RimFunctions& mean) const {
    addIntegral(distance + a_ + b_, weight / (4 * a_ * b_), mean);
    addIntegral(distance + a_ - b_, -weight / (4 * a_ * b_), mean);
    addIntegral(distance - a_ + b_, -weight / (4 * a_ * b_), mean);
    addIntegral(distance - a_ - b_, weight / (4 * a_ * b_), mean);
  }

  static void addIntegral(double d, double weight, RimFunctions& sum) {
    const double w = weight * d * d;
    if (d > 0) {
      sum.outside += w / 2;
      sum.outward += w * d / 6;
    } else {
      sum.root += w * std::sqrt(-d) * 4 / 15;
      sum.inward -= w * d / 6;
    }
  }

  double a_, b_, blur_;
};

RimRow rowOf(const RimFunctions& f, double along, bool isContinuous) {
  RimRow row{f.outward, f.root, f.inward, f.outside * along, (1 - f.outside) * along};
  row[5] = isContinuous ? 1 : f.outside;
  row[6] = isContinuous ? 0 : 1 - f.outside;
  return row;
}

constexpr double kLeastVariance = 1e-5;  // over the mean square

struct RimVariances {
  double outside, inside;
  double at(double shareOutside) const {
    return shareOutside * outside + (1 - shareOutside) * inside;
  }
};

RimVariances variancesOf(const std::vector<double>& squares, const std::vector<double>& outside,
                         double least, bool areOne) {
  constexpr double kOutsideUnknowns = 3, kInsideUnknowns = 4;
  constexpr double kLeastRatio = 0.01;  // a side fits by chance, not because it has no noise
  double sumOutside = 0, sumInside = 0, pixelsOutside = 0;
  for (size_t i = 0; i < squares.size(); ++i) {
    sumOutside += outside[i] * squares[i];
    sumInside += (1 - outside[i]) * squares[i];
    pixelsOutside += outside[i];
  }
  const double pixels = double(squares.size()), unknowns = kOutsideUnknowns + kInsideUnknowns;
  if (areOne) {
    const double both = least + (sumOutside + sumInside) / std::max(pixels - unknowns, 1.0);
    return {both, both};
  }
  const RimVariances variances{
      least + sumOutside / std::max(pixelsOutside - kOutsideUnknowns, 1.0),
      least + sumInside / std::max(pixels - pixelsOutside - kInsideUnknowns, 1.0)};
  return {std::max(variances.outside, kLeastRatio * variances.inside),
          std::max(variances.inside, kLeastRatio * variances.outside)};
}

}  // namespace

RimArc::RimArc(const Image& image, const Circle& circle, double angle, double halfAngle,
               double reach)
    : normal_(std::cos(angle), std::sin(angle)) {
  const dvec2 middle = circle.centre + circle.radius * normal_;
  const double side = std::hypot(halfAngle * circle.radius, kRimDepth + reach) + 1;
  const int left = std::max(int(middle.x - side), 0), top = std::max(int(middle.y - side), 0);
  const int right = std::min(int(middle.x + side), image.width - 1),
            bottom = std::min(int(middle.y + side), image.height - 1);
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x) {
      const dvec2 v = dvec2(x + 0.5, y + 0.5) - circle.centre;
      const double turn = std::atan2(normal_.x * v.y - normal_.y * v.x, glm::dot(normal_, v));
      const double distance = glm::length(v) - circle.radius;
      if (std::fabs(turn) > halfAngle || std::fabs(distance) > kRimDepth + reach) continue;
      pixels_.push_back({dvec3(image.rgb(x, y)), distance, turn * circle.radius});
      meanSquare_ += glm::dot(pixels_.back().radiance, pixels_.back().radiance);
    }
  meanSquare_ /= double(std::max<size_t>(pixels_.size(), 1));
}

double RimArc::doubt(const RimModel& model, double offset) const {
  constexpr int kSteps = 3;  // that the variances and the unknowns take to agree
  const PixelMean mean(normal_, model.blur);
  std::vector<RimRow> rows;
  std::vector<double> outside;
  rows.reserve(pixels_.size()), outside.reserve(pixels_.size());
  for (const Pixel& pixel : pixels_) {
    const RimFunctions functions = mean.at(pixel.distance - offset);
    rows.push_back(rowOf(functions, pixel.along, model.isContinuous));
    outside.push_back(functions.outside);
  }

  const double least = kLeastVariance * meanSquare_ + std::numeric_limits<double>::min();
  RimVariances variances{1, 1};
  std::vector<double> squares(rows.size());
  for (int step = 0; step < kSteps; ++step) {
    RimEquations equations(model.isContinuous ? 6 : 7);
    for (size_t i = 0; i < rows.size(); ++i)
      equations.add(rows[i], pixels_[i].radiance, 1 / variances.at(outside[i]));
    if (!equations.solve()) return std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < rows.size(); ++i) {
      const dvec3 error = pixels_[i].radiance - equations.at(rows[i]);
      squares[i] = glm::dot(error, error);
    }
    variances = variancesOf(squares, outside, least, model.hasOneVariance);
    if (model.hasOneVariance) break;
  }
  double logarithms = 0;
  for (size_t i = 0; i < rows.size(); ++i) {
    const double variance = variances.at(outside[i]);
    logarithms += std::log(variance) + squares[i] / variance;
  }
  return 0.5 * logarithms;
}

}  // namespace chromeball
