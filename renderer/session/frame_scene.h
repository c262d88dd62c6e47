// SPDX-License-Identifier: Apache-2.0
// The scene of one frame after another: what does not change is loaded and built once.
#pragma once

#include "scene/gltf/model_cache.h"
#include "session/run_job.h"

namespace chromeball {

class FrameScene {
 public:
  // Loads and builds the scene of a description. All descriptions must be
  // alike but for their times, `orbit`, and the probe's file and rotation. Files are opened, images
  // decoded, and the tables of the probe made with the first; meshes, and the acceleration
  // structures over them, are made again where they have moved or changed, the probe where it has
  // turned, and all for composites. Throws InputError.
  void show(const RenderDescription& job);

  const LoadedScene& loaded() const { return *loaded_; }
  const PreparedScene& prepared() const { return prepared_; }

 private:
  void load(const RenderDescription& job);

  ModelCache models_;
  std::unique_ptr<LoadedScene> loaded_;
  PreparedScene prepared_;
};

}  // namespace chromeball
