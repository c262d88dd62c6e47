// SPDX-License-Identifier: Apache-2.0
// The integrators by name.
#pragma once

#include <array>
#include <string_view>

namespace chromeball {

enum class IntegratorKind {
  Path,
  Direct,            // paths of one bounce
  AmbientOcclusion,  // environment mapping with both kinds of occlusion
  EnvironmentMap,
};

// In the order of IntegratorKind.
inline constexpr std::array<std::string_view, 4> kIntegratorNames = {
    "path", "direct", "ambient-occlusion", "environment-map"};

// Whether it takes the probe's light from prefiltered maps (environment_map.h).
constexpr bool usesEnvironment(IntegratorKind kind) {
  return kind == IntegratorKind::AmbientOcclusion || kind == IntegratorKind::EnvironmentMap;
}

}  // namespace chromeball
