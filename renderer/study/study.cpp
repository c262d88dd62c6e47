// SPDX-License-Identifier: Apache-2.0
#include "study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "base/error.h"
#include "base/hash.h"
#include "base/text.h"
#include "description/capabilities.h"
#include "lighting/methods.h"

namespace chromeball {

std::string Budget::label() const {
  return timed ? fmt::format("{}s", amount) : fmt::format("{}spp", int64_t(amount));
}

uint64_t seedOf(const RenderKey& key, uint64_t studySeed) {
  constexpr uint64_t kTopBit = uint64_t(1) << 63;
  uint64_t seed = hash(studySeed, uint64_t(key.repeat));
  for (const char c : key.strategy + " " + key.budget.label()) seed = hash(seed, uint64_t(c));
  return key.strategy == kReference ? seed | kTopBit : seed & ~kTopBit;
}

uint32_t Study::leastSamples() const {
  uint32_t least = kMaxSamples;
  for (const Budget& budget : budgets)
    if (!budget.timed) least = std::min(least, uint32_t(budget.amount));
  return least;
}

uint32_t Study::mostSamples() const {
  uint32_t most = 0;
  for (const Budget& budget : budgets)
    most = std::max(most, budget.timed ? kMaxSamples : uint32_t(budget.amount));
  return most;
}

RenderKey Study::referencePart(int part) const {
  const int samples = (referenceSamples + kReferenceParts - 1) / kReferenceParts;
  return {kReference, {false, double(samples)}, part};
}

std::vector<RenderKey> Study::renders() const {
  std::vector<RenderKey> keys;
  if (referenceFile.empty())
    for (int part = 0; part < kReferenceParts; ++part) keys.push_back(referencePart(part));
  for (const Budget& budget : budgets)
    for (int repeat = 0; repeat < repeats; ++repeat)
      for (const std::string& strategy : strategies) keys.push_back({strategy, budget, repeat});
  return keys;
}

namespace {

struct ModeName {
  Mode mode;
  const char* name;
};
constexpr ModeName kModes[] = {{Mode::Adaptive, "adaptive"},
                               {Mode::Guide, "guide"},
                               {Mode::Regularize, "regularize"},
                               {Mode::GlassShadows, "glass-shadows"},
                               {Mode::Denoise, "denoise"},
                               {Mode::AmbientOcclusion, "ao"},
                               {Mode::ReflectionOcclusion, "reflection-occlusion"}};
constexpr std::string_view kDiffuseDepth = "diffuse-depth:", kSpecularDepth = "specular-depth:",
                           kCache = "irradiance-cache:";

// Whether it is a mode with a number, such as "diffuse-depth:2", which it sets.
template <class Number>
bool takeNumbered(std::string_view prefix, const std::string& name, const std::string& location,
                  bool (*isIn)(Number), const char* range, std::optional<Number>& number) {
  if (!name.starts_with(prefix)) return false;
  if (!toNumber(std::string_view(name).substr(prefix.size()), number.emplace()) || !isIn(*number))
    throwInput("{}: `{}` needs {}", location, name, range);
  return true;
}

bool takeDepth(std::string_view prefix, const std::string& name, const std::string& location,
               std::optional<int>& depth) {
  return takeNumbered<int>(
      prefix, name, location, [](int n) { return n >= 0; }, "a whole number from 0", depth);
}

void addMode(const std::string& name, const std::string& location, Row& row) {
  if (takeDepth(kDiffuseDepth, name, location, row.diffuseDepth) ||
      takeDepth(kSpecularDepth, name, location, row.specularDepth) ||
      takeNumbered<float>(
          kCache, name, location, [](float x) { return x > 0 && x <= 1; },
          "a number above 0 and at most 1", row.cacheError))
    return;
  const auto integrator = std::ranges::find(kIntegratorNames, name);
  if (integrator != kIntegratorNames.end()) {
    row.integrator = IntegratorKind(integrator - kIntegratorNames.begin());
    return;
  }
  std::vector<std::string_view> known;
  for (const auto& [mode, modeName] : kModes) {
    if (name == modeName) {
      if (!row.has(mode)) row.modes.push_back(mode);
      return;
    }
    known.push_back(modeName);
  }
  known.insert(known.end(), kIntegratorNames.begin(), kIntegratorNames.end());
  throwInput("{}: `{}` is not a mode; modes are {}, {}N, {}N and {}ERROR", location, name,
             fmt::join(known, ", "), kDiffuseDepth, kSpecularDepth, kCache);
}

// Checks a row as if it were the only render.
void check(const Row& row, const std::string& location) {
  RenderDescription alone;
  row.applyTo(alone);
  if (const Conflict* found = conflictIn(alone))
    throwInput("{}: {}: {}: {}", location, row.name(), found->feature.name, found->why);
}

}  // namespace

bool Row::has(Mode mode) const { return std::ranges::count(modes, mode) > 0; }

bool Row::isBiased() const {
  return integrator != IntegratorKind::Path || has(Mode::Regularize) || has(Mode::GlassShadows) ||
         has(Mode::Denoise) || diffuseDepth || specularDepth || cacheError;
}

bool Row::joinsPixels() const { return has(Mode::Denoise) || cacheError; }

std::string Row::name() const {
  std::string name = strategy;
  if (integrator != IntegratorKind::Path)
    name += fmt::format("+{}", kIntegratorNames[size_t(integrator)]);
  for (const auto& [mode, modeName] : kModes)
    if (has(mode)) name += std::string("+") + modeName;
  if (diffuseDepth) name += fmt::format("+{}{}", kDiffuseDepth, *diffuseDepth);
  if (specularDepth) name += fmt::format("+{}{}", kSpecularDepth, *specularDepth);
  if (cacheError) name += fmt::format("+{}{}", kCache, *cacheError);
  return name;
}

Row Row::representative() const {
  Row row = *this;
  if (usesEnvironment(integrator) && strategy != "suns") row.strategy = "importance";
  if (integrator == IntegratorKind::Direct) {
    if (diffuseDepth > 0) row.diffuseDepth.reset();
    if (specularDepth > 0) row.specularDepth.reset();
  }
  return row;
}

std::vector<std::string_view> Row::settings() const {
  std::vector<std::string_view> names;
  for (const auto& [mode, setting] : {std::pair{Mode::Guide, "render.guide"},
                                      {Mode::Regularize, "render.regularize"},
                                      {Mode::GlassShadows, "render.glass_shadows"},
                                      {Mode::AmbientOcclusion, "render.ao"},
                                      {Mode::ReflectionOcclusion, "render.reflection_occlusion"}})
    if (has(mode)) names.push_back(setting);
  if (diffuseDepth) names.push_back("render.max_diffuse_depth");
  if (specularDepth) names.push_back("render.max_specular_depth");
  if (cacheError) names.push_back("render.irradiance_cache");
  return names;
}

RenderSettings Row::applied(RenderSettings settings) const {
  settings.adaptive = has(Mode::Adaptive);
  settings.guiding = has(Mode::Guide) ? Guiding::On : Guiding::Off;
  settings.regularize = has(Mode::Regularize);
  settings.denoise = has(Mode::Denoise);
  settings.integrator = integrator;
  settings.occlusion.ambient = has(Mode::AmbientOcclusion);
  settings.occlusion.reflection = has(Mode::ReflectionOcclusion);
  settings.cacheError = cacheError;
  settings.maxDiffuseDepth = diffuseDepth.value_or(settings.maxDiffuseDepth);
  settings.maxSpecularDepth = specularDepth.value_or(settings.maxSpecularDepth);
  return settings;
}

void Row::applyTo(RenderDescription& description) const {
  description.settings = applied(description.settings);
  description.lighting.strategy = strategy;
  description.straightGlassShadows = has(Mode::GlassShadows);
}

Row rowNamed(const std::string& name, const std::string& location) {
  const auto parts = splitAt(name, '+');
  Row row;
  row.strategy = resolveStrategy(std::string(parts.front()));
  for (const std::string_view mode : std::span(parts).subspan(1))
    addMode(std::string(mode), location, row);
  std::ranges::sort(row.modes);
  check(row, location);
  return row;
}

}  // namespace chromeball
