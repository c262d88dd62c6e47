// SPDX-License-Identifier: Apache-2.0
#include "denoise/denoise.h"

#include <cmath>
#include <limits>
#include <span>

#include "denoise/filter.h"
#include "denoise/selection.h"
#include "math/vec.h"

namespace chromeball {
namespace {

constexpr int kHalvesReach = 1;  // of the windows over which squared halves are averaged,
constexpr int kNoiseReach = 3;   // and over which they are the noise of the input

// A power of two that brings the mean of the images close to 1, so that the squares of radiances
// between 1e-8 and 1e10 are floats.
float normalization(std::span<const HalvedImage> images) {
  double sum = 0, count = 0;
  for (const auto& [mean, half] : images) {
    for (const float texel : mean.texels) sum += std::fabs(double(texel));
    for (const float texel : half.texels) sum += std::fabs(double(texel));
    count += double(mean.texels.size() + half.texels.size());
  }
  return 1 / powerOfTwoNear(sum / count);
}

Plane squares(const Plane& plane) {
  return makePlaneLike(plane, [&](int x, int y) { return plane.at(x, y) * plane.at(x, y); });
}

// The variance of the mean of two halves.
Plane varianceOf(const Plane& a, const Plane& b) {
  const Plane squared = makePlaneLike(a, [&](int x, int y) {
    const float half = (a.at(x, y) - b.at(x, y)) / 2;
    return half * half;
  });
  return boxMean(squared, kHalvesReach);
}

HalfPlanes halvesOf(const HalvedImage& image, float scale) {
  HalfPlanes halves;
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < 2; ++i) {
      const float sign = i == 0 ? 1 : -1;
      halves[size_t(i)][size_t(c)] =
          makePlane(image.mean.width, image.mean.height, [&](int x, int y) {
            return scale * (image.mean.at(x, y)[c] + sign * image.half.at(x, y)[c]);
          });
    }
  return halves;
}

// Whether the noise of a pixel is far below its light. Not where all is black: the samples may have
// missed what lights it.
bool isClean(const Component& component, int x, int y) {
  float size = 0, variance = 0;
  for (size_t c = 0; c < 3; ++c) {
    const float sum = component.halves[0][c].at(x, y) + component.halves[1][c].at(x, y);
    size += sum * sum / 4;
    variance += component.variance[c].at(x, y);
  }
  return size > 0 && isNegligible(variance, size);
}

// `empty`: not 0 where nothing is seen.
Component componentOf(HalfPlanes halves, const Plane& empty) {
  Component component{std::move(halves), {}, {}};
  for (size_t c = 0; c < 3; ++c)
    component.variance[c] = varianceOf(component.halves[0][c], component.halves[1][c]);
  component.wanted = makePlaneLike(
      empty, [&](int x, int y) { return float(empty.at(x, y) == 0 && !isClean(component, x, y)); });
  return component;
}

constexpr float kInsignificant = 0.005f;  // difference of a feature; relative for disparity

// The halves of a feature, scaled, as guides of each other.
HalfGuides guidesOf(const HalvedImage& image, float scale) {
  HalfGuides halves;
  for (int c = 0; c < image.mean.channels; ++c) {
    const Plane mean = planeOf(image.mean, c), half = planeOf(image.half, c);
    const Plane noise = boxMean(squares(half), kHalvesReach);
    for (int i = 0; i < 2; ++i) {
      const float sign = i == 0 ? 1 : -1;
      halves[size_t(i)].values.push_back(makePlaneLike(
          mean, [&](int x, int y) { return scale * (mean.at(x, y) + sign * half.at(x, y)); }));
      halves[size_t(i)].variances.push_back(
          makePlaneLike(mean, [&](int x, int y) { return 2 * scale * scale * noise.at(x, y); }));
    }
  }
  return halves;
}

// Features without their own noise, which is correlated with the image's noise where a pixel sees
// several surfaces at random (edges, lenses, transparency): a regression would keep it.
FeaturePlanes featuresOf(const DenoiseInput& input, Scratch& scratch,
                         const std::atomic<bool>& stop) {
  FeaturePlanes features;
  size_t at = 0;
  for (const HalvedImage* image : {&input.albedo, &input.normal, &input.disparity}) {
    const bool isRelative = image == &input.disparity;
    const float scale = isRelative ? normalization({image, 1}) : 1;
    const HalfChannels halves = averageHalves(guidesOf(*image, scale), scratch, stop);
    for (size_t c = 0; c < halves[0].size(); ++c, ++at) {
      const Plane &a = halves[0][c], &b = halves[1][c];
      const Plane values =
          makePlaneLike(a, [&](int x, int y) { return (a.at(x, y) + b.at(x, y)) / 2; });
      const Plane noise = varianceOf(a, b);
      features.ridges[at] = makePlaneLike(a, [&](int x, int y) {
        const float size = kInsignificant * (isRelative ? values.at(x, y) : 1);
        return size * size + noise.at(x, y) + 1e-12f;
      });
      features.values[at] = values;
    }
  }
  return features;
}

// Guides that are filtered themselves. Their remaining variance is the variance between the halves
// plus a fraction of the noise, since its differences between neighbours underestimate it.
HalfGuides guidesOf(const HalfPlanes& filtered, const Component& component) {
  constexpr float kRemaining = 0.05f;
  constexpr int kReach = 2;
  HalfGuides guides;
  for (size_t c = 0; c < 3; ++c) {
    const Plane &a = filtered[0][c], &b = filtered[1][c];
    const Plane squared = makePlaneLike(a, [&](int x, int y) {
      const float difference = a.at(x, y) - b.at(x, y);
      return difference * difference / 2;
    });
    const Plane between = boxMean(squared, kReach);
    const Plane variance = makePlaneLike(a, [&](int x, int y) {
      return between.at(x, y) + kRemaining * component.variance[c].at(x, y);
    });
    for (size_t half = 0; half < 2; ++half) {
      guides[half].values.push_back(filtered[half][c]);
      guides[half].variances.push_back(variance);
    }
  }
  return guides;
}

// Squared errors of the channels of the input, averaged over windows.
RgbPlanes noiseOf(const HalvedImage& image, float scale) {
  RgbPlanes noise;
  for (int c = 0; c < 3; ++c) {
    const Plane mean = planeOf(image.mean, c), half = planeOf(image.half, c);
    const auto scaled = [&](const Plane& plane) {
      return makePlaneLike(plane, [&](int x, int y) { return scale * plane.at(x, y); });
    };
    noise[size_t(c)] = averageErrors(squares(scaled(half)), scaled(mean), kNoiseReach);
  }
  return noise;
}

// Two passes with two bandwidths each: the second computes its weights from the narrower result of
// the first, and averages with them, too. `progress` receives the fraction.
Selection denoise(const Component& component, const FeaturePlanes& features, Scratch& scratch,
                  const Progress& progress, const std::atomic<bool>& stop) {
  const auto first =
      filterHalves(component, guidesOf(component), features, {1, 8}, 0, scratch, stop);
  progress(0.5);
  const auto second = filterHalves(component, guidesOf(first.regressions[1], component), features,
                                   {1, 4}, 4, scratch, stop);
  progress(1);
  return best({filtered(component, second.regressions[0], FilterKind::Wide),
               filtered(component, second.regressions[1], FilterKind::Narrow),
               filtered(component, first.regressions[0], FilterKind::Wide),
               filtered(component, first.regressions[1], FilterKind::Narrow),
               filtered(component, second.averages, FilterKind::Average), unfiltered(component)});
}

// No sample hit a surface or found light: the background of a transparent image.
bool isEmpty(const DenoiseInput& input, const HalvedImage& part, int x, int y) {
  return *input.disparity.mean.at(x, y) == 0 && *input.disparity.half.at(x, y) == 0 &&
         part.mean.rgb(x, y) == Rgb(0) && part.half.rgb(x, y) == Rgb(0);
}

}  // namespace

