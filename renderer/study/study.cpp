// SPDX-License-Identifier: Apache-2.0
#include "study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "base/error.h"
#include "base/hash.h"
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

int depthOf(std::string_view text, const std::string& name, const std::string& location) {
  int depth = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), depth);
  if (error != std::errc() || end != text.data() + text.size() || depth < 0)
    throwInput("{}: `{}` needs a whole number from 0", location, name);
  return depth;
}

float cacheErrorOf(std::string_view text, const std::string& name, const std::string& location) {
  float error = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), error);
  if (failure != std::errc() || end != text.data() + text.size() || !(error > 0 && error <= 1))
    throwInput("{}: `{}` needs a number above 0 and at most 1", location, name);
  return error;
}

void addMode(const std::string& name, const std::string& location, Row& row) {
  if (name.starts_with(kDiffuseDepth)) {
    row.diffuseDepth = depthOf(std::string_view(name).substr(kDiffuseDepth.size()), name, location);
    return;
  }
  if (name.starts_with(kSpecularDepth)) {
    row.specularDepth =
        depthOf(std::string_view(name).substr(kSpecularDepth.size()), name, location);
    return;
  }
  if (name.starts_with(kCache)) {
    row.cacheError = cacheErrorOf(std::string_view(name).substr(kCache.size()), name, location);
    return;
  }
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
  size_t end = name.find('+');
  Row row;
  row.strategy = resolveStrategy(name.substr(0, end));
  while (end != std::string::npos) {
    const size_t begin = end + 1;
    end = name.find('+', begin);
    addMode(name.substr(begin, end - begin), location, row);
  }
  std::ranges::sort(row.modes);
  check(row, location);
  return row;
}

}  // namespace chromeball
