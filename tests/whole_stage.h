// SPDX-License-Identifier: Apache-2.0
// Light stages in one band.
#pragma once

#include "relight/stage/render_basis.h"
#include "relight/stage/stage_file.h"

namespace chromeball {

BasisRender renderBasis(const World& world, const Camera& camera, const char* basis,
                        const RenderSettings& settings);

void writeStage(const std::filesystem::path& path, const LightStage& stage, const Image& color,
                bool halves);

LightStage readStage(const std::filesystem::path& path);

}  // namespace chromeball
