// SPDX-License-Identifier: Apache-2.0
#include "job/frame_scene.h"

namespace chromeball {

void FrameScene::show(RenderJob& job) {
  const float rotation = float(job.file.settings.get<double>("probe.rotation"));
  if (loaded_) job.view = loaded_->view;
  if (loaded_ && !job.composite && loaded_->probe.rotationDegrees() == rotation) {
    LoadedScene& loaded = *loaded_;
    const glm::dvec3 origin = loaded.origin;
    if (!loadFrame(job, loaded, models_)) return;
    const BsdfTables tables = prepared_.world->bsdfTables;
    const std::shared_ptr<BuiltGeometry> built = prepared_.world->accel.built();
    prepared_.world.reset();
    prepared_.world =
        std::make_unique<const World>(loaded.scene, std::vector<RayMask>(), tables, built);
    if (loaded.origin != origin)
      prepared_.lighting = makeLighting(job.strategy, job.settings.mis, loaded);
    return;
  }
  prepared_ = {};
  models_.keepsFiles = true;
  loaded_ = std::make_unique<LoadedScene>(loadScene(job, &models_));
  prepared_ = prepareScene(job, *loaded_);
}

}  // namespace chromeball
