// SPDX-License-Identifier: Apache-2.0
#include "lighting/fit/irradiance_fit.h"

#include "base/error.h"
#include "base/parallel.h"
#include "lighting/fit/light_descent.h"
#include "math/icosphere.h"
#include "probe/irradiance.h"
#include "probe/mapping.h"

namespace chromeball {
namespace {

// Rows of the probe's merged points. Twice as many take four times as long, and reduce the error of
// 64 lights by 3% and of 128 lights by 14% (Galileo's tomb). Few rows suffice to rank arrangements.
constexpr int kPointRows = 64, kRoughPointRows = 16;

// Few lights converge to a poor local minimum more often than many: for five lights in Galileo's
// tomb the best arrangement has 20% less error than the best one found by adding a light to the
// best four. So up to kFewLights a beam search keeps the best arrangements of each number, and
// tries several directions for the next light of each.
constexpr int kFewLights = 16;
constexpr int kArrangements = 16, kCandidates = 6;
constexpr int kStepsToTry = 10, kStepsToConverge = 90;
constexpr double kSame = 1e-8;  // relative difference of misfit below which arrangements are equal

constexpr double kMaxCosine = 0.9;    // between candidate directions for the next light
constexpr double kNegligible = 1e-6;  // product of a light with the residual, over mean radiance

// Directions in which lights may be added, and the products of their patterns with the probe.
class Candidates {
 public:
  explicit Candidates(const RadiancePoints& probe) {
    for (const vec3& normal : icosphereNormals(3)) directions_.push_back(normalize(dvec3(normal)));
    products_.resize(directions_.size());
    parallelFor(size_t(0), directions_.size(),
                [&](size_t i) { products_[i] = probe.productWith(directions_[i]).product; });
  }

  // At most `count` directions in which one more light reduces the misfit most, the best first.
  // None if no light reduces it.
  std::vector<dvec3> best(const FittedLights& lights, int count) const {
    std::vector<double> gains(directions_.size());
    parallelFor(size_t(0), directions_.size(), [&](size_t i) {
      const dvec3 missing = max(residualProduct(i, lights), dvec3(0));
      gains[i] = dot(missing, missing);
    });
    std::vector<dvec3> best;
    while (int(best.size()) < count) {
      const auto peak = std::max_element(gains.begin(), gains.end());
      if (*peak <= kNegligible * kNegligible) break;
      best.push_back(directions_[peak - gains.begin()]);
      for (size_t i = 0; i < gains.size(); ++i)
        if (dot(directions_[i], best.back()) > kMaxCosine) gains[i] = 0;
    }
    return best;
  }

 private:
  // The product of candidate i with the residual: the probe minus the lights.
  dvec3 residualProduct(size_t i, const FittedLights& lights) const {
    dvec3 product = products_[i] - kAmbientTimesLight * lights.ambient;
    for (size_t j = 0; j < lights.directions.size(); ++j)
      product -= CosinePair(directions_[i], lights.directions[j]).product() * lights.irradiances[j];
    return product;
  }

  std::vector<dvec3> directions_, products_;
};

void removeBlack(FittedLights& lights) {
  for (size_t i = lights.directions.size(); i-- > 0;)
    if (lights.irradiances[i] == dvec3(0)) {
      lights.directions.erase(lights.directions.begin() + i);
      lights.irradiances.erase(lights.irradiances.begin() + i);
    }
}

// A beam search that adds one light at a time.
class Search {
 public:
  Search(const Image& latLong, double scale, bool ambient)
      : probe_(latLong, kPointRows, scale),
        rough_(latLong, kRoughPointRows, scale),
        candidates_(probe_),
        ambient_(ambient) {
    FittedLights none;
    solveColors(none, probe_, ambient);
    best_ = {none};
  }

  const std::vector<FittedLights>& best() const { return best_; }

  // Adds a light to each arrangement and keeps the best. Without candidates nothing changes.
  void grow() {
    const bool few = int(best_.front().directions.size()) < kFewLights;
    if (!few) best_.resize(1);
    std::vector<FittedLights> tried;
    for (const FittedLights& lights : best_)
      for (const dvec3& direction : candidates_.best(lights, few ? kCandidates : 1)) {
        tried.push_back(lights);
        tried.back().directions.push_back(direction);
        tried.back().irradiances.emplace_back(0);
      }
    if (tried.empty()) return;
    if (few) {
      descendAll(tried, rough_, kStepsToTry);
      keepBest(tried);
      descendAll(tried, rough_, kStepsToConverge);
    }
    descendAll(tried, probe_, kStepsToTry);
    keepBest(tried);
    for (FittedLights& lights : tried) removeBlack(lights);
    best_ = std::move(tried);
  }

 private:
  void descendAll(std::vector<FittedLights>& all, const RadiancePoints& probe, int steps) const {
    parallelFor(size_t(0), all.size(), [&](size_t i) { descend(all[i], probe, ambient_, steps); });
  }

  static void keepBest(std::vector<FittedLights>& all) {
    std::sort(all.begin(), all.end(),
              [](const FittedLights& a, const FittedLights& b) { return a.misfit < b.misfit; });
    const auto same = [](const FittedLights& a, const FittedLights& b) {
      return b.misfit - a.misfit <= kSame * std::fabs(a.misfit);
    };
    all.erase(std::unique(all.begin(), all.end(), same), all.end());
    if (int(all.size()) > kArrangements) all.resize(kArrangements);
  }

  RadiancePoints probe_, rough_;
  Candidates candidates_;
  bool ambient_;
  std::vector<FittedLights> best_;
};

}  // namespace

IrradianceFit fitIrradiance(const Image& latLong, const FitOptions& options) {
  const int limit = options.maxErrorPercent ? options.maxCount : options.count;
  if (limit < 0) throwInput("a fit of {} lights: the number must not be negative", limit);
  const dvec3 mean = meanRadiance(latLong);
  // The scale of a black probe is arbitrary.
  const double level = mean == dvec3(0) ? 1 : (mean.x + mean.y + mean.z) / 3;
  const std::vector<vec3> normals = icosphereNormals(5);
  const std::vector<dvec3> irradiance = exactIrradiance(latLong, normals);
  // Lights that were fitted to the probe divided by `level`, and their error.
  const auto measured = [&](const FittedLights& lights) {
    IrradianceFit fit;
    for (size_t i = 0; i < lights.directions.size(); ++i)
      fit.lights.push_back({vec3(lights.directions[i]), Rgb(lights.irradiances[i] * level)});
    fit.ambient = Rgb(lights.ambient * level);
    const LightError error = lightError(irradianceOf(fit.lights, fit.ambient, normals), irradiance);
    fit.meanError = error.mean;
    fit.maxError = error.max;
    return fit;
  };

  Search search(latLong, 1 / level, options.ambient);
  IrradianceFit best = measured(search.best().front());
  int count = 0;
  while (count < limit &&
         !(options.maxErrorPercent && best.meanError <= *options.maxErrorPercent)) {
    ++count;
    search.grow();
    for (const FittedLights& lights : search.best()) {
      IrradianceFit fit = measured(lights);
      if (fit.meanError < best.meanError) best = std::move(fit);
    }
  }
  return best;
}

}  // namespace chromeball
