// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/match_views.h"

#include <functional>
#include <numeric>

#include "base/parallel.h"
#include "probe/mapping.h"

namespace chromeball {

CaptureView::CaptureView(const Image& image, const Image& mask, const Circle& circle,
                         std::shared_ptr<const CaptureOptics> optics, const CameraPosition& camera)
    : disc_(image, circle, mask), radius_(circle.radius), optics_(std::move(optics)) {
  setCamera(camera);
}

void CaptureView::setCamera(const CameraPosition& camera) {
  camera_ = camera;
  toCamera_ = glm::transpose(camera.axes());
}

CaptureView::Sample CaptureView::sample(const dvec3& direction) const {
  const std::optional<DiscPoint> point = optics_->locate(toCamera_ * direction);
  if (!point) return {dvec3(0), 0};
  const PhotographDisc::Sample seen = disc_.at(point->position);
  return {gain_ * seen.radiance / point->reflectance, point->weight * seen.coverage};
}

double CaptureView::pixelsOfSphere() const {
  return kPiD * radius_ * radius_ / optics_->shareShown();
}

CaptureView::Sample merged(const std::vector<CaptureView>& views, const dvec3& direction) {
  CaptureView::Sample sum{dvec3(0), 0};
  for (const CaptureView& view : views) {
    const CaptureView::Sample sample = view.sample(direction);
    sum.radiance += sample.weight * sample.radiance;
    sum.weight += sample.weight;
  }
  if (sum.weight > 0) sum.radiance /= sum.weight;
  return sum;
}

namespace {

constexpr ImageSize kSize{720, 360};
constexpr int kLargestShift = int(kLargestTurn * kSize.width / 360);
constexpr double kShownWell = 0.05;     // least weight of a view
constexpr double kLeastOverlap = 0.02;  // of the sphere
constexpr double kLeastCorrelation = 0.5;

// Luminance and weight over a lat-long grid.
struct LuminanceMap {
  std::vector<double> luminance, weight;
  std::vector<double> logarithm;  // of the luminance, above 1/10000 of its mean

  explicit LuminanceMap(const std::function<CaptureView::Sample(const dvec3&)>& sample)
      : luminance(size_t(kSize.width) * kSize.height), weight(luminance.size()) {
    parallelFor(0, kSize.height, [&](int y) {
      for (int x = 0; x < kSize.width; ++x) {
        const CaptureView::Sample seen = sample(texelDirection(kSize, x, y));
        luminance[at(x, y)] = chromeball::luminance(seen.radiance);
        weight[at(x, y)] = seen.weight;
      }
    });
    const double mean = std::accumulate(luminance.begin(), luminance.end(), 0.0) / luminance.size();
    logarithm = luminance;
    for (double& value : logarithm) value = std::log(std::max(value, 1e-4 * mean + 1e-30));
  }

  static size_t at(int x, int y) {
    return size_t(y) * kSize.width + size_t((x + kSize.width) % kSize.width);
  }
};

// The weight of a texel: how well both views show it, times its solid angle; 0 unless both show it
// well.
double commonWeight(double a, double b, int row) {
  const double least = std::min(a, b);
  return least < kShownWell ? 0 : least * texelSolidAngle(row, kSize.width, kSize.height);
}

// Sums for the correlation of two variables.
struct Correlation {
  double weight = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0, solidAngle = 0;

