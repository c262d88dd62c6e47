// SPDX-License-Identifier: Apache-2.0
// A render with all its settings: given settings override the scene file's, which override the
// defaults.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "image/develop/develop.h"
#include "image/tonemap.h"
#include "integrate/render.h"
#include "job/choose_camera.h"
#include "job/composite_plan.h"
#include "job/scene_file.h"

namespace chromeball {

// The time that an image takes, from its own on.
struct Shutter {
  double seconds = 0;
  int steps = 8;    // straight pieces in which what moves moves, up to kMostMotionSteps
  double turn = 0;  // of the camera's orbit, degrees
};

struct RenderJob {
  SceneFile file;                 // its `settings` include the given ones
  RenderSettings settings;        // of the integrator; the size is final after loadScene()
  std::optional<ImageSize> size;  // nullopt: determined by the model's camera
  SingleSided singleSided = SingleSided::Camera;
  bool straightGlassShadows = false;  // passShadowsStraight()
  std::optional<Shutter> shutter;     // nullopt: an image of one instant
  NamedSetting strategy;
  std::optional<CompositePlan> composite;
  std::optional<AutomaticView> view;  // nullopt: to be found by loadScene()
  std::string plannedParts;           // partsOf() (job_changes.h) as planJob() made them

  // For writing the image; no effect on rendering.
  std::vector<std::string> outputs;
  bool makesOutputFolders = false;  // the scene file names the outputs
  DevelopSettings develop;          // of a .png, before `display`
  DisplayTransform display;         // of a .png
};

// The part of planJob() that takes the values of settings, for a scene file whose settings are
// final. Throws InputError.
RenderJob plannedSettings(SceneFile scene);

// Overrides the scene file's settings by `over`, and reads the plate of a composite. Throws
// InputError for settings that contradict each other, and for an unreadable plate.
RenderJob planJob(SceneFile scene, const Settings& over = {});

}  // namespace chromeball
