// SPDX-License-Identifier: Apache-2.0
// Light stages in one band.
#pragma once

#include "relight/render_basis.h"
#include "relight/stage_file.h"

namespace chromeball {

inline BasisRender renderBasis(const World& world, const Camera& camera, const char* basis,
                               const RenderSettings& settings) {
  return BasisRenderer(world, camera, DirectionBasis(basis, "test"), settings)
      .render(
          0, settings.height, [](double) {}, false);
}

inline void writeStage(const std::filesystem::path& path, const LightStage& stage,
                       const Image& color, bool halves) {
  StageWriter file(path, stage, stage.height(), {}, halves);
  file.write(stage, color);
  file.commit();
}

inline LightStage readStage(const std::filesystem::path& path) {
  StageReader file(path);
  return file.read(0, file.height());
}

}  // namespace chromeball
