// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/find_circle.h"

#include <array>
#include <limits>
#include <vector>

#include "probe/capture/rim_arc.h"

namespace chromeball {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kReach = 2.4;       // of the search around the start, in pixels
constexpr double kOffsetStep = 0.2;  // between the sampled offsets of arcs
constexpr int kOffsets = 12;         // on each side
constexpr int kTwelfths = 12;

// Minus the logarithm of an arc's likelihood, above its least, as a function of the offset of the
// outline.
struct ArcProfile {
  dvec2 normal;
  int twelfth;   // of the outline
  double least;  // minus the logarithm of the largest likelihood
  std::array<double, 2 * kOffsets + 1> doubts;

  // Interpolates between the samples by Catmull and Rom's cubic.
  double at(double offset) const {
    const double position = std::clamp(offset / kOffsetStep + kOffsets, 0.0, 2.0 * kOffsets - 1e-9);
    const int i = int(position);
    const double t = position - i;
    const auto sample = [&](int k) { return doubts[size_t(std::clamp(k, 0, 2 * kOffsets))]; };
    const double p0 = sample(i - 1), p1 = sample(i), p2 = sample(i + 1), p3 = sample(i + 2);
    return p1 + 0.5 * t *
                    (p2 - p0 + t * (2 * p0 - 5 * p1 + 4 * p2 - p3 + t * (3 * (p1 - p2) + p3 - p0)));
  }
  double likeliestOffset() const {
    return double(std::ranges::min_element(doubts) - doubts.begin() - kOffsets) * kOffsetStep;
  }
};

using ArcProfiles = std::vector<ArcProfile>;

// The profiles of every `stride`th arc that the picture shows.
ArcProfiles profilesAround(const Image& image, const Circle& circle, const RimModel& model,
                           int stride) {
  constexpr double kArcLength = 10, kLeastShown = 0.8;
  const int count = std::clamp(int(2 * kPiD * circle.radius / kArcLength), 24, 120);
  const double halfAngle = std::min(kPiD / count, 0.5 * kArcLength / circle.radius);
  const double area = 4 * halfAngle * circle.radius * (RimArc::kRimDepth + kReach);
  ArcProfiles profiles;
  for (int i = 0; i < count; i += stride) {
    const RimArc arc(image, circle, 2 * kPiD * (i + 0.5) / count, halfAngle, kReach);
    if (double(arc.pixels()) < kLeastShown * area) continue;
    ArcProfile profile{arc.normal(), i * kTwelfths / count, 0, {}};
    for (int k = -kOffsets; k <= kOffsets; ++k)
      profile.doubts[size_t(k + kOffsets)] = arc.doubt(model, k * kOffsetStep);
    profile.least = *std::ranges::min_element(profile.doubts);
    if (!std::isfinite(profile.least)) continue;
    for (double& doubt : profile.doubts) doubt -= profile.least;
    profiles.push_back(profile);
  }
  return profiles;
}

// How well arcs fit a circle that is changed by (x, y, radius), in pixels. The pixels of an arc
// have no independent errors, since the errors are the model's: they count as fewer pixels.
class OutlineDoubt {
 public:
  // `bound`: the largest doubt of one arc. `withoutTwelfth`: the twelfth of the outline to leave
  // out, -1 for none.
  OutlineDoubt(const ArcProfiles& profiles, double bound, double pixelsForOne,
               int withoutTwelfth = -1)
      : profiles_(profiles),
        bound_(bound),
        pixelsForOne_(pixelsForOne),
        withoutTwelfth_(withoutTwelfth) {}

  double at(const dvec3& change) const {
    double sum = 0;
    for (const ArcProfile& arc : profiles_) {
      if (arc.twelfth == withoutTwelfth_) continue;
      const double doubt =
          std::max(arc.at(glm::dot(change, dvec3(arc.normal, 1))), 0.0) / pixelsForOne_;
      sum += std::isfinite(doubt) ? bound_ * doubt / (bound_ + doubt) : bound_;
    }
    return sum;
  }

