// SPDX-License-Identifier: Apache-2.0
// The contents of a description's files, ready to be rendered.
#pragma once

#include "base/message.h"
#include "composite/differential.h"
#include "composite/plate.h"
#include "description/render_description.h"
#include "lighting/strategy.h"
#include "probe/load.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "session/place_models.h"
#include "session/scene_lighting.h"
#include "trace/room.h"

namespace chromeball {

struct LoadedScene {
  RenderDescription description;  // with what its files decide: the image's size, and the source of
                                  // the local scene's reflectance
  Scene scene;
  Camera camera;            // the camera of the image
  AutomaticView view;       // the parts that the models decide
  LoadedProbe loadedProbe;  // properties of its file; the map itself moves to `probe`
  Probe probe;              // black if only the scene's own lights are used
  std::optional<Surroundings> surroundings;  // the model is inside
  std::unique_ptr<const Room> room;          // null unless the surroundings are a model
  bool hasModelLights = false;               // punctual ones, also if they are off
  bool moves = false;                        // anything while the shutter is open
  glm::dvec3 origin;                         // of the scene's coordinates in the world, metres
  std::optional<ProbeSources> sources;       // polygons of the probe
  std::vector<std::string> files;            // all that were read; no output may replace one
  Messages messages;                         // of the settings, of the models and of the probe
  std::vector<std::string> modelWarnings;    // of their files and their motion

  // These are for composites; otherwise empty.
  ObjectMask isObject;                     // the rest of the scene is the local scene
  std::unique_ptr<Projection> projection;  // of the local scene's reflectance, where it is solved
  std::optional<PlateScale> plateScale;    // the factor that the probe was scaled by
};

// Reads models and probe, chooses the camera, and the image's size if the description leaves it to
// the camera. For further frames of a sequence: `shared`, what their models have in common, and
// `view`, decided by the other frames; both may be null. Throws InputError.
LoadedScene loadScene(const RenderDescription& description, ModelCache* shared = nullptr,
                      const AutomaticView* view = nullptr);

struct FrameChange {
  bool geometry = false;  // or lights of the scene
  bool lighting = false;  // the probe, or its surroundings
  bool probe = false;     // another one, not only a turned one
};

// Replaces the camera, the probe if it has turned, is another file or shall be read again, and
// whatever an animated model moves, for another frame of the same description; models that stand
// still must have its view. Not for composites; a probe that turns must have a file.
FrameChange loadFrame(const RenderDescription& description, LoadedScene& loaded, ModelCache& cache,
                      bool readsProbe = false);

// Messages to the user about the files of a description.

// Messages about the settings, the models, the probe and the plate.
Messages loadMessages(const LoadedScene& loaded);

// What of the settings of `description` has no effect on the loaded scene.
Messages idleMessages(const RenderDescription& description, const LoadedScene& loaded);

}  // namespace chromeball
