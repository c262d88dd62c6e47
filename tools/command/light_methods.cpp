// SPDX-License-Identifier: Apache-2.0
#include "light_methods.h"

#include <algorithm>

#include "base/error.h"
#include "base/suggest.h"
#include "lighting/constellation/constellations.h"
#include "lighting/fit/irradiance_fit.h"
#include "probe/sun_extraction.h"

namespace chromeball {

namespace {

constexpr std::string_view kFit = "irradiance-fit", kSuns = "suns";

std::vector<std::string_view> methodNames() {
  std::vector<std::string_view> names = constellationNames();
  names.push_back(kFit);
  names.push_back(kSuns);
  return names;
}

int fitCount(int count) {
  if (count < 1 || count > kMaxFittedLights)
    throwInput("{}: a count of {} is out of range; give 1 to {}", kFit, count, kMaxFittedLights);
  return count;
}

Constellation sunLights(const Image& latLong, const std::optional<int>& maximum) {
  if (maximum && *maximum < 1)
    throwInput("{}: a count of {} is out of range; give 1 or more", kSuns, *maximum);
  Constellation lights;
  for (const Sun& sun : extractSuns(latLong).suns)
    if (!maximum || lights.size() < size_t(*maximum))
      lights.push_back({vec3(sun.direction), Rgb(sun.irradiance), float(sun.angle)});
  return lights;
}

}  // namespace

std::string lightMethodList() {
  std::string list;
  for (const std::string_view name : methodNames())
    list.append(list.empty() ? "" : ", ").append(name);
  return list;
}

void checkLightMethod(const std::string& name, std::string_view location) {
  const std::vector<std::string_view> names = methodNames();
  if (std::find(names.begin(), names.end(), name) == names.end())
    throwInput("{}: unknown method `{}`; {}", location, name, didYouMean(name, names));
}

void checkLightOptions(const LightOptions& options) {
  if (!options.count && !options.maxError && options.method != kSuns)
    throwInput("--count: should say how many lights");
  if (options.method == kFit) return;
  if (options.ambient) throwInput("--ambient: only {} fits an ambient light", kFit);
  if (options.maxError) throwInput("--max-error: only {} finds its number of lights", kFit);
}

MadeLights makeLights(const Image& latLong, const LightOptions& options) {
  MadeLights made;
  made.rig.method = options.method;
  if (options.method == kSuns) {
    made.rig.lights = sunLights(latLong, options.count);
    return made;
  }
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