std::optional<std::vector<DenoisedPart>> denoise(const DenoiseInput& input,
                                                 const Progress& progress,
                                                 const std::atomic<bool>& stop) {
  const float scale = normalization(input.parts);
  Scratch scratch;
  const FeaturePlanes features = featuresOf(input, scratch, stop);
  std::vector<DenoisedPart> results;
  for (const HalvedImage& part : input.parts) {
    const double before = double(results.size()), count = double(input.parts.size());
    const RgbPlanes noise = noiseOf(part, scale);
    HalfPlanes halves = halvesOf(part, scale);
    const Plane squaredBias = limitFireflies(halves);
    const Plane empty =
        makePlaneLike(squaredBias, [&](int x, int y) { return float(isEmpty(input, part, x, y)); });
    const Selection found = denoise(
        componentOf(std::move(halves), empty), features, scratch,
        [&](double fraction) { progress((before + fraction) / count); }, stop);
    if (stop) return std::nullopt;
    const int width = part.mean.width, height = part.mean.height;
    results.push_back({Image(width, height, 3), Image(width, height, 3)});
    DenoisedPart& result = results.back();
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (empty.at(x, y) != 0) continue;
        for (int c = 0; c < 3; ++c) {
          // The light of fireflies is missing; without the limit their noise would be there.
          const float known = std::max(found.error[size_t(c)].at(x, y), 0.0f);
          const float error =
              std::min(known + squaredBias.at(x, y), std::max(known, noise[size_t(c)].at(x, y)));
          result.color.at(x, y)[c] = found.color[size_t(c)].at(x, y) / scale;
          result.standardError.at(x, y)[c] = std::sqrt(error) / scale;
        }
      }
  }
  return results;
}

