// SPDX-License-Identifier: Apache-2.0
#include "session/open_shutter.h"

#include <algorithm>
#include <set>

#include "animation/scene_motion.h"
#include "base/error.h"
#include "scene/gltf/load_gltf.h"
#include "scene/gltf/model_cache.h"
#include "session/memory_estimate.h"
#include "session/place_models.h"

namespace chromeball {
namespace {

constexpr double kMovingVertex = 80;  // bytes of a key: attributes, and Embree's copy
constexpr size_t kMostChanges = 64;

// The models at a fraction of the shutter's time.
Scene modelsAt(const RenderDescription& description, double fraction, const PlacedModels& placed,
               ModelCache& cache) {
  std::vector<ModelEntry> later = standing(description, description.models, placed.view);
  for (ModelEntry& model : later)
    if (model.choice.animation)
      model.choice.animation->seconds += fraction * description.camera.shutter->seconds();
  std::vector<std::string> known;
  return loadModels(description, later, placed.origin, cache, known);
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
void checkMotionMemory(const RenderDescription& description, const Scene& scene) {
  double moving = 0;
  for (const Instance& instance : scene.instances)
    if (instance.moves)
      moving += double(scene.meshes[size_t(instance.mesh)].positions.size()) * kMovingVertex;
  const double needed = moving * description.camera.shutter->steps;
  checkMemory(description, needed, "{}: {} steps of what moves take {:.3g} GB of memory",
              description.origins.of("camera.shutter"), description.camera.shutter->steps,
              1e-9 * needed);
}

std::string modelOf(const RenderDescription& description) { return description.sceneName(); }

// `halfSteps`: the camera at the keys and half-way between them, from the opening to the closing.
void moveCamera(const Shutter& shutter, const std::vector<Camera>& halfSteps, Camera& camera,
                MotionError& error) {
  std::vector<Camera> keys;
  for (size_t i = 0; i < halfSteps.size(); i += 2) keys.push_back(halfSteps[i]);
  setMotion(std::move(keys), camera);
  error.addTurn(shutter.turn, shutter.steps);
  for (size_t i = 1; i < halfSteps.size(); i += 2)
    error.add(camera, halfSteps[i], float(i) / float(halfSteps.size() - 1));
}

}  // namespace

void openShutter(const RenderDescription& description, PlacedModels& placed, ModelCache& cache) {
  const auto warn = [&](std::vector<std::string> lines) {
    placed.warnings.insert(placed.warnings.end(), lines.begin(), lines.end());
  };
  if (!placed.scene.isAnimated)
    return warn(turnCamera(description, placed.scene, placed.view, placed.origin, placed.camera));
  checkMotionMemory(description, placed.scene);
  const int steps = description.camera.shutter->steps;
  std::vector<Camera> cameras(2 * size_t(steps) + 1, placed.camera);  // at half steps
  const auto modelsAtHalfStep = [&](int i) {
    const double fraction = double(i) / (2 * steps);
    Scene scene = modelsAt(description, fraction, placed, cache);
    cameras[size_t(i)] = cameraOf(description, scene, placed.view, placed.origin,
                                  fraction * description.camera.shutter->turn);
    return scene;
  };
  std::vector<Scene> later;
  for (int k = 1; k <= steps; ++k) later.push_back(modelsAtHalfStep(2 * k));
  for (const std::string& node : addMotion(placed.scene, later))
    placed.warnings.push_back(fmt::format(
        "{}: node `{}` appears, vanishes or is mirrored while the shutter is open; it is "
        "rendered as it was before",
        modelOf(description), node));
  // Checked also where no key differs: an object that turns by whole turns between keys seems to
  // stand still.
  MotionError error;
  for (int k = 0; k < steps; ++k)
    error.add(placed.scene, modelsAtHalfStep(2 * k + 1), float((k + 0.5) / steps));
  const double open = description.camera.shutter->seconds();
  const std::vector<double> changes =  // between which and the keys models may come back
      timesOfChange(description.models, open, kMostChanges, cache);
  for (const double seconds : changes)
    error.add(placed.scene, modelsAt(description, seconds / open, placed, cache),
              float(seconds / open));
  placed.moves = placed.scene.moves || !changes.empty();
  moveCamera(*description.camera.shutter, cameras, placed.camera, error);
  warn(error.warnings(modelOf(description), steps));
}

std::vector<std::string> turnCamera(const RenderDescription& description, const Scene& scene,
                                    const AutomaticView& view, const glm::dvec3& origin,
                                    Camera& camera) {
  const Shutter& shutter = *description.camera.shutter;
  if (shutter.turn == 0) return {};
  std::vector<Camera> cameras;
  for (int i = 0; i <= 2 * shutter.steps; ++i)
    cameras.push_back(
        cameraOf(description, scene, view, origin, shutter.turn * i / (2 * shutter.steps)));
  MotionError error;
  moveCamera(shutter, cameras, camera, error);
  return error.warnings(modelOf(description), shutter.steps);
}

std::vector<ModelEntry> modelsAt(std::vector<ModelEntry> models, double seconds) {
  for (ModelEntry& model : models)
    if (model.choice.animation) model.choice.animation->seconds = seconds;
  return models;
}

std::vector<double> timesOfChange(const std::vector<ModelEntry>& models, double seconds,
                                  size_t most, ModelCache& cache) {
  std::set<double> all;
  for (const ModelEntry& model : models) {
    GltfChoice choice = model.choice;
    choice.cache = &cache;
    for (const double change : animationChanges(model.file, choice, seconds)) all.insert(change);
  }
  std::vector<double> some;
  size_t i = 0;
  for (const double time : all)
    if (i++ * most / std::max(all.size(), most) >= some.size()) some.push_back(time);
  return some;
}

}  // namespace chromeball
