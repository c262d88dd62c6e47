// SPDX-License-Identifier: Apache-2.0
// The part of a job that composites objects into a photograph.
#pragma once

#include "base/message.h"
#include "composite/compose.h"
#include "composite/render_composite.h"
#include "job/scene_file.h"

namespace chromeball {

struct RenderJob;
struct LoadedScene;

struct CompositePlan {
  Image plate;  // of the image's size
  CompositeMode mode = CompositeMode::Difference;
  // The source of the local scene's reflectance.
  enum class Reflectance { Model, Plate, Flat } reflectance = Reflectance::Model;
  bool choosesReflectance = false;  // Flat may become Plate
  int iterations = 1;               // of Reflectance::Plate
  Passes passes = Passes::One;
  std::vector<std::string> layers;  // names of all that were requested
  Messages messages;                // of the plate's reader
};

// Reads the plate of the job's [composite] section. The image takes the plate's size unless the job
// has another. Throws InputError.
void planComposite(RenderJob& job);

// Adds the ground if the job asks for it, determines the objects and the local scene, and sets the
// local scene's reflectance and gloss. Throws InputError.
void prepareLocalScene(RenderJob& job, LoadedScene& loaded);

// Scales the probe as the plate tells, if the job asks for it, after prepareLocalScene(). Throws
// InputError.
void scaleProbeByPlate(const RenderJob& job, LoadedScene& loaded);

}  // namespace chromeball
