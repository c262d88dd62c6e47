// SPDX-License-Identifier: Apache-2.0
#include "image/flat_field.h"

#include <cmath>
#include <set>

#include "base/error.h"
#include "base/parallel.h"
#include "math/dense_solvers.h"

namespace chromeball {
namespace {

// The distance up to which the polynomial is extrapolated: a source is inside the image, so no
// sample is in a corner.
constexpr double kReach = 1.1;

dvec2 pixelCentre(int x, int y) { return {x + 0.5, y + 0.5}; }

double radiusOf(const FlatField& field, const dvec2& position) {
  return glm::distance(position, field.centre) / field.unit;
}

// Adjacent samples at the same distance tell only one thing about v.
void checkRadii(std::span<const SourceSample> samples, const FlatField& field) {
  constexpr double kDifferent = 0.01;
  constexpr size_t kUnknowns = 4;
  std::multiset<double> radii;
  for (const SourceSample& sample : samples) radii.insert(radiusOf(field, sample.position));
  size_t different = 0;
  double last = -1;
  for (const double radius : radii)
    if (radius - last > kDifferent) ++different, last = radius;
  if (different < kUnknowns)
    throwInput(
        "flat-field: the source is at {} different distance{} from the centre; a polynomial of "
        "three terms and the source's radiance need at least {}",
        different, different == 1 ? "" : "s", kUnknowns);
}

void fitChannel(std::span<const SourceSample> samples, int channel, FlatField& field) {
  LeastSquares equations(4);
  for (const SourceSample& sample : samples) {
    const double r2 = std::pow(radiusOf(field, sample.position), 2);
    const LeastSquares::Term row[] = {{0, 1}, {1, r2}, {2, r2 * r2}, {3, r2 * r2 * r2}};
    equations.add(row, sample.radiance[channel]);
  }
  const auto solution = equations.solve();
  if (!solution || !((*solution)[0] > 0))
    throwInput("flat-field: the samples determine no polynomial that is above 0 in the centre");
  const std::vector<double>& s = *solution;
  field.a2[channel] = s[1] / s[0];
  field.a4[channel] = s[2] / s[0];
  field.a6[channel] = s[3] / s[0];

  double sum = 0;
  for (const SourceSample& sample : samples)
    sum += std::pow(sample.radiance[channel] / (s[0] * field.at(sample.position)[channel]) - 1, 2);
  field.rmsError[channel] = std::sqrt(sum / double(samples.size()));
}

}  // namespace

dvec2 findSource(const Image& photograph) {
  float maximum = 0;
  for (size_t i = 0; i < photograph.pixels(); ++i)
    maximum = std::max(maximum, luminance(photograph.rgb(i)));
  dvec2 sum(0);
  double weights = 0;
  for (int y = 0; y < photograph.height; ++y)
    for (int x = 0; x < photograph.width; ++x) {
      const double weight = luminance(photograph.rgb(x, y)) - 0.5 * maximum;
      if (!(weight > 0)) continue;
      sum += weight * pixelCentre(x, y);
      weights += weight;
    }
  return weights > 0 ? sum / weights : dvec2(photograph.width, photograph.height) / 2.0;
}

SourceSample measureSource(const Image& photograph, const dvec2& position, double radius,
                           const std::string& name) {
  const int w = photograph.width, h = photograph.height;
  if (!(position.x - radius >= 0 && position.y - radius >= 0 && position.x + radius <= w &&
        position.y + radius <= h))
    throwInput("{}: the source at {:.1f},{:.1f} with radius {:g} is not inside {} x {} pixels",
               name, position.x, position.y, radius, w, h);
  const int centreX = std::min(int(position.x), w - 1), centreY = std::min(int(position.y), h - 1);
  const int reach = int(radius) + 1;
  dvec3 sum(0);
  size_t count = 0;
  for (int y = std::max(0, centreY - reach); y <= std::min(h - 1, centreY + reach); ++y)
    for (int x = std::max(0, centreX - reach); x <= std::min(w - 1, centreX + reach); ++x) {
      const bool isCentre = x == centreX && y == centreY;
      if (!isCentre && glm::distance(pixelCentre(x, y), position) > radius) continue;
      sum += dvec3(photograph.rgb(x, y));
      ++count;
    }
  const SourceSample sample{position, sum / double(count)};
  for (int c = 0; c < 3; ++c)
    if (!(sample.radiance[c] > 0) || !std::isfinite(sample.radiance[c]))
      throwInput("{}: the source at {:.1f},{:.1f} should be above 0 in each channel", name,
                 position.x, position.y);
  return sample;
}

dvec3 FlatField::at(const dvec2& position) const {
  const double r2 = std::pow(std::min(radiusOf(*this, position), kReach * largest), 2);
  return 1.0 + r2 * (a2 + r2 * (a4 + r2 * a6));
}

Image FlatField::image(int width, int height) const {
  Image image(width, height, 3);
  forRows(width, height, [&](int y) {
    for (int x = 0; x < width; ++x) image.setRgb(x, y, Rgb(at(pixelCentre(x, y))));
  });
  return image;
}

FlatField fitFlatField(std::span<const SourceSample> samples, int width, int height,
                       const dvec2& centre) {
  FlatField field{.centre = centre, .unit = std::hypot(width, height) / 2};
  for (const SourceSample& sample : samples)
    field.largest = std::max(field.largest, radiusOf(field, sample.position));
  checkRadii(samples, field);
  for (int channel = 0; channel < 3; ++channel) fitChannel(samples, channel, field);
  constexpr int kSteps = 1000;
  for (int i = 0; i <= kSteps; ++i) {
    const dvec3 v = field.at(centre + dvec2(field.unit * kReach * field.largest * i / kSteps, 0));
    if (!(std::min({v.x, v.y, v.z}) > 0))
      throwInput(
          "flat-field: the fitted response is not above 0 everywhere; is the source's place "
          "right in each photograph, and the source constant?");
  }
  return field;
}

size_t divide(Image& a, const Image& b) {
  size_t undivided = 0;
  for (size_t i = 0; i < a.pixels(); ++i) {
    bool isDivided = true;
    for (int c = 0; c < 3; ++c) {
      const float divisor = b.at(i)[c];
      float& channel = a.at(i)[c];
      isDivided &= divisor > 0;
      channel = divisor > 0 ? channel / divisor : 0;
    }
    undivided += !isDivided;
  }
  return undivided;
}

}  // namespace chromeball
