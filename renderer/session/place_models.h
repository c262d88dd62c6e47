// SPDX-License-Identifier: Apache-2.0
// The models of a description in the scene's coordinates, and its camera.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "description/render_description.h"
#include "scene/framing.h"
#include "scene/scene.h"

namespace chromeball {

// Everything that decides an AutomaticView besides the models; what is not needed is as in {}.
struct ViewNeeds {
  std::optional<ViewWishes> wishes;  // of the camera, if nobody has placed one
  float aspectRatio = 0;             // of its image
  bool choosesSides = false;         // by that camera
  bool turns = false;                // the camera, around the centre
  bool stands = false;               // needsStand()
  std::optional<double> floor;       // floorOf()

  bool operator==(const ViewNeeds&) const = default;
};

// The parts of a view that depend on the models' bounds, at all times of an animation, so that they
// are the same for each of its frames.
struct AutomaticView {
  ViewNeeds needs;
  std::optional<Camera> camera;  // if nobody has placed one
  bool isDark = false;           // Framing::isDark, of that camera
  vec3 centre{0};                // of the camera's turn; 0 without one
  glm::dvec3 origin{0};          // the world position of these coordinates' origin, metres
  // In the world, where the models' own placements put them; 0 if they are not needed.
  double lowest = 0;
  glm::dvec3 axis{0};  // a point of the turntable's, the models' centre at time 0

  AutomaticView seenFrom(const glm::dvec3& other) const;  // with another origin
};

struct ModelCache;

// The models, with the scene file's lamps.
struct PlacedModels {
  Scene scene;
  Camera camera;
  AutomaticView view;
  glm::dvec3 origin{0};    // of the scene's coordinates in the world, metres
  bool hasLights = false;  // punctual ones of the models, also if they are off
  bool moves = false;      // anything while the shutter is open, also if no key shows it
  std::vector<std::string> warnings;
};

// Reads the models; chooses the camera, and the image's size if the description leaves it to the
// camera. Converts what the scene file places in the world to the scene's coordinates. If the
// shutter is open, includes the motion of models and camera. `view`: from other frames; null: to be
// found; it is found anew if the description needs another one. Throws InputError.
PlacedModels placeModels(RenderDescription& description, ModelCache& cache,
                         const AutomaticView* view = nullptr);

// Whether the view of these models is the description's.
bool isViewOf(RenderDescription description, const Scene& scene, const AutomaticView& view);

// The same for models that stand still, and a view of the description: only the camera is placed
// again.
Camera placeCamera(RenderDescription& description, const Scene& scene, const AutomaticView& view,
                   const glm::dvec3& origin);

// Loads `models`, the description's at some time, at this origin and without lamps, but with their
// lights, which are black if the description switches them off; an animated model may have no
// triangles at its time. `warnings`: each once.
Scene loadModels(const RenderDescription& description, const std::vector<ModelEntry>& models,
                 const glm::dvec3& origin, ModelCache& cache, std::vector<std::string>& warnings);

// The camera with the description's `orbit` and another turn, degrees; it stands still. Throws
// InputError.
Camera cameraOf(const RenderDescription& description, const Scene& scene, const AutomaticView& view,
                const glm::dvec3& origin, double turn = 0);

// Where the models stand: dropped to the ground, turned on a turntable, with a plane below.

// Whether AutomaticView::lowest or its axis are needed.
bool needsStand(const RenderDescription& description);

// Where the models' lowest point shall be; nullopt: they are not dropped.
std::optional<double> floorOf(const RenderDescription& description);

// How far the models move up, metres, if their lowest point is at this height (y in the world).
double dropOf(const RenderDescription& description, double lowest);

// The models with the placements that make them stand as described.
std::vector<ModelEntry> standing(const RenderDescription& description,
                                 std::vector<ModelEntry> models, const AutomaticView& view);

// Turns the models' cameras back, which stand still; `origin`: of the scene's coordinates.
void turnBackCameras(const RenderDescription& description, const AutomaticView& view,
                     const glm::dvec3& origin, Scene& scene);

// Adds the ground of a plain render to the scene; tells the composite of a shadow catcher that
// names it the height.
void addGround(RenderDescription& description, const AutomaticView& view, const glm::dvec3& origin,
               Scene& scene);

}  // namespace chromeball
