#include "light_methods.h"

#include <algorithm>

#include "lighting/constellations.h"
#include "lighting/irradiance_fit.h"
#include "math/error.h"
#include "math/suggest.h"

namespace chromeball {

namespace {

constexpr std::string_view kFit = "irradiance-fit";

std::vector<std::string_view> methodNames() {
  std::vector<std::string_view> names = constellationNames();
  names.push_back(kFit);
  return names;
}

int fitCount(int count) {
  constexpr int kMost = 1024;
  if (count < 1 || count > kMost)
    throwInput("{}: a count of {} is out of range; give 1 to {}", kFit, count, kMost);
  return count;
}

}  // namespace

std::string lightMethodList() {
  std::string list;
  for (const std::string_view name : methodNames())
    list.append(list.empty() ? "" : ", ").append(name);
  return list;
}

void checkLightMethod(const std::string& name, std::string_view place) {
  const std::vector<std::string_view> names = methodNames();
  if (std::find(names.begin(), names.end(), name) == names.end())
    throwInput("{}: unknown method `{}`; {}", place, name, didYouMean(name, names));
}

void checkLightOptions(const LightOptions& options) {
  if (!options.count && !options.maxError) throwInput("--count: should say how many lights");
  if (options.method == kFit) return;
  if (options.ambient) throwInput("--ambient: only {} fits an ambient light", kFit);
  if (options.maxError) throwInput("--max-error: only {} finds its number of lights", kFit);
}

MadeLights makeLights(const Image& latLong, const LightOptions& options) {
  MadeLights made;
  made.rig.method = options.method;
  if (options.method != kFit) {
    made.rig.lights = makeConstellation(options.method, latLong, *options.count, options.seed);
    return made;
  }
  FitOptions fitOptions{.ambient = options.ambient, .maxErrorPercent = options.maxError};
  if (options.count) fitOptions.count = fitOptions.maxCount = fitCount(*options.count);
  const IrradianceFit fit = fitIrradiance(latLong, fitOptions);
  made.rig.lights = fit.lights;
  if (options.ambient) made.rig.ambient = fit.ambient;
  made.meanError = fit.meanError;
  return made;
}

}  // namespace chromeball
