// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/align.h"

#include "base/error.h"
#include "base/parallel.h"
#include "math/cdf.h"
#include "math/icosphere.h"
#include "math/vec.h"
#include "probe/capture/exposure.h"
#include "probe/capture/rotation_fit.h"
#include "probe/mapping.h"

namespace chromeball {
namespace {

using glm::dquat;
using glm::dvec3;

constexpr int kCoarsest = 16, kFinest = 512;  // heights of maps

struct Candidate {
  dquat rotation;
  double correlation = 0;
};

double angleBetween(const dquat& a, const dquat& b) {
  return glm::degrees(2 * std::acos(std::min(std::fabs(glm::dot(a, b)), 1.0)));
}

// Rotations at most 11 degrees apart: all of SO(3).
std::vector<Candidate> grid() {
  constexpr int kSubdivisions = 2, kTurns = 32;
  std::vector<Candidate> rotations;
  for (const vec3& normal : icosphereNormals(kSubdivisions)) {
    const Frame frame(normal);
    const dquat toNormal =
        glm::normalize(glm::quat_cast(glm::dmat3(dvec3(frame.x), dvec3(frame.y), dvec3(frame.z))));
    for (int i = 0; i < kTurns; ++i)
      rotations.push_back({toNormal * glm::angleAxis(2 * kPiD * i / kTurns, dvec3(0, 0, 1))});
  }
  return rotations;
}

// The best rotations that are further apart than `degrees`, at most `count`, best first.
std::vector<Candidate> distinct(std::vector<Candidate> all, double degrees, size_t count) {
  std::ranges::stable_sort(all, std::greater(), &Candidate::correlation);
  std::vector<Candidate> kept;
  for (const Candidate& candidate : all) {
    if (kept.size() == count) break;
    if (std::ranges::all_of(kept, [&](const Candidate& k) {
          return angleBetween(candidate.rotation, k.rotation) > degrees;
        }))
      kept.push_back(candidate);
  }
  return kept;
}

// The power that is not explained, as a fraction.
double residual(double correlation) { return 1 - correlation * std::max(correlation, 0.0); }

// The same for a map and the same map interpolated twice, turned and turned back.
double interpolationResidual(const Image& map) {
  const Rotation turn = Rotation::ofAngles({50, 40, 30});
  const Probe probe(map, turn);
  const Image turned = colorImage(map.width, map.height, [&](int x, int y) {
    return probe.radiance(vec3(texelDirection({map.width, map.height}, x, y)));
  });
  return residual(MapPair(map, turned).correlation(glm::conjugate(turn.quaternion())));
}

// Whether a rotation fits as well as the best one: the likelihood ratio test, with as many
// independent residuals as the sphere has parts in MapPair::standardErrors(). Residuals below
// `least` carry no information: without interpolation, equal maps have none.
bool fitsAsWell(const Candidate& candidate, const Candidate& best, double least) {
  constexpr double kResiduals = 80;
  constexpr double kChiSquare = 16.27;  // of three degrees of freedom: exceeded in 0.1% of cases
  const double ratio = std::max(residual(candidate.correlation), least) /
                       std::max(residual(best.correlation), least);
  return kResiduals * std::log(ratio) <= kChiSquare;
}

// The rotations refined with these maps, without the ones that fit worse, best first.
std::vector<Candidate> refined(const MapPair& maps, std::vector<Candidate> candidates, int height,
                               double leastResidual) {
  parallelFor(size_t(0), candidates.size(), [&](size_t i) {
    candidates[i].rotation = maps.refined(candidates[i].rotation);
    candidates[i].correlation = maps.correlation(candidates[i].rotation);
  });
  const size_t most = candidates.size();
  candidates = distinct(std::move(candidates), 180.0 / height, most);
  std::erase_if(candidates, [&, best = candidates.front()](const Candidate& candidate) {
    return !fitsAsWell(candidate, best, leastResidual);
  });
  return candidates;
}

std::vector<Candidate> search(const MapPair& maps) {
  constexpr size_t kCount = 64;
  constexpr double kApart = 15;  // degrees
  std::vector<Candidate> candidates = grid();
  parallelFor(size_t(0), candidates.size(), [&](size_t i) {
    candidates[i].correlation = maps.correlation(candidates[i].rotation);
  });
  return distinct(std::move(candidates), kApart, kCount);
}

// The axis about which all rotations differ from the first, if there is one.
std::optional<dvec3> commonAxis(const std::vector<Candidate>& candidates) {
  constexpr double kParallel = 0.985;  // cosine of 10 degrees
  if (candidates.size() < 3) return {};
  std::optional<dvec3> first;
  dvec3 sum(0);
  for (size_t i = 1; i < candidates.size(); ++i) {
    const dquat turn = candidates[i].rotation * glm::conjugate(candidates[0].rotation);
    dvec3 axis = glm::normalize(dvec3(turn.x, turn.y, turn.z));
    if (!first) first = axis;
    if (glm::dot(axis, *first) < 0) axis = -axis;
    if (glm::dot(axis, *first) < kParallel) return {};
    sum += axis;
  }
  return glm::normalize(sum);
}

void checkVaries(const Image& logMap, std::string_view name) {
  constexpr float kLeast = 1e-4f;  // a range of logarithms, so a fraction of the radiance
  const auto [least, greatest] = std::ranges::minmax(logMap.texels);
  if (!(greatest - least > kLeast))
    throwInput("{}: has the same radiance in all directions, so no rotation can be found", name);
}

// The heights of the levels: doubled from the coarsest up to the height of the coarser map.
std::vector<int> heights(const Image& a, const Image& b) {
  const int finest = std::clamp(std::min(a.height, b.height), kCoarsest, kFinest);
  std::vector<int> all;
  for (int height = kCoarsest; height < finest; height *= 2) all.push_back(height);
  all.push_back(finest);
  return all;
}

ProbeFit fitOf(const Candidate& candidate) {
  return {Rotation::ofQuaternion(candidate.rotation), candidate.correlation};
}

constexpr int kScales = 6;  // shifts of 2^kScales - 1 pixels

Image greenOf(const Image& image) {
  Image green(image.width, image.height, 1);
  for (size_t i = 0; i < green.texels.size(); ++i) {
    const float level = image.texels[3 * i + 1];
    green.texels[i] = level > 0 ? std::min(level, 1.0f) : 0;  // NaN is 0
  }
  return green;
}

// The fractions of the pixels that are too dark to tell apart, and that are not saturated.
struct Percentiles {
  double low, high;
};
Percentiles percentilesShown(const Image& green) {
  constexpr float kDark = 5 / 255.f;
  const auto& texels = green.texels;
  const auto dark = std::ranges::count_if(texels, [](float level) { return level <= kDark; });
  const auto shown = std::ranges::count_if(texels, [](float level) { return level < kSaturated; });
  return {double(dark) / double(texels.size()), double(shown) / double(texels.size())};
}

// The image at half its size: means of 2 x 2 pixels.
Image halved(const Image& image) {
  Image half(image.width / 2, image.height / 2, 1);
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x)
      *half.at(x, y) = (*image.at(2 * x, 2 * y) + *image.at(2 * x + 1, 2 * y) +
                        *image.at(2 * x, 2 * y + 1) + *image.at(2 * x + 1, 2 * y + 1)) /
                       4;
  return half;
}

// 1 above the percentile, -1 below it, 0 too close to it to tell.
struct Bitmap {
  int width, height;
  std::vector<int8_t> sides;

