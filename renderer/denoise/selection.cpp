// SPDX-License-Identifier: Apache-2.0
#include "denoise/selection.h"

#include <cmath>

namespace chromeball {
namespace {

constexpr int kSizeReach = 1;      // of the window whose noise limits the size of a dark pixel
constexpr int kErrorReach = 3;     // of the window over which the noise is averaged
constexpr int kBiasReach = 6;      // squared biases in the final estimate
constexpr int kVarianceReach = 1;  // variances in it
constexpr float kDark = 0.01f;     // as in film/noise.h; the mean of the image is about 1
constexpr int kChoiceReach = 2;  // of the windows over which errors decide, and choices are blended
constexpr float kWindow = (2 * kChoiceReach + 1) * (2 * kChoiceReach + 1);
// The same as kDark, where the errors of a window decide: between regressions, and between these
// and an average or the noisy image. The latter is lower, so that reduced noise in bright pixels
// does not excuse light that a regression brings to dark pixels beside them.
constexpr float kDarkRegression = 1.5f, kDarkOther = 0.1f;

// The number of standard errors by which a candidate must be better than the ones before it. Where
// a few pixels hold all of the noise, the errors of filtered and noisy images are known equally
// badly, and the filtered image is better.
float marginOf(FilterKind filter) {
  switch (filter) {
    case FilterKind::None:
      return 0.8f;
    case FilterKind::Average:
      return 0.3f;
    default:
      return 0.6f;
  }
}

float square(float x) { return x * x; }

Plane meanOf(const Plane& a, const Plane& b) {
  return makePlaneLike(a, [&](int x, int y) { return (a.at(x, y) + b.at(x, y)) / 2; });
}

float total(const RgbPlanes& planes, int x, int y) {
  return planes[0].at(x, y) + planes[1].at(x, y) + planes[2].at(x, y);
}

// The scale of the errors of a pixel. The narrow filters know a sharp highlight from the dark
// pixels around it, and both halves of the samples contain it, but only one contains a firefly. A
// dark spot, to which they bring light, is not brighter than its noise and its neighbours' noise
// allow.
Plane squaredSizes(const std::vector<Candidate>& candidates) {
  const Candidate& noisy = candidates.back();
  const auto localVariance = [&](size_t c) { return boxMean(noisy.variance[c], kSizeReach); };
  const RgbPlanes variance{localVariance(0), localVariance(1), localVariance(2)};
  return makePlaneLike(noisy.error[0], [&](int x, int y) {
    float size = 0;
    for (size_t c = 0; c < 3; ++c) {
      float sum = 0, count = 0;
      for (const Candidate& candidate : candidates)
        if (candidate.filter == FilterKind::Narrow) sum += candidate.color[c].at(x, y), ++count;
      const float value = noisy.color[c].at(x, y);
      const float lesserHalf = std::max(value - std::sqrt(noisy.variance[c].at(x, y)), 0.0f);
      const float most = value + std::sqrt(variance[c].at(x, y));
      size += square(std::min((sum / count + lesserHalf) / 2, most));
    }
    return size;
  });
}

// The index of the chosen candidate, by relative errors: with absolute ones, reduced noise in a
// bright pixel would excuse its light in all pixels around it.
Plane choose(const std::vector<Candidate>& candidates) {
  const Plane size = squaredSizes(candidates);
  const auto errorOf = [&](size_t i) {
    return makePlaneLike(size, [&, i](int x, int y) { return total(candidates[i].error, x, y); });
  };
  Plane chosen = makePlaneLike(candidates[0].error[0], [](int, int) { return 0.0f; });
  Plane error = errorOf(0);
  for (size_t i = 1; i < candidates.size(); ++i) {
    const Plane next = errorOf(i);
    const FilterKind filter = candidates[i].filter;
    const bool isRegression = filter == FilterKind::Narrow || filter == FilterKind::Wide;
    const float least = 3 * square(isRegression ? kDarkRegression : kDarkOther);
    const Plane gain = makePlaneLike(size, [&](int x, int y) {
      return (error.at(x, y) - next.at(x, y)) / std::max(size.at(x, y), least);
    });
    const Plane squared = makePlaneLike(gain, [&](int x, int y) { return square(gain.at(x, y)); });
    const Plane mean = boxMean(gain, kChoiceReach), meanSquare = boxMean(squared, kChoiceReach);
    const float margin = marginOf(filter) / std::sqrt(kWindow);
    const auto isBetter = [&](int x, int y) {
      return mean.at(x, y) > margin * std::sqrt(meanSquare.at(x, y));
    };
    Plane better = makePlaneLike(
        chosen, [&](int x, int y) { return isBetter(x, y) ? next.at(x, y) : error.at(x, y); });
    chosen = makePlaneLike(
        chosen, [&](int x, int y) { return isBetter(x, y) ? float(i) : chosen.at(x, y); });
    error = std::move(better);
  }
  return chosen;
}

}  // namespace

Plane averageErrors(const Plane& squaredErrors, const Plane& color, int reach) {
  const Plane size = makePlaneLike(
      color, [&](int x, int y) { return std::max(square(color.at(x, y)), square(kDark)); });
  const Plane absolute = boxMean(squaredErrors, reach);
  const Plane relative = boxMean(
      makePlaneLike(size, [&](int x, int y) { return squaredErrors.at(x, y) / size.at(x, y); }),
      reach);
  return makePlaneLike(size, [&](int x, int y) {
    return std::min(absolute.at(x, y), relative.at(x, y) * size.at(x, y));
  });
}

Candidate unfiltered(const Component& component) {
  Candidate candidate;
  for (size_t c = 0; c < 3; ++c) {
    const Plane &c0 = component.halves[0][c], &c1 = component.halves[1][c];
    candidate.color[c] = meanOf(c0, c1);
    candidate.variance[c] =
        makePlaneLike(c0, [&](int x, int y) { return square(c0.at(x, y) - c1.at(x, y)) / 4; });
    candidate.error[c] = candidate.variance[c];
  }
  return candidate;
}

Candidate filtered(const Component& component, const HalfPlanes& halves, FilterKind filter) {
  Candidate candidate{.filter = filter};
  for (size_t c = 0; c < 3; ++c) {
    const Plane &f0 = halves[0][c], &f1 = halves[1][c];
    const Plane &c0 = component.halves[0][c], &c1 = component.halves[1][c];
    candidate.color[c] = meanOf(f0, f1);
    const Plane variance =
        makePlaneLike(f0, [&](int x, int y) { return square(f0.at(x, y) - f1.at(x, y)) / 4; });
    candidate.error[c] = makePlaneLike(f0, [&](int x, int y) {
      const float f = (square(f0.at(x, y) - c1.at(x, y)) + square(f1.at(x, y) - c0.at(x, y))) / 2;
      const float noise = square(c0.at(x, y) - c1.at(x, y)) / 2;
      return f - noise - variance.at(x, y);
    });
    candidate.variance[c] = variance;
  }
  return candidate;
}

Selection best(const std::vector<Candidate>& candidates) {
  const Plane chosen = choose(candidates);
  std::vector<Plane> shares;
  for (size_t i = 0; i < candidates.size(); ++i)
    shares.push_back(boxMean(
        makePlaneLike(chosen, [&](int x, int y) { return float(chosen.at(x, y) == float(i)); }),
        kChoiceReach));
  Selection result;
  for (size_t c = 0; c < 3; ++c) {
    const auto blend = [&](RgbPlanes Candidate::*part) {
      return makePlaneLike(chosen, [&](int x, int y) {
        float sum = 0;
        for (size_t i = 0; i < candidates.size(); ++i)
          sum += shares[i].at(x, y) * (candidates[i].*part)[c].at(x, y);
        return sum;
      });
    };
    result.color[c] = blend(&Candidate::color);
    const auto averaged = [&](const Plane& squaredError, int reach) {
      return averageErrors(squaredError, result.color[c], reach);
    };
    const Plane blended = blend(&Candidate::variance);
    const Plane variance = averaged(blended, kVarianceReach);
    const Plane error = averaged(blend(&Candidate::error), kBiasReach);
    const Plane spread = averaged(blended, kBiasReach);
    const Plane noise = averaged(candidates.back().error[c], kErrorReach);
    result.error[c] = makePlaneLike(chosen, [&](int x, int y) {
      const float bias = std::max(error.at(x, y) - spread.at(x, y), 0.0f);
      return std::min(variance.at(x, y) + bias, std::max(variance.at(x, y), noise.at(x, y)));
    });
  }
  return result;
}

}  // namespace chromeball
