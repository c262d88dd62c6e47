// SPDX-License-Identifier: Apache-2.0
// The scene of one frame after another: what does not change is loaded and built once.
#pragma once

#include "job/run_job.h"
#include "scene/gltf/texel_cache.h"

namespace chromeball {

class FrameScene {
 public:
  // Loads and builds the scene of a job, which becomes final as with loadScene(). All jobs must be
  // alike but for their times and `orbit`. Images are decoded, and the probe and its tables made,
  // with the first; geometry is read again where a model is animated, and its acceleration
  // structure is built again if it moved. All is loaded again for composites, and where the probe
  // has turned. Throws InputError.
  void show(RenderJob& job);

  const LoadedScene& loaded() const { return *loaded_; }
  const PreparedScene& prepared() const { return prepared_; }

 private:
  TexelCache texels_;
  std::unique_ptr<LoadedScene> loaded_;
  PreparedScene prepared_;
};

}  // namespace chromeball
