// SPDX-License-Identifier: Apache-2.0
#include "denoise/denoise.h"

#include <cmath>
#include <limits>

#include "denoise/selection.h"

namespace chromeball {
namespace {

constexpr int kVarianceReach = 1;  // of the windows over which squared halves are averaged

// A power of two that brings the mean of the images close to 1, so that the squares of radiances
// between 1e-8 and 1e10 are floats.
float normalization(std::initializer_list<const Image*> images) {
  double sum = 0, count = 0;
  for (const Image* image : images) {
    for (const float texel : image->texels) sum += std::fabs(double(texel));
    count += double(image->texels.size());
  }
  if (!(sum > 0)) return 1;
  return float(std::exp2(-std::clamp(std::round(std::log2(sum / count)), -100.0, 100.0)));
}

Plane squares(const Plane& plane) {
  return makePlane(plane.width(), plane.height(),
                   [&](int x, int y) { return plane.at(x, y) * plane.at(x, y); });
}

// `mean` and `half` are functions of (x, y, channel).
template <class Mean, class Half>
Component componentOf(int width, int height, const Mean& mean, const Half& half) {
  Component component;
  for (int c = 0; c < 3; ++c) {
    const auto plane = [&](const auto& value) {
      return makePlane(width, height, [&](int x, int y) { return value(x, y, c); });
    };
    component.halves[0][size_t(c)] =
        plane([&](int x, int y, int i) { return mean(x, y, i) + half(x, y, i); });
    component.halves[1][size_t(c)] =
        plane([&](int x, int y, int i) { return mean(x, y, i) - half(x, y, i); });
    component.variance[size_t(c)] = boxMean(squares(plane(half)), kVarianceReach);
  }
  return component;
}

Component directOf(const DenoiseInput& input, float scale) {
  const auto texel = [&](const Image& image) {
    return [&image, scale](int x, int y, int c) { return image.at(x, y)[c] * scale; };
  };
  return componentOf(input.color.mean.width, input.color.mean.height, texel(input.direct.mean),
                     texel(input.direct.half));
}

Component indirectOf(const DenoiseInput& input, float scale) {
  const auto difference = [&](const Image& all, const Image& direct) {
    return [&all, &direct, scale](int x, int y, int c) {
      return (all.at(x, y)[c] - direct.at(x, y)[c]) * scale;
    };
  };
  return componentOf(input.color.mean.width, input.color.mean.height,
                     difference(input.color.mean, input.direct.mean),
                     difference(input.color.half, input.direct.half));
}

constexpr float kInsignificant = 0.005f;  // difference of a feature; of disparity: relative

// The halves of a feature, scaled, as guides of each other.
HalfGuides halvesOf(const HalvedImage& image, float scale) {
  HalfGuides halves;
  for (int c = 0; c < image.mean.channels; ++c) {
    const Plane mean = planeOf(image.mean, c), half = planeOf(image.half, c);
    const Plane noise = boxMean(squares(half), kVarianceReach);
    for (int i = 0; i < 2; ++i) {
      const float sign = i == 0 ? 1 : -1;
      halves[size_t(i)].values.push_back(makePlane(mean.width(), mean.height(), [&](int x, int y) {
        return scale * (mean.at(x, y) + sign * half.at(x, y));
      }));
      halves[size_t(i)].variances.push_back(
          makePlane(mean.width(), mean.height(),
                    [&](int x, int y) { return 2 * scale * scale * noise.at(x, y); }));
    }
  }
  return halves;
}

// Features without their own noise, which is correlated with that of the image where a pixel sees
// several surfaces at random (edges, lenses, transparency): a regression would keep it.
FeaturePlanes featuresOf(const DenoiseInput& input, const std::atomic<bool>& stop) {
  FeaturePlanes features;
  size_t at = 0;
  for (const HalvedImage* image : {&input.albedo, &input.normal, &input.disparity}) {
    const bool isRelative = image == &input.disparity;
    const float scale = isRelative ? normalization({&image->mean, &image->half}) : 1;
    const HalfChannels halves = averageHalves(halvesOf(*image, scale), stop);
    for (size_t c = 0; c < halves[0].size(); ++c, ++at) {
      const Plane &a = halves[0][c], &b = halves[1][c];
      const Plane values = makePlane(a.width(), a.height(),
                                     [&](int x, int y) { return (a.at(x, y) + b.at(x, y)) / 2; });
      const Plane noise = boxMean(makePlane(a.width(), a.height(),
                                            [&](int x, int y) {
                                              const float half = (a.at(x, y) - b.at(x, y)) / 2;
                                              return half * half;
                                            }),
                                  kVarianceReach);
      features.ridges[at] = makePlane(a.width(), a.height(), [&](int x, int y) {
        const float size = kInsignificant * (isRelative ? values.at(x, y) : 1);
        return size * size + noise.at(x, y) + 1e-12f;
      });
      features.values[at] = values;
    }
  }
  return features;
}

// Guides that are filtered themselves. Their remaining variance is that between the halves, and a
// fraction of the noise, as its differences between neighbours underestimate it.
HalfGuides guidesOf(const HalfPlanes& filtered, const Component& component) {
  constexpr float kRemaining = 0.05f;
  constexpr int kReach = 2;
  HalfGuides guides;
  for (size_t c = 0; c < 3; ++c) {
    const Plane &a = filtered[0][c], &b = filtered[1][c];
    const Plane between = boxMean(makePlane(a.width(), a.height(),
                                            [&](int x, int y) {
                                              const float difference = a.at(x, y) - b.at(x, y);
                                              return difference * difference / 2;
                                            }),
                                  kReach);
    const Plane variance = makePlane(a.width(), a.height(), [&](int x, int y) {
      return between.at(x, y) + kRemaining * component.variance[c].at(x, y);
    });
    for (size_t half = 0; half < 2; ++half) {
      guides[half].values.push_back(filtered[half][c]);
      guides[half].variances.push_back(variance);
    }
  }
  return guides;
}

// Two passes with two bandwidths each: the second computes its weights from the narrower result of
// the first. `progress` receives the fraction.
Selection denoise(const Component& component, const FeaturePlanes& features,
                  const Progress& progress, const std::atomic<bool>& stop) {
  const auto first = filterHalves(component, guidesOf(component), features, {1, 8}, stop);
  progress(0.5);
  const auto second =
      filterHalves(component, guidesOf(first[1], component), features, {1, 4}, stop);
  progress(1);
  return best({filtered(component, second[0]), filtered(component, second[1]),
               filtered(component, first[0]), filtered(component, first[1]),
               unfiltered(component)});
}

// No sample hit a surface or found light: the background of a transparent image.
bool isEmpty(const DenoiseInput& input, int x, int y) {
  return *input.disparity.mean.at(x, y) == 0 && *input.disparity.half.at(x, y) == 0 &&
         input.color.mean.rgb(x, y) == Rgb(0) && input.color.half.rgb(x, y) == Rgb(0);
}

}  // namespace

std::optional<Denoised> denoise(const DenoiseInput& input, const Progress& progress,
                                const std::atomic<bool>& stop) {
  const int width = input.color.mean.width, height = input.color.mean.height;
  const float scale =
      normalization({&input.color.mean, &input.color.half, &input.direct.mean, &input.direct.half});
  const FeaturePlanes features = featuresOf(input, stop);
  Denoised result{Image(width, height, 3), Image(width, height, 1)};
  Image squaredError(width, height, 3);
  for (int part = 0; part < 2; ++part) {
    const Component component = part == 0 ? directOf(input, scale) : indirectOf(input, scale);
    const Selection found = denoise(
        component, features, [&](double fraction) { progress((part + fraction) / 2); }, stop);
    if (stop) return std::nullopt;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (int c = 0; c < 3; ++c) {
          result.color.at(x, y)[c] += found.color[size_t(c)].at(x, y) / scale;
          squaredError.at(x, y)[c] += found.error[size_t(c)].at(x, y);
        }
  }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      // A regression may predict less than nothing.
      result.color.setRgb(x, y, glm::max(result.color.rgb(x, y), Rgb(0)));
      if (isEmpty(input, x, y)) {
        result.color.setRgb(x, y, Rgb(0));
        squaredError.setRgb(x, y, Rgb(0));
      }
      *result.error.at(x, y) =
          luminance(glm::sqrt(glm::max(squaredError.rgb(x, y), Rgb(0)))) / scale;
    }
  return result;
}

double denoiseBytes(int width, int height) {
  constexpr double kPlanes = 150;  // that exist at the same time, at most
  return kPlanes * sizeof(float) * (width + 2.0 * Plane::kMargin) * (height + 2.0 * Plane::kMargin);
}

double remainingNoise(const Denoised& denoised) {
  const Image &color = denoised.color, &error = denoised.error;
  double mean = 0, sum = 0;
  const double count = double(error.texels.size());
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) mean += double(luminance(color.rgb(x, y))) / count;
  if (!(mean > 0)) return std::numeric_limits<double>::quiet_NaN();
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) {
      const double reference = std::max(double(luminance(color.rgb(x, y))), 0.01 * mean);
      const double relative = double(*error.at(x, y)) / reference;
      sum += relative * relative / count;
    }
  return std::sqrt(sum);
}

}  // namespace chromeball
