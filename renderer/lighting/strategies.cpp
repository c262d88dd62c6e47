// SPDX-License-Identifier: Apache-2.0
// The one table from names to strategies.
#include <charconv>
#include <functional>

#include "base/error.h"
#include "base/suggest.h"
#include "lighting/bsdf_only.h"
#include "lighting/constellation/constellations.h"
#include "lighting/delta_lights.h"
#include "lighting/fit/irradiance_fit.h"
#include "lighting/importance.h"
#include "lighting/product.h"
#include "lighting/strata.h"
#include "lighting/strategy.h"
#include "lighting/suns.h"
#include "lighting/uniform.h"

namespace chromeball {
namespace {

using Strategy = std::unique_ptr<LightingStrategy>;

struct Counts {
  int minimum = 0, maximum = 0;  // both 0: the strategy takes none
  int usual = 0;                 // where the name comes without one
};

struct Entry {
  std::string name;
  Counts counts;
  std::function<Strategy(const Probe&, Mis, int count)> make;
};

Entry constellation(const std::string& name, const Counts& counts) {
  return {name, counts, [name](const Probe& probe, Mis, int count) {
            constexpr uint64_t kSeed = 0;
            return std::make_unique<DeltaLights>(
                probe, makeConstellation(name, probe.latLong(), count, kSeed));
          }};
}

Strategy fittedLights(const Probe& probe, int count, bool ambient) {
  const IrradianceFit fit = fitIrradiance(probe.latLong(), {.count = count, .ambient = ambient});
  return std::make_unique<DeltaLights>(probe, fit.lights, fit.ambient);
}

const std::vector<Entry>& strategies() {
  static const std::vector<Entry> kStrategies = {
      {"bsdf", {}, [](const Probe& probe, Mis, int) { return std::make_unique<BsdfOnly>(probe); }},
      {"uniform",
       {},
       [](const Probe& probe, Mis, int) { return std::make_unique<Uniform>(probe); }},
      {"importance",
       {},
       [](const Probe& probe, Mis mis, int) {
         return std::make_unique<Importance>(probe, mis != Mis::Off);
       }},
      {"product",
       {},
       [](const Probe& probe, Mis, int) { return std::make_unique<Product>(probe); }},
      {"suns",
       {},
       [](const Probe& probe, Mis mis, int) {
         return std::make_unique<Suns>(probe, mis != Mis::Off);
       }},
      constellation("median-cut", {2, 4096, 64}),
      constellation("variance-cut", {2, 4096, 64}),
      constellation("lightgen", {2, 4096, 64}),
      constellation("kollig-keller", {2, 4096, 64}),
      {"kollig-keller-strata",
       {2, 4096, 8},
       [](const Probe& probe, Mis, int count) { return std::make_unique<Strata>(probe, count); }},
      constellation("cube-grid", {1, 26, 10}),
      constellation("penrose", {2, 4096, 300}),
      {"irradiance-fit",
       {1, kMaxFittedLights, 16},
       [](const Probe& probe, Mis, int count) { return fittedLights(probe, count, false); }},
      {"irradiance-fit-ambient",
       {1, kMaxFittedLights, 16},
       [](const Probe& probe, Mis, int count) { return fittedLights(probe, count, true); }},
  };
  return kStrategies;
}

const Entry* findStrategy(std::string_view name) {
  for (const Entry& entry : strategies())
    if (entry.name == name) return &entry;
  return nullptr;
}

int parseCount(std::string_view text, const Entry& entry, const std::string& location) {
  const auto& [minimum, maximum, usual] = entry.counts;
  if (maximum == 0)
    throwInput("{}: strategy `{}` takes no count; leave out `:{}`", location, entry.name, text);
  int count = 0;
  const char* end = text.data() + text.size();
  const auto [parsed, error] = std::from_chars(text.data(), end, count);
  if (error != std::errc() || parsed != end || count < minimum || count > maximum)
    throwInput("{}: `{}` is no count for strategy `{}`; give {}:{} to {}:{}, or no count for {}",
               location, text, entry.name, entry.name, minimum, entry.name, maximum, usual);
  return count;
}

std::vector<std::string_view> namesAndAuto() {
  std::vector<std::string_view> names = strategyNames();
  names.insert(names.begin(), "auto");
  return names;
}

}  // namespace

std::vector<std::string_view> strategyNames() {
  std::vector<std::string_view> names;
  for (const Entry& entry : strategies()) names.push_back(entry.name);
  return names;
}

std::string resolveStrategy(const std::string& name) {
  if (name == "auto") return "importance";
  const Entry* entry = findStrategy(name);
  return entry && entry->counts.maximum ? fmt::format("{}:{}", name, entry->counts.usual) : name;
}

std::unique_ptr<LightingStrategy> makeStrategy(const std::string& name, const Probe& probe, Mis mis,
                                               const std::string& location) {
  const std::string resolved = resolveStrategy(name);
  const size_t colon = resolved.find(':');
  const Entry* entry = findStrategy(std::string_view(resolved).substr(0, colon));
  if (!entry)
    throwInput("{}: strategy `{}` is not known; {}", location, name,
               didYouMean(resolved.substr(0, colon), namesAndAuto()));
  int count = 0;
  if (colon != std::string::npos)
    count = parseCount(std::string_view(resolved).substr(colon + 1), *entry, location);
  return entry->make(probe, mis, count);
}

}  // namespace chromeball
