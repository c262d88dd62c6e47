// SPDX-License-Identifier: Apache-2.0
#include "measure/image_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "base/error.h"

namespace chromeball {
namespace {

using dvec3 = glm::dvec3;
using Field = std::vector<double>;  // one number per pixel; also a filter kernel

// Linear Rec. 709 to XYZ.
const glm::dmat3 kToXyz = glm::transpose(
    glm::dmat3(10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794,    // X
               2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897,      // Y
               1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382));  // Z
const dvec3 kWhite = kToXyz * dvec3(1);

// YCxCz, the opponent colour space of the contrast sensitivity functions; linear in XYZ.
dvec3 toOpponent(const dvec3& rgb) {
  const dvec3 xyz = kToXyz * rgb / kWhite;
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}
dvec3 fromOpponent(const dvec3& c) {
  const double y = (c.x + 16) / 116;
  return glm::inverse(kToXyz) * (dvec3(y + c.y / 500, y, y - c.z / 200) * kWhite);
}

// CIELAB with a and b scaled by lightness, for the Hunt effect.
dvec3 toHuntLab(const dvec3& rgb) {
  constexpr double kDelta = 6.0 / 29;
  const auto f = [](double t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const dvec3 xyz = kToXyz * rgb / kWhite;
  const double lightness = 116 * f(xyz.y) - 16;
  return {lightness, 0.01 * lightness * 500 * (f(xyz.x) - f(xyz.y)),
          0.01 * lightness * 200 * (f(xyz.y) - f(xyz.z))};
}

double hyab(const dvec3& a, const dvec3& b) {
  return std::fabs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// A one-dimensional filter kernel of 2 radius + 1 weights.
Field kernel(int radius, const std::function<double(int)>& weight) {
  Field weights;
  for (int x = -radius; x <= radius; ++x) weights.push_back(weight(x));
  return weights;
}

// Scales the weights so that the positive ones sum to 1 and the negative ones to -1.
Field normalized(Field weights) {
  double positive = 0, negative = 0;
  for (const double w : weights) (w > 0 ? positive : negative) += w;
  for (double& w : weights) w /= w > 0 ? positive : negative < 0 ? -negative : 1;
  return weights;
}

struct Size {
  int width, height;
};

Field filtered(const Field& field, Size size, const Field& weights, bool alongX) {
  const int radius = int(weights.size()) / 2;
  const int step = alongX ? 1 : size.width, length = alongX ? size.width : size.height;
  Field result(field.size());
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const int at = y * size.width + x, position = alongX ? x : y;
      double sum = 0;
      for (int i = -radius; i <= radius; ++i)  // outside, the border is repeated
        sum += weights[size_t(i + radius)] *
               field[size_t(at + (std::clamp(position + i, 0, length - 1) - position) * step)];
      result[size_t(at)] = sum;
    }
  return result;
}

Field filtered(const Field& field, Size size, const Field& alongX, const Field& alongY) {
  return filtered(filtered(field, size, alongX, true), size, alongY, false);
}

// Contrast sensitivity in each opponent colour: a sum of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 /
// b) with x in degrees (table 1 of the paper).
struct Gaussian {
  double a, b;
};
const std::array<std::vector<Gaussian>, 3> kContrastSensitivity = {
    {{{1, 0.0047}}, {{1, 0.0053}}, {{34.1, 0.04}, {13.5, 0.025}}}};

Field filteredByEye(const Field& field, Size size, const std::vector<Gaussian>& gaussians,
                    double pixelsPerDegree) {
  constexpr double kMaxB = 0.04;  // of kContrastSensitivity
  const int radius = int(std::ceil(3 * std::sqrt(kMaxB / (2 * kPiD * kPiD)) * pixelsPerDegree));
  Field result(field.size());
  double total = 0;
  for (const auto& [a, b] : gaussians) {
    const Field weights = kernel(radius, [&, b = b](int x) {
      const double degrees = x / pixelsPerDegree;
      return std::exp(-kPiD * kPiD * degrees * degrees / b);
    });
    double sum = 0;
    for (const double w : weights) sum += w;
    const double height = a * std::sqrt(kPiD / b);
    const Field blurred = filtered(field, size, weights, weights);
    for (size_t i = 0; i < result.size(); ++i) result[i] += height * blurred[i];
    total += height * sum * sum;
  }
  for (double& number : result) number /= total;
  return result;
}

// An image as perceived: colours after the eye's filter, and the strength of edges and points.
struct Percept {
  std::vector<dvec3> lab;
  Field edges, points;
};

Percept perceive(const Image& image, double pixelsPerDegree) {
  const Size size{image.width, image.height};
  const size_t pixels = image.pixels();
  std::array<Field, 3> opponent;
  opponent.fill(Field(pixels));
  Field achromatic(pixels);
  for (size_t i = 0; i < pixels; ++i) {
    const dvec3 c = toOpponent(glm::clamp(dvec3(image.rgb(i)), dvec3(0), dvec3(1)));
    for (int k = 0; k < 3; ++k) opponent[size_t(k)][i] = c[k];
    achromatic[i] = (c.x + 16) / 116;
  }

  Percept percept;
  for (size_t k = 0; k < 3; ++k)
    opponent[k] = filteredByEye(opponent[k], size, kContrastSensitivity[k], pixelsPerDegree);
  for (size_t i = 0; i < pixels; ++i) {
    const dvec3 rgb = fromOpponent({opponent[0][i], opponent[1][i], opponent[2][i]});
    percept.lab.push_back(toHuntLab(glm::clamp(rgb, dvec3(0), dvec3(1))));
  }

  constexpr double kFeatureWidth = 0.082;  // degrees
  const double sigma = 0.5 * kFeatureWidth * pixelsPerDegree;
  const int radius = int(std::ceil(3 * sigma));
  const auto gauss = [&](int x) { return std::exp(-x * x / (2 * sigma * sigma)); };
  const Field smooth = normalized(kernel(radius, gauss));
  const auto strength = [&](const Field& derivative) {
    Field along = filtered(achromatic, size, derivative, smooth);
    const Field across = filtered(achromatic, size, smooth, derivative);
    for (size_t i = 0; i < pixels; ++i) along[i] = std::hypot(along[i], across[i]);
    return along;
  };
  percept.edges = strength(normalized(kernel(radius, [&](int x) { return -x * gauss(x); })));
  percept.points = strength(
      normalized(kernel(radius, [&](int x) { return (x * x / (sigma * sigma) - 1) * gauss(x); })));
  return percept;
}

// Maps colour differences to [0, 1]: differences below 0.4 of the maximum are mapped to [0, 0.95].
double colorError(const dvec3& a, const dvec3& b) {
  constexpr double kPower = 0.7, kKnee = 0.4, kAtKnee = 0.95;
  static const double kMax = std::pow(hyab(toHuntLab({0, 1, 0}), toHuntLab({0, 0, 1})), kPower);
  const double difference = std::pow(hyab(a, b), kPower), knee = kKnee * kMax;
  if (difference < knee) return kAtKnee / knee * difference;
  return kAtKnee + (difference - knee) / (kMax - knee) * (1 - kAtKnee);
}

// The tone mapper (a x^2 + b x) / (c x^2 + d x + e).
constexpr double kA = 0.36 * 2.51, kB = 0.6 * 0.03, kC = 0.36 * 2.43, kD = 0.6 * 0.59, kE = 0.14;

double toneMapped(double x) { return (kA * x * x + kB * x) / (kC * x * x + kD * x + kE); }

// The x for which toneMapped(x) = y.
double inverseToneMapped(double y) {
  const double a = kA - kC * y, b = kB - kD * y, c = -kE * y;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

Image exposed(const Image& image, double stops) {
  Image result(image.width, image.height, 3);
  for (size_t i = 0; i < image.pixels(); ++i) {
    const dvec3 c = glm::max(dvec3(image.rgb(i)), dvec3(0)) * std::exp2(stops);
    result.setRgb(i, Rgb(toneMapped(c.x), toneMapped(c.y), toneMapped(c.z)));
  }
  return result;
}

}  // namespace

Image flip(const Image& reference, const Image& test, double pixelsPerDegree) {
  if (reference.width != test.width || reference.height != test.height)
    throwInput("the images differ in size: {} x {} and {} x {}", reference.width, reference.height,
               test.width, test.height);
  constexpr double kPower = 0.5;
  const Percept r = perceive(reference, pixelsPerDegree), t = perceive(test, pixelsPerDegree);
  Image error(reference.width, reference.height, 1);
  for (size_t i = 0; i < error.texels.size(); ++i) {
    const double difference =
        std::max(std::fabs(r.edges[i] - t.edges[i]), std::fabs(r.points[i] - t.points[i]));
    const double feature = std::pow(difference / std::sqrt(2), kPower);
    error.texels[i] = float(std::pow(colorError(r.lab[i], t.lab[i]), 1 - feature));
  }
  return error;
}

// FLIP for images of high dynamic range: the maximum over exposures.

Image hdrFlip(const Image& reference, const Image& test, double pixelsPerDegree) {
  std::vector<double> luminances;
  for (size_t i = 0; i < reference.pixels(); ++i)
    luminances.push_back(std::max(luminance(reference.rgb(i)), 1e-6f));
  std::sort(luminances.begin(), luminances.end());
  const double target = inverseToneMapped(0.85);
  const double start = std::log2(target / luminances.back());
  const double stop = std::log2(target / luminances[(luminances.size() - 1) / 2]);
  const int exposures = std::max(2, int(std::ceil(stop - start)));

  Image maximum(reference.width, reference.height, 1);
  for (int i = 0; i < exposures; ++i) {
    const double stops = start + (stop - start) * i / (exposures - 1);
    const Image error = flip(exposed(reference, stops), exposed(test, stops), pixelsPerDegree);
    for (size_t p = 0; p < maximum.texels.size(); ++p)
      maximum.texels[p] = std::max(maximum.texels[p], error.texels[p]);
  }
  return maximum;
}

}  // namespace chromeball
