// SPDX-License-Identifier: Apache-2.0
#include "session/load_scene.h"

#include <algorithm>
#include <cassert>

#include "base/error.h"
#include "base/progress.h"
#include "description/capabilities.h"
#include "scene/gltf/load_gltf.h"
#include "scene/gltf/model_cache.h"
#include "session/memory_estimate.h"
#include "session/place_models.h"
#include "session/run_composite.h"
#include "session/scene_lighting.h"

namespace chromeball {
namespace {

// Null unless the surroundings are a model.
std::unique_ptr<const Room> loadRoom(const RenderDescription& job, const glm::dvec3& origin,
                                     ModelCache& cache, std::vector<std::string>& files) {
  const auto& surroundings = job.surroundings;
  if (!surroundings || surroundings->shape.shape != Surroundings::Shape::Model) return nullptr;
  GltfChoice choice = job.models.empty() ? GltfChoice() : job.models.front().choice;
  choice.animation.reset();
  choice.variant.reset();
  choice.environment = false;
  choice.origin = origin;
  choice.cache = &cache;
  Scene model = loadGltf(
      surroundings->shape.model, {}, [](const std::string&) {}, choice);
  files.insert(files.end(), model.files.begin(), model.files.end());
  return std::make_unique<const Room>(std::move(model), surroundings->relativeTo(origin).capture,
                                      surroundings->shape.model);
}

std::optional<Surroundings> surroundingsOf(const RenderDescription& job, const glm::dvec3& origin) {
  if (!job.surroundings) return {};
  return job.surroundings->relativeTo(origin);
}

// Gives `scene` the meshes of an earlier one where they are equal and do not move: lamps.
void shareMeshes(const Scene& earlier, Scene& scene) {
  for (const Instance& instance : scene.instances) {
    const size_t i = size_t(instance.mesh);
    if (!instance.moves && i < earlier.meshes.size() &&
        scene.meshes.shared(i) != earlier.meshes.shared(i) && scene.meshes[i] == earlier.meshes[i])
      scene.meshes.share(i, earlier.meshes.shared(i));
  }
}

// Whether rays see the same scene: materials are not animated, and new ones come with their
// instances.
bool isSameWorld(const Scene& a, const Scene& b) {
  return a.instances == b.instances && a.lights == b.lights && a.meshes == b.meshes;
}

void checkInside(const Scene& scene, Surroundings surroundings, const std::string& file) {
  surroundings.grow(1e-4f);  // objects on the floor touch it
  const auto check = [&](const vec3& p) {
    if (!surroundings.contains(p))
      throwInput("{}: the model must lie inside [surroundings]; it reaches to ({:g}, {:g}, {:g})",
                 file, p.x, p.y, p.z);
  };
  for (const Instance& instance : scene.instances) {
    const uint32_t vertices = uint32_t(scene.meshes[instance.mesh].positions.size());
    for (const vec3& position : scene.meshes[instance.mesh].positions)
      check(instance.point(position));
    if (instance.motion)
      for (const InstanceMotion::Key& key : instance.motion->keys)
        for (uint32_t i = 0; i < vertices; ++i) check(key.point(i));
  }
}

// Replaces a name in the list of files that were read.
void replaceFile(const std::optional<std::string>& earlier, const std::optional<std::string>& file,
                 std::vector<std::string>& files) {
  const auto at = earlier ? std::ranges::find(files, *earlier) : files.end();
  if (at == files.end()) {
    if (file) files.push_back(*file);
  } else if (file) {
    *at = *file;
  } else {
    files.erase(at);
  }
}

// The probe, if it has turned or is another one. An exception leaves everything unchanged.
void replaceProbe(const RenderDescription& job, LoadedScene& loaded, FrameChange& change) {
  const ProbeDescription earlier = loaded.description.probe;
  const ProbeDescription& probe = job.probe;
  const bool isOther = probe.file != earlier.file || probe.map != earlier.map ||
                       probe.mapping != earlier.mapping || probe.scale != earlier.scale;
  if (!isOther && loaded.probe.rotation() == probe.rotation) return;
  if (isOther) {
    LoadedProbe read = loadProbeOf(job, loaded.scene);
    Probe replaced = probeOf(job, read);
    loaded.sources = sourcesOf(job, read, replaced);
    replaceFile(earlier.file, probe.file, loaded.files);
    loaded.loadedProbe = std::move(read);
    loaded.probe = std::move(replaced);
    change.probe = true;
  } else {
    loaded.probe.turnTo(probe.rotation);
    if (loaded.sources) loaded.sources->remainder.turnTo(probe.rotation);
  }
  change.lighting = true;
}

void replaceModels(RenderDescription& job, LoadedScene& loaded, ModelCache& cache,
                   FrameChange& change) {
  PlacedModels models = placeModels(job, cache, &loaded.view);
  if (job.surroundings && !loaded.room)
    checkInside(models.scene, *surroundingsOf(job, models.origin), job.sceneName());
  loaded.view = models.view;
  loaded.camera = models.camera;
  loaded.hasModelLights = models.hasLights;
  loaded.moves = models.moves;
  loaded.modelWarnings = std::move(models.warnings);
  if (!job.probe.file && !models.scene.environment) checkLit(job, models.scene);
  shareMeshes(loaded.scene, models.scene);
  change.geometry = models.origin != loaded.origin || !isSameWorld(models.scene, loaded.scene);
  if (change.geometry) loaded.scene = std::move(models.scene);
  if (models.origin != loaded.origin) {
    change.lighting = true;
    loaded.origin = models.origin;
    loaded.surroundings = surroundingsOf(job, loaded.origin);
    std::vector<std::string> known;
    loaded.room = loadRoom(job, loaded.origin, cache, known);
  }
}

}  // namespace

LoadedScene loadScene(const RenderDescription& description, ModelCache* shared,
                      const AutomaticView* view) {
  checkCapabilities(description);
  RenderDescription job = description;
  ModelCache own;
  ModelCache& cache = shared ? *shared : own;
  if (job.run.textureMemory) cache.texels.memory = *job.run.textureMemory;
  cache.texels.limit = memoryLimit(job);
  PlacedModels models = placeModels(job, cache, view);
  Scene& scene = models.scene;
  std::vector<std::string> files = scene.files;
  const auto& lists = job.lightLists;
  files.insert(files.end(), lists.begin(), lists.end());
  if (job.probe.file) files.push_back(*job.probe.file);
  if (job.camera.file) files.push_back(*job.camera.file);
  if (job.composite && job.composite->plateFile) files.push_back(*job.composite->plateFile);
  std::unique_ptr<const Room> room = loadRoom(job, models.origin, cache, files);
  if (job.surroundings && !room)
    checkInside(scene, *surroundingsOf(job, models.origin), job.sceneName());
  if (job.surroundings && !job.probe.file && !job.probe.map && !scene.environment)
    throwInput("{}: [surroundings] needs a probe", job.origins.of("surroundings"));
  LoadedProbe loaded = loadProbeOf(job, scene);
  Probe probe = probeOf(job, loaded);
  std::optional<ProbeSources> sources = sourcesOf(job, loaded, probe);
  LoadedScene result{{},
                     std::move(scene),
                     models.camera,
                     models.view,
                     std::move(loaded),
                     std::move(probe),
                     surroundingsOf(job, models.origin),
                     std::move(room),
                     models.hasLights,
                     models.moves,
                     models.origin,
                     std::move(sources),
                     std::move(files)};
  result.modelWarnings = std::move(models.warnings);
  result.description = std::move(job);
  if (result.description.composite) {
    reportWork("local scene", 0);
    prepareLocalScene(result);
    scaleProbeByPlate(result);
  }
  checkMemory(result);
  const Messages found = loadMessages(result);
  result.messages.insert(result.messages.end(), found.begin(), found.end());
  return result;
}

FrameChange loadFrame(const RenderDescription& description, LoadedScene& loaded,
                      ModelCache& cache) {
  assert(!description.composite);
  RenderDescription job = description;
  FrameChange change;
  if (loaded.scene.isAnimated) {
    replaceProbe(job, loaded, change);
    replaceModels(job, loaded, cache, change);
  } else {
    const Camera camera = placeCamera(job, loaded.scene, loaded.view, loaded.origin);
    replaceProbe(job, loaded, change);
    loaded.camera = camera;
  }
  loaded.description = std::move(job);
  checkMemory(loaded);
  loaded.messages = loadMessages(loaded);
  return change;
}

}  // namespace chromeball
