// SPDX-License-Identifier: Apache-2.0
#include "job/load_scene.h"

#include <algorithm>

#include "base/error.h"
#include "base/suggest.h"
#include "composite/render_composite.h"
#include "job/picture_memory.h"
#include "lighting/finite_surroundings.h"
#include "scene/framing.h"
#include "scene/gltf/load_gltf.h"

namespace chromeball {
namespace {

constexpr double kWorthSaying = 1e9;  // bytes

Scene loadModels(const SceneFile& file, const glm::dvec3& origin,
                 std::vector<std::string>& warnings) {
  Scene scene;
  warnings.clear();
  const auto add = [&](const std::string& line) { warnings.push_back(line); };
  for (const ModelEntry& model : file.models) {
    GltfChoice choice = model.choice;
    choice.origin = origin;
    choice.environment = !file.probe;
    append(scene, loadGltf(model.file, model.placement, add, choice));
  }
  if (scene.instances.empty())
    throwInput("{}: the model has no triangles to render", file.models.front().file);
  const float factor = file.modelLights.value_or(1);
  if (factor == 0) scene.lights.clear();
  for (PunctualLight& light : scene.lights) light.intensity *= factor;
  return scene;
}

// A float tells points apart that differ by 1e-7 of their distance from the origin. A scene much
// farther from there than it is large is seen from its own centre instead; a probe, infinitely far
// away, looks the same.
glm::dvec3 originFor(const Scene& scene, const std::string& file) {
  constexpr float kFarthest = 1e9f, kFar = 1000;
  const Bounds box = bounds(scene);
  const vec3 reach = glm::max(glm::abs(box.min), glm::abs(box.max));
  if (!(maxComponent(reach) < kFarthest))
    throwInput(
        "{}: reaches {:.3g} m from the origin; at most {:.0e} can be rendered: scale it down", file,
        maxComponent(reach), kFarthest);
  const glm::dvec3 centre = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
  const double size = glm::length(glm::dvec3(box.max) - glm::dvec3(box.min));
  return glm::length(centre) > kFar * size ? centre : glm::dvec3(0);
}

// The probe as a lat-long map: the file that was named, else the model's own; black where the scene
// lights itself.
LoadedProbe loadProbeOf(const RenderJob& job, Scene& scene) {
  const SceneFile& file = job.file;
  if (!file.probe && scene.environment) {
    LoadedProbe own;
    own.latLong = std::move(*scene.environment);
    return own;
  }
  if (!file.probe) {
    const bool lit =
        !scene.lights.empty() || std::any_of(scene.materials.begin(), scene.materials.end(),
                                             [](const Material& m) { return m.emits(); });
    if (!lit) throwInput("{}: nothing lights the scene; give --probe FILE", file.models[0].file);
    LoadedProbe black;
    black.latLong = Image(2, 1, 3);
    return black;
  }
  const NamedSetting mapping = file.probeMapping.value_or(NamedSetting{"auto", "--probe-mapping"});
  return loadProbe(*file.probe, mapping.name, mapping.location);
}

Camera chooseCamera(const RenderJob& job, const Scene& scene) {
  if (job.file.camera) return *job.file.camera;
  if (const auto& wanted = job.file.cameraName) {
    std::vector<std::string_view> names;
    for (const auto name : {&Camera::name, &Camera::node})
      for (const Camera& camera : scene.cameras) {
        if (camera.*name == wanted->name) return camera;
        if (std::count(names.begin(), names.end(), camera.*name) == 0)
          names.push_back(camera.*name);
      }
    throwInput("{}: the model has no camera `{}`; {}", wanted->location, wanted->name,
               names.empty() ? "it has none at all" : didYouMean(wanted->name, names));
  }
  if (!scene.cameras.empty()) return scene.cameras.front();
  const RenderSettings& s = job.settings;
  return framingCamera(scene, float(s.width) / float(s.height));
}

Camera withLens(const RenderJob& job, Camera camera) {
  const auto& lens = job.file.lens;
  if (!lens) return camera;
  if (camera.orthographic)
    throwInput("{}: an orthographic camera has no lens; leave out `aperture` and `focus`",
               lens->location);
  camera.lensRadius = 0.5f * lens->aperture;
  camera.focus = lens->focus;
  return camera;
}

bool hasBodies(const Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& i) {
    return scene.materials[size_t(i.material)].isBody();
  });
}

// The size asked for; else the default height, as wide as the model's camera would have it.
void chooseSize(RenderJob& job, const Scene& scene) {
  RenderSettings& settings = job.settings;
  if (job.size) {
    settings.width = job.size->width;
    settings.height = job.size->height;
  } else if (!job.file.camera && !scene.cameras.empty()) {
    const float aspect = chooseCamera(job, scene).aspect;
    if (aspect > 0.05f && aspect < 20)
      settings.width = std::max(1, int(std::lround(aspect * float(settings.height))));
  }
  const double composite = job.file.composite ? double(compositeBytesPerPixel()) : 0;
  const double needed = pictureBytes(settings) + composite * settings.width * settings.height;
  const double budget = job.memory.value_or(memoryBudget());
  if (needed > budget)
    throwInput(
        "--size: a picture of {}x{} takes {:.3g} GB of memory, and {:.3g} may be used; "
        "--memory GB changes that",
        settings.width, settings.height, needed * 1e-9, budget * 1e-9);
}