  double value() const {
    if (weight == 0) return 0;
    const double varianceA = aa - a * a / weight, varianceB = bb - b * b / weight;
    const double least = 1e-12 * weight;  // the logarithms of a constant map are rounded
    if (varianceA < least || varianceB < least) return 0;
    return (ab - a * b / weight) / std::sqrt(varianceA * varianceB);
  }
};

// The correlation of `reference` and `view` after a turn by `shift` columns, towards the left of
// the map.
Correlation correlation(const LuminanceMap& reference, const LuminanceMap& view, int shift) {
  Correlation sum;
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const size_t i = LuminanceMap::at(x, y), j = LuminanceMap::at(x + shift, y);
      const double w = commonWeight(reference.weight[i], view.weight[j], y);
      if (w == 0) continue;
      const double a = reference.logarithm[i], b = view.logarithm[j];
      sum.weight += w;
      sum.a += w * a, sum.b += w * b;
      sum.aa += w * a * a, sum.bb += w * b * b, sum.ab += w * a * b;
      sum.solidAngle += texelSolidAngle(y, kSize.width, kSize.height);
    }
  return sum;
}

void findTurn(const LuminanceMap& reference, const LuminanceMap& view, ViewMatch& match) {
  std::vector<double> values(2 * kLargestShift + 1);
  parallelFor(-kLargestShift, kLargestShift + 1, [&](int shift) {
    values[size_t(shift + kLargestShift)] = correlation(reference, view, shift).value();
  });
  const auto best = std::max_element(values.begin(), values.end());
  if (best == values.begin() || best == values.end() - 1 || *best < kLeastCorrelation) return;
  const double before = best[-1], after = best[1], bend = before - 2 * *best + after;
  const double column = double(best - values.begin()) - kLargestShift +
                        (bend < 0 ? 0.5 * (before - after) / bend : 0);
  match.turned = true;
  match.turn = column * 360 / kSize.width;
  match.correlation = *best;
}

void findGain(const LuminanceMap& reference, const LuminanceMap& view, ViewMatch& match) {
  constexpr int kCell = 8;
  struct Ratio {
    double value, weight;
  };
  std::vector<Ratio> ratios;
  for (int top = 0; top < kSize.height; top += kCell)
    for (int left = 0; left < kSize.width; left += kCell) {
      double sumReference = 0, sumView = 0, weight = 0;
      bool isShown = true;
      for (int y = top; isShown && y < top + kCell; ++y)
        for (int x = left; x < left + kCell; ++x) {
          const size_t i = LuminanceMap::at(x, y);
          const double w = commonWeight(reference.weight[i], view.weight[i], y);
          isShown = isShown && w > 0;
          sumReference += reference.luminance[i], sumView += view.luminance[i], weight += w;
        }
      if (isShown && sumReference > 0 && sumView > 0)
        ratios.push_back({sumReference / sumView, weight});
    }
  if (ratios.empty()) return;
  std::sort(ratios.begin(), ratios.end(),
            [](const Ratio& a, const Ratio& b) { return a.value < b.value; });
  double half = 0, sum = 0;
  for (const Ratio& ratio : ratios) half += 0.5 * ratio.weight;
  for (const Ratio& ratio : ratios)
    if ((sum += ratio.weight) >= half) {
      match.gain = ratio.value;
      match.exposed = true;
      return;
    }
}

}  // namespace

std::vector<ViewMatch> matchViews(std::vector<CaptureView>& views, bool exposure, bool rotation) {
  std::vector<ViewMatch> matches(views.size());
  for (size_t k = 1; k < views.size(); ++k) {
    ViewMatch& match = matches[k];
    const auto tabulated = [&] {
      return LuminanceMap([&](const dvec3& d) { return views[k].sample(d); });
    };
    const std::vector<CaptureView> before(views.begin(), views.begin() + ptrdiff_t(k));
    const LuminanceMap reference([&](const dvec3& d) { return merged(before, d); });
    const LuminanceMap view = tabulated();
    const Correlation unturned = correlation(reference, view, 0);
    match.overlap = unturned.solidAngle / (4 * kPiD);
    match.correlation = unturned.value();
    if (match.overlap < kLeastOverlap) continue;
    if (rotation) findTurn(reference, view, match);
    CameraPosition camera = views[k].camera();
    camera.azimuth += match.turn;
    views[k].setCamera(camera);
    if (exposure) findGain(reference, tabulated(), match);
    views[k].setGain(match.gain);
  }
  return matches;
}

}  // namespace chromeball
