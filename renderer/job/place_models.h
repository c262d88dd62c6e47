// SPDX-License-Identifier: Apache-2.0
// The models of a job in the scene's coordinates, and its camera.
#pragma once

#include <string>
#include <vector>

#include "job/render_job.h"
#include "scene/scene.h"

namespace chromeball {

struct ModelCache;

// With the scene file's lamps.
struct PlacedModels {
  Scene scene;
  Camera camera;
  AutomaticView view;
  glm::dvec3 origin{0};  // of the scene's coordinates in the world, metres
  std::vector<std::string> warnings;
};

// Reads the models; chooses the camera, and the image's size if the job leaves it to the camera.
// Moves what the scene file places in the world to the scene's coordinates. With an open shutter,
// with the motion of models and camera. Throws InputError.
PlacedModels placeModels(RenderJob& job, ModelCache& cache);

// The same of models that stand still, of which only the camera is to be placed again.
Camera placeCamera(RenderJob& job, const Scene& scene, const AutomaticView& view,
                   const glm::dvec3& origin);

// The models at this origin, without lamps; an animated model may have no triangles at its time.
// `warnings`: each once.
Scene loadModels(const SceneFile& file, const glm::dvec3& origin, ModelCache& cache,
                 std::vector<std::string>& warnings);

// The camera with the job's `orbit` and another turn, degrees; it stands still. Throws InputError.
Camera cameraOf(const RenderJob& job, const Scene& scene, const AutomaticView& view,
                const glm::dvec3& origin, double turn = 0);

}  // namespace chromeball
