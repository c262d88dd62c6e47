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
std::unique_ptr<const Room> loadRoom(const RenderDescription& description, const glm::dvec3& origin,
                                     ModelCache& cache, std::vector<std::string>& files) {
  const auto& surroundings = description.surroundings;
  if (!surroundings || surroundings->shape.shape != Surroundings::Shape::Model) return nullptr;
  GltfChoice choice = description.models.empty() ? GltfChoice() : description.models.front().choice;
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

std::optional<Surroundings> surroundingsOf(const RenderDescription& description,
                                           const glm::dvec3& origin) {
  if (!description.surroundings) return {};
  return description.surroundings->relativeTo(origin);
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

// Replaces the probe's names in the list of files that were read.
void replaceFiles(const std::vector<std::string>& earlier, const std::vector<std::string>& probe,
                  std::vector<std::string>& files) {
  auto at = earlier.empty()
                ? files.end()
                : std::search(files.begin(), files.end(), earlier.begin(), earlier.end());
  if (at != files.end()) at = files.erase(at, at + std::ptrdiff_t(earlier.size()));
  files.insert(at, probe.begin(), probe.end());
}

// The probe, if it has turned, is another one or shall be read again. An exception leaves
// everything unchanged.
void replaceProbe(const RenderDescription& description, bool readsAgain, LoadedScene& loaded,
                  FrameChange& change) {
  const ProbeDescription earlier = loaded.description.probe;
  const ProbeDescription& probe = description.probe;
  const bool isOther = readsAgain || probe.file != earlier.file || probe.map != earlier.map ||
                       probe.mapping != earlier.mapping || probe.scale != earlier.scale;
  if (!isOther && loaded.probe.rotation() == probe.rotation) return;
  if (isOther) {
    LoadedProbe read = loadProbeOf(description, loaded.scene);
    Probe replaced = probeOf(description, read);
    loaded.sources = sourcesOf(description, read, replaced);
    replaceFiles(loaded.loadedProbe.files, read.files, loaded.files);
    loaded.loadedProbe = std::move(read);
    loaded.probe = std::move(replaced);
    change.probe = true;
  } else {
    loaded.probe.turnTo(probe.rotation);
    if (loaded.sources) loaded.sources->remainder.turnTo(probe.rotation);
  }
  change.lighting = true;
}

void replaceModels(RenderDescription& description, LoadedScene& loaded, ModelCache& cache,
                   FrameChange& change) {
  PlacedModels models = placeModels(description, cache, &loaded.view);
  if (description.surroundings && !loaded.room)
    checkInside(models.scene, *surroundingsOf(description, models.origin), description.sceneName());
  loaded.view = models.view;
  loaded.camera = models.camera;
  loaded.hasModelLights = models.hasLights;
  loaded.moves = models.moves;
  loaded.modelWarnings = std::move(models.warnings);
  if (!description.probe.file && !description.probe.map && !models.scene.environment)
    checkLit(description, models.scene);
  shareMeshes(loaded.scene, models.scene);
  change.geometry = models.origin != loaded.origin || !isSameWorld(models.scene, loaded.scene);
  if (change.geometry) loaded.scene = std::move(models.scene);
  if (models.origin != loaded.origin) {
    change.lighting = true;
    loaded.origin = models.origin;
    loaded.surroundings = surroundingsOf(description, loaded.origin);
    std::vector<std::string> known;
    loaded.room = loadRoom(description, loaded.origin, cache, known);
  }
}

}  // namespace

LoadedScene loadScene(const RenderDescription& given, ModelCache* shared,
                      const AutomaticView* view) {
  checkNumbers(given);
  checkCapabilities(given);
  RenderDescription description = given;
  ModelCache own;
  ModelCache& cache = shared ? *shared : own;
  if (description.run.textureMemory) cache.texels.memory = *description.run.textureMemory;
  cache.texels.limit = memoryLimit(description);
  PlacedModels models = placeModels(description, cache, view);
  Scene& scene = models.scene;
  std::vector<std::string> files = scene.files;
  const auto& lists = description.lightLists;
  files.insert(files.end(), lists.begin(), lists.end());
  const auto beforeProbe = ptrdiff_t(files.size());
  if (description.camera.file) files.push_back(*description.camera.file);
  if (description.composite && description.composite->plateFile)
    files.push_back(*description.composite->plateFile);
  std::unique_ptr<const Room> room = loadRoom(description, models.origin, cache, files);
  if (description.surroundings && !room)
    checkInside(scene, *surroundingsOf(description, models.origin), description.sceneName());
  if (description.surroundings && !description.probe.file && !description.probe.map &&
      !scene.environment)
    throwInput("{}: [surroundings] needs a probe", description.origins.of("surroundings"));
  LoadedProbe loaded = loadProbeOf(description, scene);
  files.insert(files.begin() + beforeProbe, loaded.files.begin(), loaded.files.end());
  Probe probe = probeOf(description, loaded);
  std::optional<ProbeSources> sources = sourcesOf(description, loaded, probe);
  LoadedScene result{{},
                     std::move(scene),
                     models.camera,
                     models.view,
                     std::move(loaded),
                     std::move(probe),
                     surroundingsOf(description, models.origin),
                     std::move(room),
                     models.hasLights,
                     models.moves,
                     models.origin,
                     std::move(sources),
                     std::move(files)};
  result.modelWarnings = std::move(models.warnings);
  result.description = std::move(description);
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

FrameChange loadFrame(const RenderDescription& given, LoadedScene& loaded, ModelCache& cache,
                      bool readsProbe) {
  assert(!given.composite);
  RenderDescription description = given;
  FrameChange change;
  if (loaded.scene.isAnimated ||
      description.stand.turntable != loaded.description.stand.turntable) {
    replaceProbe(description, readsProbe, loaded, change);
    replaceModels(description, loaded, cache, change);
  } else {
    const Camera camera = placeCamera(description, loaded.scene, loaded.view, loaded.origin);
    replaceProbe(description, readsProbe, loaded, change);
    loaded.camera = camera;
    if (description.choosesSides) description.singleSided = loaded.description.singleSided;
  }
  loaded.description = std::move(description);
  checkMemory(loaded);
  loaded.messages = loadMessages(loaded);
  return change;
}

}  // namespace chromeball
