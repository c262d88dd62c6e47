// SPDX-License-Identifier: Apache-2.0
#include "job/load_scene.h"

#include <algorithm>
#include <cassert>

#include "base/error.h"
#include "job/choose_camera.h"
#include "job/load_messages.h"
#include "job/memory_estimate.h"
#include "job/scene_lighting.h"
#include "scene/bounds.h"
#include "scene/gltf/load_gltf.h"
#include "scene/gltf/model_cache.h"
#include "scene/thin_wall.h"

namespace chromeball {
namespace {

Scene loadModels(const SceneFile& file, const glm::dvec3& origin, ModelCache& cache,
                 std::vector<std::string>& warnings) {
  Scene scene;
  const auto add = [&](const std::string& line) {
    if (std::ranges::find(warnings, line) == warnings.end()) warnings.push_back(line);
  };
  for (const ModelEntry& model : file.models) {
    GltfChoice choice = model.choice;
    choice.origin = origin;
    choice.cache = &cache;
    choice.environment = !file.settings.has("probe.file");
    append(scene, loadGltf(model.file, model.placement, add, choice));
  }
  if (scene.instances.empty())
    throwInput("{}: the model has no triangles to render", file.models.front().file);
  const float factor = float(file.settings.get<double>("lighting.lights"));
  if (factor == 0) scene.lights.clear();
  for (PunctualLight& light : scene.lights) light.intensity *= factor;
  return scene;
}

// The origin of the scene's coordinates in the world. Floats have a relative precision of 1e-7, so
// a scene that is small compared with its distance from the origin is moved to its own centre. The
// distant probe is not affected.
glm::dvec3 originFor(const Scene& scene, const std::string& file) {
  constexpr float kMaxReach = 1e9f, kFar = 1000;
  const Bounds box = bounds(scene);
  const vec3 reach = glm::max(glm::abs(box.min), glm::abs(box.max));
  if (!(maxComponent(reach) < kMaxReach))
    throwInput("{}: reaches {:.3g} m from the origin; the limit is {:.0e}: scale it down", file,
               maxComponent(reach), kMaxReach);
  const glm::dvec3 centre = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
  return glm::length(centre) > kFar * glm::length(box.size()) ? centre : glm::dvec3(0);
}

// The job's size; else the default height, with the aspect ratio of the model's camera. Throws
// InputError if the image does not fit into the job's memory.
void chooseSize(RenderJob& job, const Scene& scene) {
  RenderSettings& settings = job.settings;
  if (job.size) {
    settings.width = job.size->width;
    settings.height = job.size->height;
  } else if (!job.file.camera && !scene.cameras.empty()) {
    const float aspect = chooseCamera(job, scene, {}).aspect;
    if (aspect > 0.05f && aspect < 20)
      settings.width = std::max(1, int(std::lround(aspect * float(settings.height))));
  }
  if (const auto& crop = settings.crop)
    if (crop->x + crop->width > settings.width || crop->y + crop->height > settings.height)
      throwInput("{}: is not within the image of {}x{} pixels", job.file.settings.location("crop"),
                 settings.width, settings.height);
  const Settings& given = job.file.settings;
  const double needed = imageBytes(job), budget = memoryLimit(job);
  if (needed > budget)
    throw InputError(
        fmt::format("{}an image of {}x{} takes {:.3g} GB of memory; the limit is {:.3g} GB",
                    given.has("render.size") ? given.location("render.size") + ": " : "",
                    settings.width, settings.height, needed * 1e-9, budget * 1e-9),
        Remedy{"memory", {}});
}

// Null unless the surroundings are a model.
std::unique_ptr<const Room> loadRoom(const RenderJob& job, const glm::dvec3& origin,
                                     ModelCache& cache, std::vector<std::string>& files) {
  const auto& surroundings = job.file.surroundings;
  if (!surroundings || surroundings->shape != Surroundings::Shape::Model) return nullptr;
  GltfChoice choice = job.file.models.front().choice;
  choice.animation.reset();
  choice.variant.reset();
  choice.environment = false;
  choice.origin = origin;
  choice.cache = &cache;
  Scene model = loadGltf(
      surroundings->model, {}, [](const std::string&) {}, choice);
  files.insert(files.end(), model.files.begin(), model.files.end());
  return std::make_unique<const Room>(std::move(model), surroundings->capture, surroundings->model);
}

// The models in the scene's coordinates, with the scene file's lamps.
struct PlacedModels {
  Scene scene;
  Camera camera;
  AutomaticView view;
  glm::dvec3 origin{0};
  std::vector<std::string> warnings;
};

// Moves what the scene file places in the world to the scene's coordinates.
void moveToOrigin(RenderJob& job, const glm::dvec3& origin) {
  if (job.file.camera) job.file.camera->position -= vec3(origin);
  if (job.file.surroundings) job.file.surroundings->move(-vec3(origin));
}

PlacedModels modelsAtOrigin(const SceneFile& file, ModelCache& cache) {
  PlacedModels placed;
  placed.scene = loadModels(file, placed.origin, cache, placed.warnings);
  placed.origin = originFor(placed.scene, file.models.front().file);
  if (placed.origin != glm::dvec3(0))
    placed.scene = loadModels(file, placed.origin, cache, placed.warnings);
  return placed;
}

// That of time 0, also in the coordinates of that time: with the same rounding for all times.
AutomaticView viewAtStart(const RenderJob& job, const PlacedModels& now, ModelCache& cache) {
  if (job.view) return *job.view;
  const AutomaticView view = automaticView(job, now.scene, now.origin);
  if (!now.scene.isAnimated || !(view.camera || job.file.settings.has("orbit"))) return view;
  SceneFile start = job.file;
  for (ModelEntry& model : start.models)
    if (model.choice.animation) model.choice.animation->seconds = 0;
  const PlacedModels first = modelsAtOrigin(start, cache);
  return automaticView(job, first.scene, first.origin);
}

Camera cameraOf(const RenderJob& job, const Scene& scene, const AutomaticView& view,
                const glm::dvec3& origin) {
  const AutomaticView here = view.seenFrom(origin);
  const Camera camera = chooseCamera(job, scene, here);
  if (!fillsImage(camera, double(job.settings.width) / job.settings.height))
    throwInput(
        "{}: the image folds back inside the frame, where (1 + k1 r^2 + k2 r^4) r does not "
        "ascend; `distortion` may be for another `fov`",
        job.file.optics->location);
  return camera.turnedAround(here.centre,
                             job.file.settings.getIfGiven<double>("orbit").value_or(0));
}

PlacedModels placeModels(RenderJob& job, ModelCache& cache) {
  PlacedModels placed = modelsAtOrigin(job.file, cache);
  if (placed.origin != glm::dvec3(0)) moveToOrigin(job, placed.origin);
  Scene& scene = placed.scene;
  chooseSize(job, scene);
  placed.view = viewAtStart(job, placed, cache);
  placed.camera = cameraOf(job, scene, placed.view, placed.origin);
  for (const Lamp& lamp : job.file.lamps) addLamp(scene, lamp, placed.origin);
  removeLamps(job, scene);
  for (Material& material : scene.materials) material.singleSided = job.singleSided;
  if (job.straightGlassShadows) passShadowsStraight(scene.materials);
  return placed;
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

// Whether rays see the same: materials are not animated, and new ones come with their instances.
bool isSameWorld(const Scene& a, const Scene& b) {
  return a.instances == b.instances && a.lights == b.lights && a.meshes == b.meshes;
}

void checkInside(const Scene& scene, Surroundings surroundings, const std::string& file) {
  surroundings.grow(1e-4f);  // objects on the floor touch it
  for (const Instance& instance : scene.instances)
    for (const vec3& position : scene.meshes[instance.mesh].positions)
      if (const vec3 p = instance.point(position); !surroundings.contains(p))
        throwInput("{}: the model must lie inside [surroundings]; it reaches to ({:g}, {:g}, {:g})",
                   file, p.x, p.y, p.z);
}

}  // namespace

LoadedScene loadScene(RenderJob& job, ModelCache* shared) {
  ModelCache own;
  ModelCache& cache = shared ? *shared : own;
  if (const auto limit = job.file.settings.getIfGiven<double>("texture-memory"))
    cache.texels.memory = 1e9 * *limit;
  cache.texels.limit = memoryLimit(job);
  PlacedModels models = placeModels(job, cache);
  Scene& scene = models.scene;
  std::vector<std::string> files = scene.files;
  const auto& lists = job.file.lightLists;
  files.insert(files.end(), lists.begin(), lists.end());
  const Settings& settings = job.file.settings;
  if (const auto path = settings.getIfGiven<std::string>("probe.file")) files.push_back(*path);
  if (const auto path = settings.getIfGiven<std::string>("camera.file")) files.push_back(*path);
  if (const auto path = settings.getIfGiven<std::string>("composite.plate")) files.push_back(*path);
  std::unique_ptr<const Room> room = loadRoom(job, models.origin, cache, files);
  if (job.file.surroundings && !room)
    checkInside(scene, *job.file.surroundings, job.file.models.front().file);
  LoadedProbe loaded = loadProbeOf(job, scene);
  Probe probe = probeOf(job, loaded);
  std::optional<ProbeSources> sources = sourcesOf(job, loaded, probe);
  LoadedScene result{std::move(scene),
                     models.camera,
                     models.view,
                     std::move(loaded),
                     std::move(probe),
                     job.file.surroundings,
                     std::move(room),
                     models.origin,
                     std::move(sources),
                     settings.getIfGiven<double>("lighting.sun_angle"),
                     settings.get<bool>("lighting.show_lights"),
                     std::move(files)};
  if (job.composite) {
    prepareLocalScene(job, result);
    scaleProbeByPlate(job, result);
  }
  checkMemory(job, result);
  const Messages found = loadMessages(job, result, models.warnings);
  result.messages.insert(result.messages.end(), found.begin(), found.end());
  return result;
}

FrameChange loadFrame(RenderJob& job, LoadedScene& loaded, ModelCache& cache) {
  assert(!job.composite);
  FrameChange change;
  if (!(loaded.probe.rotation() == rotationOf(job))) {
    loaded.loadedProbe = loadProbeOf(job, loaded.scene);
    loaded.probe = probeOf(job, loaded.loadedProbe);
    loaded.sources = sourcesOf(job, loaded.loadedProbe, loaded.probe);
    change.lighting = true;
  }
  if (!loaded.scene.isAnimated) {
    chooseSize(job, loaded.scene);
    moveToOrigin(job, loaded.origin);
    loaded.camera = cameraOf(job, loaded.scene, loaded.view, loaded.origin);
    return change;
  }
  PlacedModels models = placeModels(job, cache);
  if (job.file.surroundings && !loaded.room)
    checkInside(models.scene, *job.file.surroundings, job.file.models.front().file);
  loaded.view = models.view;
  loaded.camera = models.camera;
  if (!job.file.settings.has("probe.file") && !models.scene.environment)
    checkLit(job, models.scene);
  shareMeshes(loaded.scene, models.scene);
  change.geometry = models.origin != loaded.origin || !isSameWorld(models.scene, loaded.scene);
  if (change.geometry) loaded.scene = std::move(models.scene);
  if (models.origin != loaded.origin) {
    change.lighting = true;
    loaded.origin = models.origin;
    loaded.surroundings = job.file.surroundings;
    std::vector<std::string> known;
    loaded.room = loadRoom(job, loaded.origin, cache, known);
  }
  checkMemory(job, loaded);
  loaded.messages = loadMessages(job, loaded, models.warnings);
  return change;
}

}  // namespace chromeball
