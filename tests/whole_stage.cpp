// SPDX-License-Identifier: Apache-2.0
#include "whole_stage.h"

namespace chromeball {

BasisRender renderBasis(const World& world, const Camera& camera, const char* basis,
                        const RenderSettings& settings) {
  return BasisRenderer(world, camera, DirectionBasis(basis, "test"), settings)
      .render(
          0, settings.height, [](double) {}, false);
}

void writeStage(const std::filesystem::path& path, const LightStage& stage, const Image& color,
                bool halves) {
  StageWriter file(path, stage, stage.height(), {}, halves);
  file.write(stage, color);
  file.commit();
}

LightStage readStage(const std::filesystem::path& path) {
  StageReader file(path);
  return file.read(0, file.height());
}

}  // namespace chromeball