Denoised sumOf(const std::vector<DenoisedPart>& parts) {
  const int width = parts.front().color.width, height = parts.front().color.height;
  Denoised sum{Image(width, height, 3), Image(width, height, 1)};
  for (size_t i = 0; i < sum.color.pixels(); ++i) {
    Rgb color(0);
    glm::dvec3 squaredError(0);  // beyond the range of a float for bright and dim images
    for (const DenoisedPart& part : parts) {
      color += part.color.rgb(i);
      const glm::dvec3 error(part.standardError.rgb(i));
      squaredError += error * error;
    }
    // A regression may predict less than nothing.
    sum.color.setRgb(i, glm::max(color, Rgb(0)));
    sum.error.texels[i] = float(luminance(glm::sqrt(squaredError)));
  }
  return sum;
}

double denoiseBytes(int width, int height, int parts) {
  const double planes = 167 + 6 * parts;  // that exist at the same time, at most
  return planes * sizeof(float) * (width + 2.0 * Plane::kMargin) * (height + 2.0 * Plane::kMargin);
}

Image relativeErrors(const Denoised& denoised) {
  const Image& color = denoised.whole.empty() ? denoised.color : denoised.whole;
  Image relative = denoised.error;
  double mean = 0;
  for (size_t i = 0; i < color.pixels(); ++i)
    mean += double(luminance(color.rgb(i))) / double(color.pixels());
  for (size_t i = 0; i < color.pixels(); ++i) {
    // As far as is known here, a pixel is as bright as its error if that exceeds its luminance.
    float& error = relative.texels[i];
    const double reference =
        std::max({double(luminance(color.rgb(i))), double(error), 0.01 * mean});
    error = float(mean > 0 ? double(error) / reference : std::numeric_limits<double>::quiet_NaN());
  }
  return relative;
}

double remainingNoise(const Image& relativeErrors) {
  double sum = 0;
  for (const float error : relativeErrors.texels) sum += double(error) * double(error);
  return std::sqrt(sum / double(relativeErrors.texels.size()));
}

}  // namespace chromeball