// Null where the surroundings are no model.
std::unique_ptr<const Room> loadRoom(const RenderJob& job, const glm::dvec3& origin,
                                     std::vector<std::string>& files) {
  const auto& surroundings = job.file.surroundings;
  if (!surroundings || surroundings->shape != Surroundings::Shape::Model) return nullptr;
  GltfChoice choice = job.file.models.front().choice;
  choice.animation.reset();
  choice.variant.reset();
  choice.environment = false;
  choice.origin = origin;
  Scene model = loadGltf(
      surroundings->model, {}, [](const std::string&) {}, choice);
  files.insert(files.end(), model.files.begin(), model.files.end());
  return std::make_unique<const Room>(std::move(model), surroundings->capture, surroundings->model);
}

void checkInside(const Scene& scene, Surroundings surroundings, const std::string& file) {
  surroundings.grow(1e-4f);  // what stands on the floor touches it
  for (const Instance& instance : scene.instances)
    for (const vec3& position : scene.meshes[instance.mesh].positions)
      if (const vec3 p = instance.point(position); !surroundings.contains(p))
        throwInput("{}: the model must lie inside [surroundings]; it reaches to ({:g}, {:g}, {:g})",
                   file, p.x, p.y, p.z);
}

}  // namespace

LoadedScene loadScene(RenderJob& job) {
  std::vector<std::string> modelWarnings;
  Scene scene = loadModels(job.file, glm::dvec3(0), modelWarnings);
  const glm::dvec3 origin = originFor(scene, job.file.models.front().file);
  if (origin != glm::dvec3(0)) {
    scene = loadModels(job.file, origin, modelWarnings);
    if (job.file.camera) job.file.camera->position -= vec3(origin);
    if (job.file.surroundings) job.file.surroundings->move(-vec3(origin));
  }
  chooseSize(job, scene);
  const Camera camera = withLens(job, chooseCamera(job, scene));
  for (const Lamp& lamp : job.file.lamps) addLamp(scene, lamp, origin);
  for (Material& material : scene.materials) material.singleSided = job.singleSided;
  std::vector<std::string> files = scene.files;
  if (job.file.probe) files.push_back(*job.file.probe);
  if (job.file.composite) files.push_back(job.file.composite->plate);
  std::unique_ptr<const Room> room = loadRoom(job, origin, files);
  if (job.file.surroundings && !room)
    checkInside(scene, *job.file.surroundings, job.file.models.front().file);
  LoadedProbe loaded = loadProbeOf(job, scene);
  Probe probe(loaded.latLong, job.file.probeRotation.value_or(0), job.file.probeScale.value_or(1));
  loaded.latLong = {};
  return {
      std::move(scene), camera, std::move(loaded),        std::move(probe), job.file.surroundings,
      std::move(room),  origin, std::move(modelWarnings), std::move(files)};
}

std::unique_ptr<LightingStrategy> makeLighting(const NamedSetting& strategy, Mis mis,
                                               const LoadedScene& loaded) {
  auto lighting = makeStrategy(strategy.name, loaded.probe, mis, strategy.location);
  if (!loaded.surroundings) return lighting;
  return std::make_unique<FiniteSurroundings>(std::move(lighting), loaded.probe,
                                              *loaded.surroundings, loaded.room.get());
}

void sayNotes(const RenderJob& job, const LoadedScene& loaded, bool quiet) {
  for (const std::string& warning : job.file.warnings) warn(warning);
  for (const std::string& warning : loaded.modelWarnings) warn(warning);
  if (!quiet)
    for (const std::string& line : loaded.scene.notes) note(line);
  if (const Scene& scene = loaded.scene; !scene.lights.empty() && hasBodies(scene))
    warn(
        "lights without extent do not shine through bodies of glass, which bend their light away: "
        "what stands behind is in full shadow; a lamp that is a surface reaches it");
  const RenderSettings& s = job.settings;
  if (const double bytes = pictureBytes(s); bytes > kWorthSaying && !quiet)
    note(fmt::format("a picture of {}x{} takes {:.3g} GB of memory", s.width, s.height,
                     bytes * 1e-9));
  if (!job.file.probe) {
    if (!quiet && loaded.scene.environment)
      note(
          fmt::format("{}: no probe; lit by the model's own environment", job.file.models[0].file));
    else if (!quiet && !loaded.scene.lights.empty())
      note(fmt::format("{}: no probe; its {} lights shine alone", job.file.models[0].file,
                       loaded.scene.lights.size()));
    return;
  }
  const std::string& path = *job.file.probe;
  const LoadedProbe& probe = loaded.loadedProbe;
  for (const std::string& line : warnings(probe, path)) warn(line);
  if (!probe.detected || quiet) return;
  const std::string_view mapping = mappingName(probe.mapping);
  note(fmt::format("{}: detected as {} {} probe because {}", path,
                   mapping.starts_with('a') ? "an" : "a", mapping, probe.reason));
}

void note(const std::string& message) { fmt::print(stderr, "chromeball: {}\n", message); }

void warn(const std::string& message) { fmt::print(stderr, "chromeball: warning: {}\n", message); }

}  // namespace chromeball
