// SPDX-License-Identifier: Apache-2.0
#include "job/open_shutter.h"

#include <algorithm>

#include "base/error.h"
#include "job/memory_estimate.h"
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

void warnOfDeviation(const RenderJob& job, const MotionError& error,
                     std::vector<std::string>& warnings) {
  constexpr double kTolerance = 0.005;
  if (error.deviation <= kTolerance * error.farthest) return;
  warnings.push_back(fmt::format(
      "{}: the models move by up to {:.2g} m while the shutter is open, and {} straight steps miss "
      "their way by up to {:.2g} m; --shutter-steps {} is closer",
      job.file.models.front().file, error.farthest, job.shutter->steps, error.deviation,
      std::min(4 * job.shutter->steps, kMostMotionSteps)));
}

}  // namespace

void openShutter(const RenderJob& job, PlacedModels& placed, ModelCache& cache) {
  if (!placed.scene.isAnimated)
    return moveCamera(job, placed.scene, placed.view, placed.origin, placed.camera);
  checkMotionMemory(job, placed.scene);
  const int steps = job.shutter->steps;
  std::vector<Scene> later;
  std::vector<Camera> cameras{placed.camera};
  for (int k = 1; k <= steps; ++k) {
    const double fraction = double(k) / steps;
    later.push_back(modelsAt(job, fraction, placed.origin, cache));
    cameras.push_back(
        cameraOf(job, later.back(), placed.view, placed.origin, fraction * job.shutter->turn));
  }
  setMotion(std::move(cameras), placed.camera);
  for (const std::string& node : addMotion(placed.scene, later))
    placed.warnings.push_back(fmt::format(
        "{}: node `{}` appears, vanishes or is mirrored while the shutter is open; it is "
        "rendered as it was before",
        job.file.models.front().file, node));
  if (!placed.scene.moves) return;
  MotionError error;
  for (int k = 0; k < steps; ++k) {
    const double fraction = (k + 0.5) / steps;
    error.add(placed.scene, modelsAt(job, fraction, placed.origin, cache), float(fraction));
  }
  warnOfDeviation(job, error, placed.warnings);
}

void moveCamera(const RenderJob& job, const Scene& scene, const AutomaticView& view,
                const glm::dvec3& origin, Camera& camera) {
  const Shutter& shutter = *job.shutter;
  if (shutter.turn == 0) return;
  std::vector<Camera> keys{camera};
  for (int k = 1; k <= shutter.steps; ++k)
    keys.push_back(cameraOf(job, scene, view, origin, shutter.turn * k / shutter.steps));
  setMotion(std::move(keys), camera);
}

}  // namespace chromeball
