// SPDX-License-Identifier: Apache-2.0
#include "lighting/methods.h"

#include <fmt/format.h>

#include <limits>

#include "base/error.h"
#include "base/text.h"
#include "lighting/area_lights.h"
#include "lighting/delta_lights.h"
#include "lighting/fit/irradiance_fit.h"
#include "lighting/importance.h"
#include "lighting/probe_light.h"
#include "lighting/product.h"
#include "lighting/strata.h"
#include "lighting/suns.h"
#include "probe/sun_extraction.h"

namespace chromeball {
namespace {

using Lights = LightingMethod::Lights;
using Strategy = std::unique_ptr<LightSource>;

constexpr int kMaxLevels = 12;  // of median cut: 4096 regions
constexpr int kUnlimited = std::numeric_limits<int>::max();

template <class Sampler>
Strategy sampling(const Probe& probe, const StrategyOptions&, int) {
  return std::make_unique<Sampler>(probe);
}

// The sampler with MIS compensation if MIS is on.
template <class Sampler>
Strategy compensated(const Probe& probe, const StrategyOptions& options, int) {
  return std::make_unique<Sampler>(probe, options.mis != Mis::Off);
}

Strategy suns(const Probe& probe, const StrategyOptions& options, int) {
  return std::make_unique<Suns>(probe, options.mis != Mis::Off, options.sunAngle);
}

Strategy strata(const Probe& probe, const StrategyOptions&, int count) {
  return std::make_unique<Strata>(probe, count);
}

// A method whose strategy replaces the probe by its lights, made with seed 0.
LightingMethod replacing(std::string_view name, std::string_view summary, std::string_view source,
                         const Lights& lights) {
  const auto makeStrategy = [make = lights.make](const Probe& probe, const StrategyOptions& options,
                                                 int count) -> Strategy {
    const MadeLights made = make(probe.latLong(), {.count = count});
    const Rgb ambient = made.ambient.value_or(Rgb(0));
    auto strategy = std::make_unique<DeltaLights>(probe, made.lights, ambient);
    if (!options.showLights) return strategy;
    return std::make_unique<ShownLights>(std::move(strategy),
                                         shownLights(made.lights, probe.rotation()), ambient);
  };
  return {name, summary, source, lights.counts, makeStrategy, false, true, lights};
}

using Areas = std::unique_ptr<const LightAreas>;

Areas asRegions(RegionAreas&& regions) { return std::make_unique<RegionAreas>(std::move(regions)); }
Areas asDiscs(RegionAreas&& regions) { return std::make_unique<DiscAreas>(regions.lights()); }

// A method whose strategy replaces the probe by area lights, for the regions of `lights`.
LightingMethod replacing(std::string_view name, std::string_view summary, std::string_view source,
                         const Lights& lights, Areas (*shape)(RegionAreas&&)) {
  const auto makeStrategy = [regions = lights.regions, shape](const Probe& probe,
                                                              const StrategyOptions& options,
                                                              int count) -> Strategy {
    const Image map = probe.latLong();
    Areas areas = shape({map, regions(map, {.count = count}).partition, probe.rotation()});
    std::vector<AreaLight> all = areas->lights();
    auto strategy = std::make_unique<AreaLights>(probe, std::move(areas));
    if (!options.showLights) return strategy;
    return std::make_unique<ShownLights>(std::move(strategy), std::move(all));
  };
  return {name, summary, source, lights.counts, makeStrategy, false, true, {}};
}

MadeLights fitLights(const Image& latLong, const LightRequest& request) {
  FitOptions options{.ambient = request.ambient, .maxErrorPercent = request.maxErrorPercent};
  if (request.count) options.count = options.maxCount = *request.count;
  const IrradianceFit fit = fitIrradiance(latLong, options);
  MadeLights made{fit.lights, {}, fit.meanError};
  if (request.ambient) made.ambient = fit.ambient;
  return made;
}

MadeLights fitLightsAndAmbient(const Image& latLong, const LightRequest& request) {
  LightRequest withAmbient = request;
  withAmbient.ambient = true;
  return fitLights(latLong, withAmbient);
}

MadeLights makeSuns(const Image& latLong, const LightRequest& request) {
  MadeLights made;
  for (const Sun& sun : extractSuns(latLong).suns)
    if (!request.count || made.lights.size() < size_t(*request.count))
      made.lights.push_back({vec3(sun.direction), Rgb(sun.irradiance), float(sun.angle)});
  return made;
}

Lights sunLights() {
  return {.make = makeSuns, .counts = {1, kUnlimited}, .countIsOptional = true};
}

Lights fit(MadeLights (*make)(const Image&, const LightRequest&)) {
  return {.make = make,
          .counts = {1, kMaxFittedLights, 16},
          .fitsAmbient = true,
          .takesMaxError = true};
}

std::string rangeOf(const CountRange& counts) {
  return counts.max == kUnlimited ? fmt::format("{} or more", counts.min)
                                  : fmt::format("{} to {}", counts.min, counts.max);
}

std::string helpLine(const std::string& name, std::string_view summary, const std::string& counts) {
  return fmt::format("  {:<26}{}{}\n", name, summary, counts);
}

}  // namespace

const std::vector<LightingMethod>& lightingMethods() {
  constexpr CountRange kRegions{2, 4096, 64}, kStrata{2, 4096, 8};
  static const std::vector<LightingMethod> kMethods{
      {"bsdf", "no light samples; BSDF samples find the probe", "", {}, sampling<BsdfOnly>, true},
      {"uniform", "samples uniform over the hemisphere", "", {}, sampling<Uniform>, true},
      {"importance",
       "samples proportional to luminance",
       "Pharr and Humphreys 2004; HDRI book, 9.6.3; Karlík et al. 2019",
       {},
       compensated<Importance>,
       true},
      {"product", "samples proportional to luminance x cosine", "", {}, sampling<Product>, true},
      {"suns",
       "each sun in the probe as a disc of its own",
       "HDRI book, 9.6.1",
       {},
       suns,
       false,
       false,
       sunLights()},
      replacing("median-cut", "a light for each region of equal energy", "Debevec 2005",
                medianCutLights(kRegions)),
      replacing("median-cut-centre", "the same, with lights at the centres of the regions",
                "HDRI book, 9.6.2", centreCutLights(kRegions)),
      replacing("median-cut-flat", "the same, with the map cut as if it were a flat picture", "",
                flatCutLights(kRegions)),
      replacing("median-cut-area", "each region of median-cut as an area light", "",
                medianCutLights(kRegions), asRegions),
      replacing("median-cut-centre-area", "the same for median-cut-centre", "",
                centreCutLights(kRegions), asRegions),
      replacing("median-cut-flat-area", "the same for median-cut-flat", "", flatCutLights(kRegions),
                asRegions),
      replacing("median-cut-disc", "discs with the solid angles of median-cut's regions", "",
                medianCutLights(kRegions), asDiscs),
      replacing("variance-cut", "a light for each region of small variance",
                "Viriyothai and Debevec 2009", varianceCutLights(kRegions)),
      replacing("lightgen", "K-means on the sphere, from random starts",
                "Cohen and Debevec 2001; HDRI book, 9.6.2", lightGenLights(kRegions)),
      replacing("kollig-keller", "K-means on the sphere, adding one light at a time",
                "Kollig and Keller 2003", kolligKellerLights(kRegions)),
      {"kollig-keller-strata", "a random direction in each region of kollig-keller",
       "Kollig and Keller 2003", kStrata, strata, true, false, strataLights(kStrata)},
      replacing("kollig-keller-average", "the same, with the average colour of the region",
                "Kollig and Keller 2003; HDRI book, 9.6.2", kolligKellerLights(kStrata), asRegions),
      replacing("cube-grid", "6 N^2 lights on the faces of a cube", "HDRI book, figure 9.31",
                cubeGridLights({1, 26, 10})),
      replacing("penrose", "blue-noise points on a Penrose tiling",
                "Ostromoukhov, Donohue and Jodoin 2004", penroseLights({2, 4096, 300})),
      replacing("irradiance-fit", "the lights that minimise the error of irradiance",
                "Madsen et al. 2003; Madsen and Laursen 2007", fit(fitLights)),
      replacing("irradiance-fit-ambient", "the same, with constant light from all directions",
                "Madsen et al. 2003", fit(fitLightsAndAmbient)),
  };
  return kMethods;
}

const LightingMethod& lightMethod(std::string_view name, std::string_view location) {
  std::vector<std::string_view> names;
  for (const LightingMethod& method : lightingMethods()) {
    if (!method.lights.make) continue;
    if (method.name == name) return method;
    names.push_back(method.name);
  }
  throwInput("{}: unknown method `{}`; {}", location, name, didYouMean(name, names));
}

void checkLightCount(std::string_view method, const LightRequest& request) {
  const Lights& lights = lightMethod(method, "lights").lights;
  if (request.levels) {
    if (!lights.takesLevels) throwInput("{}: does not cut regions by levels", method);
    if (*request.levels < 1 || *request.levels > kMaxLevels)
      throwInput("{}: {} levels are out of range; give 1 to {}", method, *request.levels,
                 kMaxLevels);
  }
  if (!request.count) {
    if (!lights.countIsOptional && !request.maxErrorPercent && !request.levels)
      throwInput("{}: needs a count", method);
    return;
  }
  const CountRange& counts = lights.counts;
  if (*request.count < counts.min || *request.count > counts.max)
    throwInput("{}: a count of {} is out of range; give {}", method, *request.count,
               rangeOf(counts));
}

MadeLights makeLights(std::string_view method, const Image& latLong, const LightRequest& request) {
  checkLightCount(method, request);
  return lightMethod(method, "lights").lights.make(latLong, request);
}

std::string strategyHelp() {
  std::string help = "Strategies:\n" +
                     helpLine("auto", "the unbiased strategy best for most scenes: importance", "");
  for (const LightingMethod& method : lightingMethods()) {
    const CountRange& counts = method.counts;
    help += counts.max == 0
                ? helpLine(std::string(method.name), method.summary, "")
                : helpLine(fmt::format("{}:N", method.name), method.summary,
                           fmt::format(" (N {}, default {})", rangeOf(counts), counts.usual));
  }
  return help;
}

std::string strategyTable() {
  std::string table =
      "| Name | Method | Source | Unbiased | N | Default |\n| --- | --- | --- | --- | --- | --- "
      "|\n";
  for (const LightingMethod& m : lightingMethods()) {
    const bool counts = m.counts.max > 0;
    table +=
        fmt::format("| `{}{}` | {} | {} | {} | {} | {} |\n", m.name, counts ? ":N" : "", m.summary,
                    m.source, m.isUnbiased ? "yes" : "no", counts ? rangeOf(m.counts) : "",
                    counts ? std::to_string(m.counts.usual) : "");
  }
  return table;
}

std::string lightMethodHelp() {
  std::string help = "Methods (and their range of --count, N):\n";
  for (const LightingMethod& method : lightingMethods())
    if (method.lights.make)
      help += helpLine(std::string(method.name), method.summary,
                       fmt::format(" ({})", rangeOf(method.lights.counts)));
  return help;
}

}  // namespace chromeball
