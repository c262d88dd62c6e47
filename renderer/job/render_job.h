// SPDX-License-Identifier: Apache-2.0
// A render with all its settings: those given, laid over the scene file's, laid over the defaults.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "image/tonemap.h"
#include "integrate/render.h"
#include "job/composite_plan.h"
#include "job/scene_file.h"

namespace chromeball {

struct RenderJob {
  SceneFile file;                 // its `settings` hold the given ones too
  RenderSettings settings;        // of the integrator; the size is final after loadScene()
  std::optional<ImageSize> size;  // else the model's camera decides
  SingleSided singleSided = SingleSided::Camera;
  NamedSetting strategy;
  std::optional<CompositePlan> composite;

  // Of writing the image; rendering ignores them.
  std::vector<std::string> outputs;
  bool makesOutputFolders = false;  // the scene file names the outputs
  DisplayTransform display;         // of a .png
};

// Lays `over` over the scene file's settings, and reads the plate of a composite. Throws InputError
// for settings that contradict each other, and for an unreadable plate.
RenderJob planJob(SceneFile scene, const Settings& over = {});

}  // namespace chromeball
