// SPDX-License-Identifier: Apache-2.0
#include "session/frame_scene.h"

#include "session/scene_lighting.h"

namespace chromeball {

void FrameScene::show(const RenderDescription& job) {
  if (!loaded_ || job.composite) return load(job);
  const FrameChange change = loadFrame(job, *loaded_, models_);
  if (change.geometry) {
    BsdfTables tables = prepared_.world->bsdfTables;
    tables.complete(loaded_->scene.materials, job.settings.regularize);
    const std::shared_ptr<BuiltGeometry> built = prepared_.world->accel.built();
    prepared_.world.reset();
    prepared_.world =
        std::make_unique<const World>(loaded_->scene, std::vector<RayMask>(), tables, built);
  }
  if (!change.lighting) return;
  prepared_.lighting = makeLighting(*loaded_);
  prepared_.environment = makeEnvironment(job.settings.integrator, job.lighting.strategy, *loaded_);
}

void FrameScene::load(const RenderDescription& job) {
  const std::optional<AutomaticView> view = loaded_ ? std::optional(loaded_->view) : std::nullopt;
  prepared_ = {};
  models_.keepsFiles = true;
  loaded_ = std::make_unique<LoadedScene>(loadScene(job, &models_, view ? &*view : nullptr));
  prepared_ = prepareScene(*loaded_);
}

}  // namespace chromeball
