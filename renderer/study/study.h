// SPDX-License-Identifier: Apache-2.0
// A comparison of strategies: a set of independent renders, each with its own seed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "description/render_description.h"

namespace chromeball {

// The budget of a render: samples per pixel, or seconds.
struct Budget {
  bool timed;
  double amount;

  std::string label() const;  // "64spp", "0.5s"; not rounded
  bool operator==(const Budget&) const = default;
  auto operator<=>(const Budget&) const = default;  // budgets in samples before those in seconds
};

// Identifies a render. The reference is stored as a strategy named kReference, with its parts as
// repeats.
struct RenderKey {
  std::string strategy;
  Budget budget;
  int repeat = 0;
};
inline constexpr const char* kReference = "reference";

// The seed of a render: a hash of its key. Seeds of the reference have the top bit set, all others
// do not, so that no render shares a seed with the reference.
uint64_t seedOf(const RenderKey& key, uint64_t studySeed);

struct Study {
  std::string folder;
  std::vector<std::string> strategies;  // to render; names of rows
  std::vector<Budget> budgets;          // to render; ascending
  int repeats = 4;                      // of each strategy and budget
  std::string baseline;                 // one of the strategies; empty: the results choose it

  // Strategies and budgets in the results: the above, and the ones that earlier runs left in the
  // folder.
  std::vector<std::string> shownStrategies;
  std::vector<Budget> shownBudgets;

  std::string referenceFile;                 // empty: the reference is rendered by
  std::string referenceStrategy;             // this strategy with
  int referenceSamples = 0;                  // samples per pixel of all parts together
  static constexpr int kReferenceParts = 8;  // independent; their variance gives the error
  static constexpr int kMinRepeats = 3;      // the minimum to estimate the variance of a strategy

  uint64_t seed = 0;
  // JSON of all settings that the renders of a study share; renders of other studies cannot be
  // used.
  std::string identity;

  // The smallest budget in samples; kMaxSamples if all are in seconds.
  uint32_t leastSamples() const;
  uint32_t mostSamples() const;  // kMaxSamples if a budget is of time
  RenderKey referencePart(int part) const;
  // All renders, in the order of rendering. Strategies alternate, so that a machine whose speed
  // drifts does not favour any of them.
  std::vector<RenderKey> renders() const;
};

// The subject of a comparison: a lighting strategy, with the integrator and the ways of rendering
// that it is combined with.

// A way of rendering besides the lighting strategy.
enum class Mode {
  Adaptive,
  Guide,
  Regularize,
  GlassShadows,
  Denoise,
  AmbientOcclusion,
  ReflectionOcclusion
};

// A row of the study. Its name is STRATEGY, or STRATEGY+MODE+..., such as
// "importance+regularize+denoise" or "suns+environment-map+ao". The integrators but `path` are such
// modes, and so are "diffuse-depth:N", "specular-depth:N" and "irradiance-cache:ERROR".
struct Row {
  std::string strategy;  // complete name ("median-cut:64")
  IntegratorKind integrator = IntegratorKind::Path;
  std::vector<Mode> modes;  // without repetition, in the order of Mode
  std::optional<int> diffuseDepth, specularDepth;
  std::optional<float> cacheError;

  bool has(Mode mode) const;
  bool isBiased() const;     // by more than its strategy
  bool joinsPixels() const;  // so that the errors of pixels depend on each other
  std::string name() const;
  // The names of the scene file's settings of those modes that may have no effect.
  std::vector<std::string_view> settings() const;
  // The row that stands for all with the same pixels but for their seeds: without what has no
  // effect with its integrator.
  Row representative() const;
  // `settings` with these modes, and no others.
  RenderSettings applied(RenderSettings settings) const;
  // The same for a description, with the strategy.
  void applyTo(RenderDescription& description) const;
};

// `location` (an option) begins the InputError thrown for an unknown mode. The strategy is resolved
// but not checked.
Row rowNamed(const std::string& name, const std::string& location);

}  // namespace chromeball