  Bitmap(const Image& image, double percentile)
      : width(image.width), height(image.height), sides(image.texels.size()) {
    constexpr float kTooClose = 0.04f;
    const float threshold = quantile(image.texels, percentile);
    for (size_t i = 0; i < sides.size(); ++i) {
      const float level = image.texels[i];
      sides[i] = level > (1 + kTooClose) * threshold   ? 1
                 : level < (1 - kTooClose) * threshold ? -1
                                                       : 0;
    }
  }
};

// The fraction of the pixels on different sides; 1 if none can be compared.
double mismatch(const Bitmap& a, const Bitmap& b, int dx, int dy) {
  size_t compared = 0, different = 0;
  for (int y = std::max(0, -dy); y < std::min(a.height, b.height - dy); ++y)
    for (int x = std::max(0, -dx); x < std::min(a.width, b.width - dx); ++x) {
      const int product =
          a.sides[size_t(y) * a.width + x] * b.sides[size_t(y + dy) * b.width + (x + dx)];
      compared += product != 0;
      different += product < 0;
    }
  return compared > 0 ? double(different) / double(compared) : 1;
}

Shift shiftBetween(const Image& a, const Image& b, double percentile, int scales) {
  constexpr int kLeastSide = 16;
  Shift start;
  if (scales > 1 && std::min(a.width, a.height) >= 2 * kLeastSide)
    start = shiftBetween(halved(a), halved(b), percentile, scales - 1);
  const Bitmap from(a, percentile), to(b, percentile);
  Shift best;
  best.mismatch = best.mismatchShifted = mismatch(from, to, 0, 0);
  for (int dy = 2 * start.dy - 1; dy <= 2 * start.dy + 1; ++dy)
    for (int dx = 2 * start.dx - 1; dx <= 2 * start.dx + 1; ++dx)
      if (const double found = mismatch(from, to, dx, dy); found < best.mismatchShifted)
        best.dx = dx, best.dy = dy, best.mismatchShifted = found;
  return best;
}

}  // namespace

ProbeAlignment alignProbes(const Image& first, const Image& second, std::string_view firstName,
                           std::string_view secondName) {
  const LogMaps firstMaps(first), secondMaps(second);
  std::vector<Candidate> candidates;
  dvec3 errors(0);
  for (const int height : heights(first, second)) {
    const Image a = firstMaps.map(height), b = secondMaps.map(height);
    if (candidates.empty()) checkVaries(a, firstName), checkVaries(b, secondName);
    const MapPair maps(a, b);
    if (candidates.empty()) candidates = search(maps);
    const double least = std::max(interpolationResidual(a), interpolationResidual(b));
    candidates = refined(maps, std::move(candidates), height, least);
    errors = maps.standardErrors(candidates.front().rotation);
  }
  ProbeAlignment alignment{fitOf(candidates.front()), glm::degrees(errors), {}, {}};
  for (size_t i = 1; i < candidates.size(); ++i) alignment.others.push_back(fitOf(candidates[i]));
  alignment.axis = commonAxis(candidates);
  return alignment;
}

bool Shift::isCertain() const {
  constexpr double kLeast = 0.005;
  return dx * dx + dy * dy >= 4 && mismatch > kLeast && mismatchShifted < mismatch / 2;
}

Shift findShift(const Image& from, const Image& to) {
  const Image a = greenOf(from), b = greenOf(to);
  const Percentiles shownA = percentilesShown(a), shownB = percentilesShown(b);
  const double low = std::max(shownA.low, shownB.low), high = std::min(shownA.high, shownB.high);
  return low < high ? shiftBetween(a, b, (low + high) / 2, kScales) : Shift{};
}

}  // namespace chromeball
