// SPDX-License-Identifier: Apache-2.0
#include "job/open_shutter.h"

#include <algorithm>

#include "base/error.h"
#include "job/memory_estimate.h"
#include "job/motion_error.h"
#include "job/scene_motion.h"
#include "scene/gltf/load_gltf.h"
#include "scene/gltf/model_cache.h"

namespace chromeball {
namespace {

constexpr double kMovingVertex = 80;  // bytes of a key: attributes, and Embree's copy

// The models at a fraction of the shutter's time.
Scene modelsAt(const RenderJob& job, double fraction, const glm::dvec3& origin, ModelCache& cache) {
  SceneFile later = job.file;
  for (ModelEntry& model : later.models)
    if (model.choice.animation) model.choice.animation->seconds += fraction * job.shutter->seconds;
  std::vector<std::string> known;
  return loadModels(later, origin, cache, known);
}

bool isSameView(const Camera& a, const Camera& b) {
  return a.position == b.position && a.right == b.right && a.up == b.up && a.fov == b.fov &&
         a.halfHeight == b.halfHeight;
}

void setMotion(std::vector<Camera> keys, Camera& camera) {
  if (std::ranges::all_of(keys, [&](const Camera& key) { return isSameView(key, camera); })) return;
  camera.motion = std::make_shared<const std::vector<Camera>>(std::move(keys));
}

// The models have one key in memory; they will have one for each step.
void checkMotionMemory(const RenderJob& job, const Scene& scene) {
  double moving = 0;
  for (const Instance& instance : scene.instances)
    if (instance.moves)
      moving += double(scene.meshes[size_t(instance.mesh)].positions.size()) * kMovingVertex;
  const double needed = moving * job.shutter->steps;
  if (needed > memoryLimit(job))
    throw InputError(
        fmt::format("{}: {} steps of what moves take {:.3g} GB of memory; the limit is {:.3g} GB",
                    job.file.settings.location("camera.shutter"), job.shutter->steps, 1e-9 * needed,
                    1e-9 * memoryLimit(job)),
        Remedy{"memory", {}});
}

const std::string& modelOf(const RenderJob& job) { return job.file.models.front().file; }

}  // namespace

void openShutter(const RenderJob& job, PlacedModels& placed, ModelCache& cache) {
  const auto warn = [&](std::vector<std::string> lines) {
    placed.warnings.insert(placed.warnings.end(), lines.begin(), lines.end());
  };
  if (!placed.scene.isAnimated)
    return warn(turnCamera(job, placed.scene, placed.view, placed.origin, placed.camera));
  checkMotionMemory(job, placed.scene);
  const int steps = job.shutter->steps;
  const auto cameraAt = [&](const Scene& scene, double fraction) {
    return cameraOf(job, scene, placed.view, placed.origin, fraction * job.shutter->turn);
  };
  std::vector<Scene> later;
  std::vector<Camera> cameras{placed.camera};
  for (int k = 1; k <= steps; ++k) {
    const double fraction = double(k) / steps;
    later.push_back(modelsAt(job, fraction, placed.origin, cache));
    cameras.push_back(cameraAt(later.back(), fraction));
  }
  setMotion(std::move(cameras), placed.camera);
  for (const std::string& node : addMotion(placed.scene, later))
    placed.warnings.push_back(fmt::format(
        "{}: node `{}` appears, vanishes or is mirrored while the shutter is open; it is "
        "rendered as it was before",
        modelOf(job), node));
  MotionError error;
  error.addTurn(job.shutter->turn, steps);
  for (int k = 0; k < steps; ++k) {
    const double fraction = (k + 0.5) / steps;
    const Scene then = modelsAt(job, fraction, placed.origin, cache);
    error.add(placed.scene, then, float(fraction));
    error.add(placed.camera, cameraAt(then, fraction), float(fraction));
  }
  warn(error.warnings(modelOf(job), steps));
}

std::vector<std::string> turnCamera(const RenderJob& job, const Scene& scene,
                                    const AutomaticView& view, const glm::dvec3& origin,
                                    Camera& camera) {
  const int steps = job.shutter->steps;
  const double turn = job.shutter->turn;
  if (turn == 0) return {};
  const auto cameraAt = [&](double fraction) {
    return cameraOf(job, scene, view, origin, fraction * turn);
  };
  std::vector<Camera> keys{camera};
  for (int k = 1; k <= steps; ++k) keys.push_back(cameraAt(double(k) / steps));
  setMotion(std::move(keys), camera);
  MotionError error;
  error.addTurn(turn, steps);
  for (int k = 0; k < steps; ++k) {
    const double fraction = (k + 0.5) / steps;
    error.add(camera, cameraAt(fraction), float(fraction));
  }
  return error.warnings(modelOf(job), steps);
}

}  // namespace chromeball
