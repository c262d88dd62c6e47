// SPDX-License-Identifier: Apache-2.0
// What a study compares: a lighting strategy, with the integrator and the ways of rendering that it
// is combined with.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "description/render_description.h"

namespace chromeball {

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

// By name: STRATEGY, or STRATEGY+MODE+..., as "importance+regularize+denoise" or
// "suns+environment-map+ao". The integrators but `path` are such modes, and so are
// "diffuse-depth:N", "specular-depth:N" and "irradiance-cache:ERROR".
struct Row {
  std::string strategy;  // complete name ("median-cut:64")
  IntegratorKind integrator = IntegratorKind::Path;
  std::vector<Mode> modes;  // without repetition, in the order of Mode
  std::optional<int> diffuseDepth, specularDepth;
  std::optional<float> cacheError;

  bool has(Mode mode) const;
  bool isBiased() const;  // by more than its strategy
  std::string name() const;
  // `settings` with these modes, and no others.
  RenderSettings applied(RenderSettings settings) const;
  // The same of a description, with the strategy.
  void applyTo(RenderDescription& description) const;
};

// `location` (an option) begins the InputError thrown for an unknown mode. The strategy is resolved
// but not checked.
Row rowNamed(const std::string& name, const std::string& location);

}  // namespace chromeball
