// SPDX-License-Identifier: Apache-2.0
#include "session/place_models.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "base/progress.h"
#include "base/text.h"
#include "description/render_description.h"
#include "scene/bounds.h"
#include "scene/builder/scene_builder.h"
#include "scene/extended_surface.h"
#include "scene/framing.h"
#include "scene/gltf/load_gltf.h"
#include "session/memory_estimate.h"
#include "session/open_shutter.h"
#include "session/scene_lighting.h"

namespace chromeball {
namespace {

Camera chooseWithoutLens(const RenderDescription& description, const Scene& scene,
                         const AutomaticView& view) {
  if (const auto& placed = description.camera.placed) try {
      return placed->relativeTo(view.origin);
    } catch (const InputError& error) {
      throwInput("{}: {}", description.origins.of("camera.placed"), error.what());
    }
  if (const auto& wanted = description.camera.name) {
    std::vector<std::string_view> names;
    std::set<std::string_view> known;
    for (const auto name : {&Camera::name, &Camera::node})
      for (const Camera& camera : scene.cameras) {
        if (camera.*name == *wanted) return camera;
        if (known.insert(camera.*name).second) names.push_back(camera.*name);
      }
    throwInput("{}: the model has no camera `{}`; {}", description.origins.of("camera.name"),
               *wanted, names.empty() ? "it has none" : didYouMean(*wanted, names));
  }
  if (!scene.cameras.empty() && !description.camera.frames()) return scene.cameras.front();
  if (!view.camera)
    throwInput("{}: its camera vanishes while the shutter is open", description.sceneName());
  return *view.camera;
}

Camera withFieldOfView(const CameraDescription& given, const Origins& origins, Camera camera) {
  if (given.fov && camera.orthographic)
    throwInput("{}: an orthographic camera has no field of view; enlarge what it shows",
               origins.of("camera.fov"));
  if (given.fov) camera.fov = glm::radians(float(*given.fov));
  if (given.zoom == 1) return camera;
  camera.halfHeight = float(camera.halfHeight / given.zoom);
  camera.fov = float(2 * std::atan(std::tan(0.5 * double(camera.fov)) / given.zoom));
  return camera;
}

Camera withLens(const RenderDescription& description, Camera camera) {
  const auto& lens = description.camera.lens;
  if (!lens) return camera;
  if (camera.orthographic)
    throwInput("{}: an orthographic camera has no lens; leave out `aperture` and `focus`",
               description.origins.of("camera.lens"));
  camera.lensRadius = 0.5f * lens->aperture;
  camera.focus = lens->focus;
  return camera;
}

Camera withOptics(const RenderDescription& description, Camera camera) {
  const auto& optics = description.camera.optics;
  if (!optics) return camera;
  if (camera.orthographic)
    throwInput(
        "{}: an orthographic camera has no lens; leave out `principal_point` and `distortion`",
        description.origins.of("camera.optics"));
  if (optics->principalPoint)  // zoom enlarges the middle of the image
    camera.principalPoint =
        0.5f + float(description.camera.zoom) * (*optics->principalPoint - 0.5f);
  camera.distortion = optics->distortion;
  return camera;
}

// The camera before its `orbit`.
Camera chooseCamera(const RenderDescription& description, const Scene& scene,
                    const AutomaticView& view) {
  const Camera camera = withFieldOfView(description.camera, description.origins,
                                        chooseWithoutLens(description, scene, view));
  return withOptics(description, withLens(description, camera));
}

// Throws InputError if the scene reaches too far from the origin.
void checkReach(const Bounds& box, const std::string& name) {
  constexpr float kMaxReach = 1e9f;
  const float reach = maxComponent(glm::max(glm::abs(box.min), glm::abs(box.max)));
  if (!box.empty() && !(reach < kMaxReach))
    throwInput("{}: reaches {:.3g} m from the origin; the limit is {:.0e}: scale it down", name,
               reach, kMaxReach);
}

// The origin of the scene's coordinates in the world. Floats have a relative precision of 1e-7, so
// a scene that is small compared with its distance from the origin is moved to its own centre. The
// distant probe is not affected.
glm::dvec3 originFor(const Bounds& box) {
  constexpr double kFar = 1000;
  if (box.empty()) return glm::dvec3(0);
  const glm::dvec3 centre = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
  return glm::length(centre) > kFar * glm::length(box.size()) ? centre : glm::dvec3(0);
}

// The description's size; else the default height, with the aspect ratio of the model's camera.
// Throws InputError if the image does not fit into the description's memory.
void chooseSize(RenderDescription& description, const Scene& scene) {
  RenderSettings& settings = description.settings;
  if (description.size) {
    settings.width = description.size->width;
    settings.height = description.size->height;
  } else if (!description.camera.placed && !description.camera.frames() && !scene.cameras.empty()) {
    const float aspect = chooseCamera(description, scene, {}).aspect;
    if (aspect > 0.05f && aspect < 20)
      settings.width = std::max(1, int(std::lround(aspect * float(settings.height))));
  }
  if (const auto& crop = settings.crop)
    if (crop->x + crop->width > settings.width || crop->y + crop->height > settings.height)
      throwInput("{}: is not within the image of {}x{} pixels", description.origins.of("crop"),
                 settings.width, settings.height);
  const double needed = imageBytes(description);
  const Origins& origins = description.origins;
  checkMemory(description, needed, "{}an image of {}x{} takes {:.3g} GB of memory",
              origins.has("render.size") ? origins.of("render.size") + ": " : "", settings.width,
              settings.height, 1e-9 * needed);
}

PlacedModels modelsAtOrigin(const RenderDescription& description,
                            const std::vector<ModelEntry>& models, ModelCache& cache) {
  PlacedModels placed;
  placed.scene = loadModels(description, models, placed.origin, cache, placed.warnings);
  const Bounds box = bounds(placed.scene);
  checkReach(box, description.sceneName());
  placed.origin = originFor(box);
  if (placed.origin != glm::dvec3(0))
    placed.scene = loadModels(description, models, placed.origin, cache, placed.warnings);
  return placed;
}

// The description's size must be final.
ViewNeeds viewNeeds(const RenderDescription& description, const Scene& scene) {
  const CameraDescription& c = description.camera;
  const RenderSettings& s = description.settings;
  ViewNeeds needs{
      .turns = c.turns, .stands = needsStand(description), .floor = floorOf(description)};
  if (c.placed || c.name || (!scene.cameras.empty() && !c.frames())) return needs;
  const auto fov = c.fov ? std::optional(glm::radians(*c.fov)) : std::nullopt;
  needs.wishes = {c.view, fov, c.node, c.turns || description.stand.turntable,
                  description.stand.turntable.has_value()};
  needs.aspectRatio = float(s.width) / float(s.height);
  needs.choosesSides = description.choosesSides;
  return needs;
}

void checkNode(const RenderDescription& description, const Scene& scene) {
  const auto& node = description.camera.node;
  if (!node || !instancesBelow(scene, *node).empty()) return;
  const std::string location = description.origins.of("camera.look_at_node");
  const std::vector<std::string_view> names(scene.nodeNames.begin(), scene.nodeNames.end());
  if (std::ranges::find(names, *node) != names.end())
    throwInput("{}: node `{}` has no surface to be looked at", location, *node);
  throwInput("{}: the model has no node `{}`; {}", location, *node, didYouMean(*node, names));
}

// The view of all times, begun with that of time 0 in the coordinates of that time: with the same
// rounding for all times.
AutomaticView findView(const RenderDescription& description, const ViewNeeds& needs,
                       const PlacedModels& now, ModelCache& cache) {
  constexpr size_t kMostTimes = 24;
  if (!needs.wishes && !needs.turns && !needs.stands) return {.needs = needs, .origin = now.origin};
  std::optional<PlacedModels> start;
  if (now.scene.isAnimated)
    start = modelsAtOrigin(description, modelsAt(description.models, 0), cache);
  const PlacedModels& first = start ? *start : now;
  AutomaticView view{.needs = needs, .origin = first.origin};
  view.centre = centreOf(first.scene);
  view.axis = glm::dvec3(view.centre) + view.origin;
  double lowest = bounds(first.scene).min.y;
  std::optional<Framing> framing;
  if (needs.wishes) {
    checkNode(description, first.scene);
    framing.emplace(first.scene, needs.aspectRatio, *needs.wishes);
  }
  std::vector<double> times;
  if (start) times = timesOfChange(modelsAt(description.models, 0), INFINITY, kMostTimes, cache);
  std::vector<std::string> known;
  for (const double seconds : times) {
    const Scene later =
        loadModels(description, modelsAt(description.models, seconds), first.origin, cache, known);
    if (framing) framing->add(later);
    lowest = std::min(lowest, double(bounds(later).min.y));
  }
  if (std::isfinite(lowest)) view.lowest = lowest + view.origin.y;
  if (framing) view.camera = framing->camera(), view.isDark = framing->isDark();
  if (framing && needs.wishes->node) view.centre = framing->centre();
  const float drop = needs.floor ? float(*needs.floor - view.lowest) : 0;
  view.centre.y += drop;
  if (view.camera) view.camera->position.y += drop;
  if (!needs.turns) view.centre = vec3(0);
  return view;
}

// Lets the probe's light through the backs of walls that face inwards, if nothing else lights the
// models.
void chooseSides(RenderDescription& description, const AutomaticView& view, const Scene& scene) {
  const auto emits = [&](const Instance& i) { return scene.materials[size_t(i.material)].emits(); };
  const bool isLit = !scene.lights.empty() || std::ranges::any_of(scene.instances, emits);
  if (view.needs.choosesSides && view.isDark && !isLit && description.run.makesImage)
    description.singleSided = SingleSided::Light;
}

}  // namespace

AutomaticView AutomaticView::seenFrom(const glm::dvec3& other) const {
  AutomaticView view = *this;
  const vec3 move(origin - other);
  view.origin = other;
  view.centre += move;
  if (view.camera) view.camera->position += move;
  return view;
}

Scene loadModels(const RenderDescription& description, const std::vector<ModelEntry>& models,
                 const glm::dvec3& origin, ModelCache& cache, std::vector<std::string>& warnings) {
  Scene scene;
  if (description.scene) {
    scene = *description.scene;
    moveOrigin(scene, origin);
  }
  std::set<std::string> known(warnings.begin(), warnings.end());
  const auto add = [&](const std::string& line) {
    if (known.insert(line).second) warnings.push_back(line);
  };
  for (size_t i = 0; i < models.size(); ++i) {
    reportWork("models", double(i) / double(models.size()));
    const ModelEntry& model = models[i];
    const std::string name = elementName("models", i);
    GltfChoice choice = model.choice;
    if (choice.animation)
      choice.animation->location = description.origins.of(name + ".choice.animation");
    if (choice.variant) choice.variant->location = description.origins.of(name + ".choice.variant");
    // Near the world's origin the translation is as exact as all coordinates.
    choice.origin = origin == glm::dvec3(0) ? origin : origin - model.translationRest;
    choice.cache = &cache;
    choice.environment = !description.probe.file;
    append(scene, loadGltf(model.file, model.placement, add, choice));
  }
  const float factor = float(description.lighting.lamps);
  for (PunctualLight& light : scene.lights) light.intensity *= factor;
  return scene;
}

Camera cameraOf(const RenderDescription& description, const Scene& scene, const AutomaticView& view,
                const glm::dvec3& origin, double turn) {
  const AutomaticView here = view.seenFrom(origin);
  const Camera camera = chooseCamera(description, scene, here);
  if (!fillsImage(camera, double(description.settings.width) / description.settings.height))
    throwInput(
        "{}: the image folds back inside the frame, where (1 + k1 r^2 + k2 r^4) r does not "
        "ascend; `distortion` may be for another `fov`",
        description.origins.of("camera.optics"));
  return camera.turnedAround(here.centre, description.camera.orbit + turn);
}

PlacedModels placeModels(RenderDescription& description, ModelCache& cache,
                         const AutomaticView* view) {
  PlacedModels placed = modelsAtOrigin(description, description.models, cache);
  if (placed.scene.instances.empty() && !placed.scene.isAnimated)
    throwInput("{}: the model has no triangles to render", description.sceneName());
  Scene& scene = placed.scene;
  chooseSize(description, scene);
  const ViewNeeds needs = viewNeeds(description, scene);
  placed.view = view && view->needs == needs ? *view : findView(description, needs, placed, cache);
  if (description.stand.movesModels()) {
    const AutomaticView found = placed.view;
    placed = modelsAtOrigin(description, standing(description, description.models, found), cache);
    placed.view = found;
    turnBackCameras(description, found, placed.origin, scene);
  }
  placed.camera = cameraOf(description, scene, placed.view, placed.origin);
  if (description.camera.shutter) openShutter(description, placed, cache);
  addGround(description, placed.view, placed.origin, scene);
  placed.hasLights = !scene.lights.empty();
  if (description.lighting.lamps == 0) scene.lights.clear();
  for (const Lamp& lamp : description.lamps) addLamp(scene, lamp, placed.origin);
  removeLamps(description, scene);
  if (description.singleSided == SingleSided::Camera) chooseSides(description, placed.view, scene);
  for (Material& material : scene.materials) material.singleSided = description.singleSided;
  if (description.straightGlassShadows) passShadowsStraight(scene.materials);
  return placed;
}

bool isViewOf(RenderDescription description, const Scene& scene, const AutomaticView& view) {
  chooseSize(description, scene);
  return viewNeeds(description, scene) == view.needs;
}

Camera placeCamera(RenderDescription& description, const Scene& scene, const AutomaticView& view,
                   const glm::dvec3& origin) {
  chooseSize(description, scene);
  Camera camera = cameraOf(description, scene, view, origin);
  if (description.camera.shutter) turnCamera(description, scene, view, origin, camera);
  return camera;
}

}  // namespace chromeball