  // The least on a grid over the reach.
  dvec3 likeliest() const {
    constexpr int kHalf = 6;
    return likeliestNear(dvec3(0), kReach / kHalf, kHalf);
  }

  // Descends from `change`, by ever smaller steps.
  dvec3 descend(dvec3 change) const {
    constexpr double kLeastStep = 0.01;
    for (double step = 0.1; step > kLeastStep;) {
      const dvec3 next = likeliestNear(change, step, 1);
      if (next == change) step /= 2;
      change = next;
    }
    return change;
  }

 private:
  dvec3 likeliestNear(const dvec3& middle, double step, int half) const {
    dvec3 best = middle;
    double least = at(middle);
    for (int r = -half; r <= half; ++r)
      for (int y = -half; y <= half; ++y)
        for (int x = -half; x <= half; ++x) {
          const dvec3 change = middle + step * dvec3(x, y, r);
          const double here = at(change);
          if (here < least) least = here, best = change;
        }
    return best;
  }

  const ArcProfiles& profiles_;
  double bound_, pixelsForOne_;
  int withoutTwelfth_;
};

double likeliestBlur(const Image& image, const Circle& start) {
  constexpr int kStride = 3;
  constexpr double kBound = 10;
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (const double blur : {0.0, 0.35, 0.5, 0.7, 0.85, 1.0, 1.2, 1.5}) {
    const ArcProfiles profiles = profilesAround(image, start, {.blur = blur}, kStride);
    const OutlineDoubt doubt(profiles, kBound, 1);
    double sum = doubt.at(doubt.likeliest());
    for (const ArcProfile& arc : profiles) sum += arc.least;
    if (sum < least) least = sum, best = blur;
  }
  return best;
}

// The part of the arcs' deviations from a circle that repeats 3 to 24 times around it, as a
// polygon's do: its amplitude in pixels, and its share of their mean square. Only arcs whose
// position is clear count.
struct Ripple {
  double amplitude = 0, share = 0;
};

Ripple rippleOf(const ArcProfiles& profiles, const dvec3& change) {
  constexpr double kClear = 15;
  constexpr int kFewest = 3, kMost = 24;
  std::vector<std::pair<double, double>> deviations;  // at angles
  double mean = 0, meanSquare = 0;
  for (const ArcProfile& arc : profiles) {
    if (!(*std::ranges::max_element(arc.doubts) > kClear)) continue;
    const double error = arc.likeliestOffset() - glm::dot(change, dvec3(arc.normal, 1));
    deviations.emplace_back(std::atan2(arc.normal.y, arc.normal.x), error);
    mean += error;
  }
  const double count = double(deviations.size());
  mean /= std::max(count, 1.0);
  for (auto& [angle, error] : deviations) error -= mean, meanSquare += error * error / count;
  Ripple best;
  for (int n = kFewest; n <= std::min(kMost, int(count / 3)); ++n) {
    double cc = 0, cs = 0, ss = 0, c = 0, s = 0;
    for (const auto& [angle, error] : deviations) {
      const double x = std::cos(n * angle), y = std::sin(n * angle);
      cc += x * x, cs += x * y, ss += y * y, c += x * error, s += y * error;
    }
    const double determinant = cc * ss - cs * cs;
    if (!(determinant > 0.01 * cc * ss)) continue;
    const double a = (ss * c - cs * s) / determinant, b = (cc * s - cs * c) / determinant;
    const double share = (a * c + b * s) / (count * std::max(meanSquare, 1e-12));
    if (share > best.share) best = {std::hypot(a, b), share};
  }
  return best;
}

struct ModelFit {
  dvec3 change;
  double standardError;  // of the jackknife
  double doubt;          // minus the logarithm of the likelihood of an arc, on average
  double support, contradiction;
  Ripple ripple;
};

ModelFit fitProfiles(const ArcProfiles& profiles, double radius) {
  // The wide bound finds the outline where edges are so sharp that the grid misses their minima.
  constexpr double kWideBound = 30, kBound = 3, kPixelsForOne = 20, kNear = 0.5;
  constexpr double kClear = 15, kLeastApart = 0.8, kApart = 0.01;
  const OutlineDoubt wide(profiles, kWideBound, kPixelsForOne);
  const OutlineDoubt doubt(profiles, kBound, kPixelsForOne);
  ModelFit fit{doubt.descend(wide.descend(wide.likeliest())), 0, 0, 0, 0, {}};
  const double apart = std::max(kLeastApart, kApart * radius);

  std::array<dvec3, kTwelfths> without;
  dvec3 mean(0), squares(0);
  for (int i = 0; i < kTwelfths; ++i) {
    without[size_t(i)] = OutlineDoubt(profiles, kBound, kPixelsForOne, i).descend(fit.change);
    mean += without[size_t(i)] / double(kTwelfths);
  }
  for (const dvec3& change : without) squares += (change - mean) * (change - mean);
  const double largest = std::max({squares.x, squares.y, squares.z});
  fit.standardError = std::sqrt(largest * (kTwelfths - 1) / kTwelfths);

  for (const ArcProfile& arc : profiles) {
    const double offset = glm::dot(fit.change, dvec3(arc.normal, 1));
    fit.doubt += (arc.least + arc.at(offset)) / double(profiles.size());
    const double error = std::fabs(arc.likeliestOffset() - offset);
    fit.support += (error < kNear) / double(profiles.size());
    fit.contradiction += (error > apart && arc.at(offset) > kClear) / double(profiles.size());
  }
  fit.ripple = rippleOf(profiles, fit.change);
  return fit;
}

// Where the rim continues the background, it is found further outside by a model without a step
// there. How much likelier a step is for each arc decides how much that counts.
std::optional<Outline> fitVariances(const Image& image, const Circle& start, RimModel model) {
  constexpr size_t kLeastArcs = 8;
  constexpr double kJackknife = 1.5, kLeastError = 0.03, kEvidence = 50, kEvidenceWidth = 5;
  const ArcProfiles profiles = profilesAround(image, start, model, 1);
  if (profiles.size() < kLeastArcs) return std::nullopt;
  const ModelFit step = fitProfiles(profiles, start.radius);
  model.isContinuous = true;
  const ModelFit smooth = fitProfiles(profilesAround(image, start, model, 1), start.radius);

  const double evidence = (smooth.doubt - step.doubt - kEvidence) / kEvidenceWidth;
  const double share = 1 / (1 + std::exp(std::clamp(evidence, -100.0, 100.0)));
  const dvec3 change = glm::mix(step.change, smooth.change, 0.25 * share);
  const dvec3 apart = glm::abs(step.change - smooth.change);
  const double ofModel = 0.5 * share * std::max({apart.x, apart.y, apart.z});
  return Outline{{start.centre + dvec2(change), start.radius + change.z},
                 glm::length(dvec3(kJackknife * step.standardError, ofModel, kLeastError)),
                 step.support,
                 step.contradiction,
                 step.ripple.amplitude,
                 step.ripple.share};
}

}  // namespace

// A side without noise may fit so well that all pixels with an error, as those that the outline
// cuts where a program fills whole pixels, count for the other side: then the outline with one
// variance, which as many arcs support, is another one.
std::optional<Outline> fitOutline(const Image& image, const Circle& start) {
  constexpr double kMoreSupport = 0.05, kApart = 0.3;
  const double blur = likeliestBlur(image, start);
  const auto two = fitVariances(image, start, {.blur = blur});
  const auto one = fitVariances(image, start, {.blur = blur, .hasOneVariance = true});
  if (!one || !two) return two;
  const bool isOther = std::fabs(one->circle.radius - two->circle.radius) > kApart;
  const bool isBetter =
      isOther ? one->support >= two->support : one->support > two->support + kMoreSupport;
  return isBetter ? one : two;
}

}  // namespace chromeball
