// SPDX-License-Identifier: Apache-2.0
#include "job/frame_scene.h"

#include "job/scene_lighting.h"

namespace chromeball {

void FrameScene::show(RenderJob& job) {
  if (!loaded_ || job.composite) return load(job);
  const bool turns = !(rotationOf(job) == loaded_->probe.rotation());
  if (turns && !job.file.settings.has("probe.file"))
    return load(job);  // the model's own environment
  job.view = loaded_->view;
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
  prepared_.lighting = makeLighting(job, *loaded_);
  prepared_.environment = makeEnvironment(job.settings.integrator, job.strategy.name, *loaded_);
}

void FrameScene::load(RenderJob& job) {
  if (loaded_) job.view = loaded_->view;
  prepared_ = {};
  models_.keepsFiles = true;
  loaded_ = std::make_unique<LoadedScene>(loadScene(job, &models_));
  prepared_ = prepareScene(job, *loaded_);
}

}  // namespace chromeball
