// SPDX-License-Identifier: Apache-2.0
// What a job's files hold, ready to be rendered.
#pragma once

#include "job/render_job.h"
#include "lighting/strategy.h"
#include "probe/load.h"
#include "scene/scene.h"
#include "trace/room.h"

namespace chromeball {

struct LoadedScene {
  Scene scene;
  Camera camera;
  LoadedProbe loadedProbe;  // what was found in its file; the map itself is in `probe`
  Probe probe;              // black where the scene lights itself
  std::optional<Surroundings> surroundings;  // the model is inside
  std::unique_ptr<const Room> room;          // where they are a model
  glm::dvec3 origin;                         // of the scene's coordinates in the world
  std::vector<std::string> modelWarnings;    // what the models' files hold that is not rendered
  std::vector<std::string> files;            // all that were read: none may be written
};

// Reads models and probe, chooses the camera, and the size where the job left it to the camera.
// Throws InputError.
LoadedScene loadScene(RenderJob& job);

// The strategy, with the probe as far away as the scene's surroundings have it. `loaded` must
// outlive it. Throws InputError for an unknown name.
std::unique_ptr<LightingStrategy> makeLighting(const NamedSetting& strategy, Mis mis,
                                               const LoadedScene& loaded);

// Says on standard error what is wrong with the job's settings, what is left out of the models,
// what was repaired in the probe (warnings) and, unless quiet, what was guessed or chosen (notes).
// To be called once nothing can be wrong any more, so that what is wrong stays one line.
void sayNotes(const RenderJob& job, const LoadedScene& loaded, bool quiet);

// On standard error: "chromeball: warning: ...", of what may spoil the picture; it is always said.
// "chromeball: ...", of what a user may like to know; --quiet silences it.
void warn(const std::string& message);
void note(const std::string& message);

}  // namespace chromeball
