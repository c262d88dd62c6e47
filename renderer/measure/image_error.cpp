// SPDX-License-Identifier: Apache-2.0
#include "measure/image_error.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace chromeball {
namespace {

void checkSameShape(const Image& a, const Image& b, const char* what) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels)
    throwInput("{} differ in size: {} x {} x {} and {} x {} x {}", what, a.width, a.height,
               a.channels, b.width, b.height, b.channels);
}

// NaN if the variance is unknown.
double zScore(const Image& a, const Image& b, const Image* varianceA, const Image* varianceB,
              size_t i) {
  const double variance = (varianceA ? double(varianceA->texels[i]) : 0) +
                          (varianceB ? double(varianceB->texels[i]) : 0);
  const double z = (double(a.texels[i]) - b.texels[i]) / std::sqrt(variance);
  return variance > 0 && std::isfinite(z) ? z : std::nan("");
}

ZScores zScores(const Image& a, const Image& b, const Image* varianceA, const Image* varianceB) {
  ZScores scores;
  double sum = 0, sumOfSquares = 0;
  size_t beyond = 0;
  for (size_t i = 0; i < a.texels.size(); ++i) {
    const double z = zScore(a, b, varianceA, varianceB, i);
    if (std::isnan(z)) continue;
    scores.largest = std::max(scores.largest, std::fabs(z));
    ++scores.count;
    sum += z;
    sumOfSquares += z * z;
    beyond += std::fabs(z) > 3;
  }
  if (scores.count == 0) return scores;
  const double n = double(scores.count);
  scores.mean = sum / n;
  scores.standardDeviation = std::sqrt(std::max(0.0, sumOfSquares / n - scores.mean * scores.mean));
  scores.fractionBeyond3 = double(beyond) / n;
  const double minimum = 2 * cdf(complement(boost::math::normal(), scores.largest));
  scores.pValue = -std::expm1(n * std::log1p(-minimum));
  return scores;
}

}  // namespace

ImageError imageError(const Image& a, const Image& b, const Image* varianceA,
                      const Image* varianceB) {
  checkSameShape(a, b, "the images");
  if (varianceA) checkSameShape(a, *varianceA, "the first image and its variance");
  if (varianceB) checkSameShape(b, *varianceB, "the second image and its variance");

  ImageError error;
  double sumDifference = 0, sumReference = 0, peak = 0;
  size_t count = 0;
  for (size_t i = 0; i < a.texels.size(); ++i) {
    const double x = a.texels[i], y = b.texels[i], difference = x - y;
    if (!std::isfinite(difference)) {
      ++error.invalid;
      continue;
    }
    ++count;
    error.mse += difference * difference;
    error.relMse += difference * difference / (y * y + 0.01);
    error.maxDifference = std::max(error.maxDifference, std::fabs(difference));
    sumDifference += difference;
    sumReference += y;
    peak = std::max(peak, std::fabs(y));
  }
  if (count == 0) throwInput("the images have no number that is finite in both");
  const double n = double(count);
  error.mse /= n;
  error.relMse /= n;
  error.bias = sumDifference == 0 ? 0 : sumDifference / sumReference;
  error.psnr = 10 * std::log10(peak * peak / error.mse);
  if (error.mse == 0) error.psnr = std::numeric_limits<double>::infinity();
  if (varianceA || varianceB) error.zScores = zScores(a, b, varianceA, varianceB);
  return error;
}

Image zScoreImage(const Image& a, const Image& b, const Image* varianceA, const Image* varianceB) {
  checkSameShape(a, b, "the images");
  Image scores(a.width, a.height, 1);
  for (size_t i = 0; i < a.texels.size(); ++i) {
    const double z = zScore(a, b, varianceA, varianceB, i);
    float& score = scores.texels[i / size_t(a.channels)];
    if (!std::isnan(z)) score = std::max(score, float(std::fabs(z)));
  }
  return scores;
}

Image relativeErrorImage(const Image& a, const Image& b) {
  checkSameShape(a, b, "the images");
  Image error(a.width, a.height, 1);
  for (size_t i = 0; i < a.texels.size(); ++i) {
    const double difference = double(a.texels[i]) - b.texels[i], truth = b.texels[i];
    error.texels[i / size_t(a.channels)] +=
        float(difference * difference / (truth * truth + 0.01) / a.channels);
  }
  for (float& number : error.texels) number = std::sqrt(number);
  return error;
}

namespace {

// acos loses half of the digits of small angles.
double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

}  // namespace

EstimateError estimateError(const Image& predicted, const Image& truth, const Image& mask) {
  double pp = 0, pt = 0, tt = 0, difference = 0, angles = 0;
  size_t pixels = 0, colored = 0;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      if (*mask.at(x, y) == 0) continue;
      const glm::dvec3 p(predicted.rgb(x, y)), t(truth.rgb(x, y));
      ++pixels;
      pp += glm::dot(p, p);
      pt += glm::dot(p, t);
      tt += glm::dot(t, t);
      difference += glm::dot(p - t, p - t);
      if (p == glm::dvec3(0) || t == glm::dvec3(0)) continue;
      ++colored;
      angles += degreesBetween(p, t);
    }
  const double count = 3 * double(pixels);
  EstimateError error;
  error.rmse = std::sqrt(difference / count);
  error.scale = pp > 0 ? pt / pp : 0;
  // sum (scale p - t)^2 = sum t^2 - scale sum p t
  error.scaleInvariantRmse = std::sqrt(std::max(0.0, tt - error.scale * pt) / count);
  error.angularError = colored ? angles / double(colored) : std::nan("");
  return error;
}

}  // namespace chromeball
