// SPDX-License-Identifier: Apache-2.0
// Khronos's sample models, if they are available.
#pragma once

#include <optional>
#include <string>

#include "test_scene.h"

namespace chromeball {

std::optional<Scene> sampleModel(const std::string& name);

// Renders the square of half-side `halfHeight` around `centre`, orthographically along -Z.
Image squareView(const Scene& scene, const vec3& centre, float halfHeight, int pixels,
                 const Probe& probe, RenderSettings settings);

Material& materialNamed(Scene& scene, const std::string& name);

// Replaces the material by a black one of emission 1.
void makeLamp(Material& material);

}  // namespace chromeball
