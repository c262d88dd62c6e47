#include "lighting/irradiance_fit.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "lighting/cosine_pattern.h"
#include "lighting/light_descent.h"
#include "lighting/light_error.h"
#include "lighting/radiance_points.h"
#include "math/error.h"
#include "probe/icosphere.h"
#include "probe/irradiance.h"
#include "probe/solid_angle.h"

namespace chromeball {
namespace {

// Of the probe's merged points. Twice as many cost four times as much, and take a thirtieth off the
// error of 64 lights and a seventh off that of 128 (Galileo's tomb).
constexpr int kPointRows = 64;

// Few lights get stuck in a poor arrangement more easily than many. Up to here several places are
// tried for each new light, and from the best of them all lights move until they rest.
constexpr int kFewLights = 16;
constexpr int kPlacesForFew = 12;
constexpr int kStepsToTry = 10, kStepsToRest = 90;

constexpr double kApart = 0.9;        // cosine of the least angle between places that are tried
constexpr double kNegligible = 1e-6;  // of the probe's product with a light, relative to its mean

// Where lights may be added, and what a light there has in common with the probe.
class Places {
 public:
  explicit Places(const RadiancePoints& probe) {
    for (const vec3& normal : icosphereNormals(3)) directions_.push_back(normalize(dvec3(normal)));
    products_.resize(directions_.size());
    tbb::parallel_for(size_t(0), directions_.size(),
                      [&](size_t i) { products_[i] = probe.productWith(directions_[i]).product; });
  }

  // At most `count` places where one more light would help most, the best first; none where none
  // helps, and then no further light can help but by replacing others.
  std::vector<dvec3> best(const FittedLights& lights, int count) const {
    std::vector<double> gains(directions_.size());
    tbb::parallel_for(size_t(0), directions_.size(), [&](size_t i) {
      const dvec3 wanting = max(residualProduct(i, lights), dvec3(0));
      gains[i] = dot(wanting, wanting);
    });
    std::vector<dvec3> places;
    while (int(places.size()) < count) {
      const auto peak = std::max_element(gains.begin(), gains.end());
      if (*peak <= kNegligible * kNegligible) break;
      places.push_back(directions_[peak - gains.begin()]);
      for (size_t i = 0; i < gains.size(); ++i)
        if (dot(directions_[i], places.back()) > kApart) gains[i] = 0;
    }
    return places;
  }

 private:
  // Of a light at place i with what the lights leave of the probe.
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

// The best of the fits with one more light, black ones removed. Where no place promises anything,
// `lights` themselves.
FittedLights withOneMore(const FittedLights& lights, const RadiancePoints& probe,
                         const Places& places, bool ambient) {
  const bool few = int(lights.directions.size()) < kFewLights;
  const std::vector<dvec3> tried = places.best(lights, few ? kPlacesForFew : 1);
  std::vector<FittedLights> fits(tried.size(), lights);
  tbb::parallel_for(size_t(0), tried.size(), [&](size_t i) {
    fits[i].directions.push_back(tried[i]);
    fits[i].irradiances.emplace_back(0);
    descend(fits[i], probe, ambient, kStepsToTry);
  });
  const auto best = std::min_element(
      fits.begin(), fits.end(),
      [](const FittedLights& a, const FittedLights& b) { return a.misfit < b.misfit; });
  if (best == fits.end()) return lights;
  if (few) descend(*best, probe, ambient, kStepsToRest);
  removeBlack(*best);
  return *best;
}

// The probe as what fits are measured by.
class Measure {
 public:
  explicit Measure(const Image& latLong)
      : normals_(icosphereNormals(5)), irradiance_(exactIrradiance(latLong, normals_)) {}

  // `lights` were fitted to the probe divided by `level`.
  IrradianceFit operator()(const FittedLights& lights, double level) const {
    IrradianceFit fit;
    for (size_t i = 0; i < lights.directions.size(); ++i)
      fit.lights.push_back({vec3(lights.directions[i]), Rgb(lights.irradiances[i] * level)});
    fit.ambient = Rgb(lights.ambient * level);
    const LightError error =
        lightError(irradianceOf(fit.lights, fit.ambient, normals_), irradiance_);
    fit.meanError = error.mean;
    fit.maxError = error.max;
    return fit;
  }

 private:
  std::vector<vec3> normals_;
  std::vector<dvec3> irradiance_;
};

}  // namespace

IrradianceFit fitIrradiance(const Image& latLong, const FitOptions& options) {
  const int limit = options.maxErrorPercent ? options.maxCount : options.count;
  if (limit < 0) throwInput("a fit of {} lights: the number must not be negative", limit);
  const dvec3 mean = meanRadiance(latLong);
  // Of a black probe every scale is as good.
  const double level = mean == dvec3(0) ? 1 : (mean.x + mean.y + mean.z) / 3;
  const RadiancePoints probe(latLong, kPointRows, 1 / level);
  const Places places(probe);
  const Measure measure(latLong);

  FittedLights lights;
  solveColors(lights, probe, options.ambient);
  IrradianceFit best = measure(lights, level);
  int count = 0;
  while (count < limit &&
         !(options.maxErrorPercent && best.meanError <= *options.maxErrorPercent)) {
    ++count;
    lights = withOneMore(lights, probe, places, options.ambient);
    IrradianceFit fit = measure(lights, level);
    if (fit.meanError < best.meanError) best = std::move(fit);
  }
  best.lights.resize(count, {vec3(0, 1, 0), Rgb(0)});
  return best;
}

}  // namespace chromeball
