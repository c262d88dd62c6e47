// SPDX-License-Identifier: Apache-2.0
#include "session/load_scene.h"

#include <algorithm>
#include <functional>

#include "base/file.h"
#include "description/capabilities.h"
#include "probe/sun_extraction.h"
#include "render/guide_training.h"
#include "scene/extended_surface.h"
#include "session/memory_estimate.h"

namespace chromeball {
namespace {

template <class IsSuch>
bool hasMaterial(const Scene& scene, const IsSuch& isSuch) {
  return std::ranges::any_of(scene.instances, [&](const Instance& i) {
    return std::invoke(isSuch, scene.materials[size_t(i.material)]);
  });
}
bool hasBodies(const Scene& scene) { return hasMaterial(scene, &Material::isBody); }

// Whether some of a composite's local scene is unlit.
bool receivesNoShadow(const LoadedScene& loaded) {
  const Scene& scene = loaded.scene;
  for (size_t i = 0; i < loaded.isObject.size(); ++i)
    if (!loaded.isObject[i] && scene.materials[size_t(scene.instances[i].material)].unlit)
      return true;
  return false;
}

bool hasProbeSuns(const LoadedScene& loaded) {
  const RenderDescription& description = loaded.description;
  if (loaded.loadedProbe.hasSuns) return true;
  return description.lighting.from == LightFrom::All &&
         description.origins.has("lighting.sun_angle") &&
         !extractSuns(loaded.probe.latLong()).suns.empty();
}

SceneContents contentsOf(const LoadedScene& loaded) {
  const RenderDescription& description = loaded.description;
  const Scene& scene = loaded.scene;
  const auto hasLamp = [&](const auto& isSuch) {
    return std::ranges::any_of(description.lamps, isSuch);
  };
  const bool hasSuns = loaded.loadedProbe.hasSuns ||
                       (description.scene && !description.scene->suns.empty()) ||
                       hasLamp([](const Lamp& l) { return l.sun.has_value(); });
  return {.hasProbe = description.probe.file || description.probe.map || scene.environment,
          .hasModelLights = loaded.hasModelLights,
          .hasSuns = hasSuns,
          .hasProbeSuns = hasProbeSuns(loaded),
          .hasAmbientLight = !scene.ambient.empty() ||
                             hasLamp([](const Lamp& l) { return l.ambient.has_value(); }),
          .hasAreaLights = hasSuns || loaded.sources || hasMaterial(scene, &Material::emits),
          .hasBodies = hasBodies(scene),
          .hasStraightGlass = hasMaterial(scene, &Material::straightShadows),
          .hidesBacks = hasMaterial(scene, [](const Material& m) { return !m.doubleSided; }),
          .moves = loaded.moves ||
                   (description.camera.shutter && description.camera.shutter->turn != 0)};
}

void addSides(const RenderDescription& description, Messages& messages) {
  if (!description.choosesSides || description.singleSided != SingleSided::Light) return;
  messages.push_back({Message::Kind::Note,
                      fmt::format("{}: the probe's light passes the backs of its single-sided "
                                  "walls, since the picture would be black without",
                                  description.sceneName()),
                      Remedy{"render.single_sided", "camera"}});
}

void addMemory(const LoadedScene& loaded, Messages& messages) {
  const RenderDescription& description = loaded.description;
  constexpr double kMinBytes = 1e9;
  if (const MemoryEstimate estimate = estimateMemory(loaded); estimate.peak > kMinBytes)
    addNote(messages, "{}: takes {:.2g} GB of memory: {}", description.path, 1e-9 * estimate.peak,
            inWords(estimate));
}

// Lamps of the scene file that are among the scene's lights.
size_t ofSceneFile(const RenderDescription& description, const Scene& scene) {
  if (scene.lights.empty()) return 0;  // left out (--light-from)
  return size_t(std::ranges::count_if(description.lamps,
                                      [](const Lamp& lamp) { return lamp.punctual.has_value(); }));
}

void addLights(const RenderDescription& description, const Scene& scene, Messages& messages) {
  const std::string model = description.sceneName();
  if (scene.environment)
    addNote(messages, "{}: no probe; lit by the model's own environment", model);
  else if (const size_t count = scene.lights.size() - ofSceneFile(description, scene))
    addNote(messages, "{}: no probe; lit by the model's {} light{}", model, count,
            count == 1 ? "" : "s");
}

// `guide = "on"` where nothing can be guided.
void addGuide(const RenderDescription& description, Messages& messages) {
  if (description.settings.guiding != Guiding::On) return;
  const std::string location = description.origins.of("render.guide");
  if (description.settings.path().limitsKinds())
    addNote(messages,
            "{}: nothing is guided, since limits of depth by kind do not know guided bounces",
            location);
  else if (GuideTraining::samplesOf(description.settings) == 0)
    addNote(messages, "{}: nothing is guided with fewer than {} samples per pixel", location,
            GuideTraining::kMinSamples);
}

void addSources(const LoadedScene& loaded, Messages& messages) {
  constexpr double kMaxUnevenness = 0.02;
  if (!loaded.sources) return;
  std::vector<PolygonSource> sources;
  for (const PolygonLight& light : loaded.sources->lights) sources.push_back(light.source);
  if (const double change = unevenness(sources); change > kMaxUnevenness)
    addWarning(messages,
               "[[source]]: the probe is uneven in the polygons; one constant radiance for each "
               "changes irradiance by up to {:.2g}% of that on surfaces facing them; more and "
               "smaller polygons change it less",
               100 * change);
}

void addProbe(const std::string& path, const LoadedProbe& probe, Messages& messages) {
  messages.insert(messages.end(), probe.messages.begin(), probe.messages.end());
  for (const std::string& line : warnings(probe, path)) addWarning(messages, "{}", line);
  if (!probe.detected) return;
  addNote(messages, "{}", detection(probe, path));
}

void addPlateScale(const CompositeEntry& composite, const PlateScale& found, Messages& messages) {
  const Rgb& scale = found.scale;
  const double grey = luminance(glm::dvec3(found.reflectance));
  const vec2& range = composite.groundReflectanceRange;
  const bool isGiven = composite.groundInPlate.has_value();
  const double percent = 100 * found.scatter;
  const std::string scatter =
      percent < 10 ? fmt::format("{:.2g}", percent) : fmt::format("{:.0f}", percent);
  addNote(messages,
          "the probe's scale is {:.4g},{:.4g},{:.4g} by {} pixels of the ground {}with "
          "reflectance {:.3g}; they scatter by {}%; reflectances of {:.3g} to "
          "{:.3g} make it {:.3g} to "
          "{:.3g} times that",
          scale.x, scale.y, scale.z, found.pixels, isGiven ? "" : "around the objects ", grey,
          scatter, range.x, range.y, grey / double(range.y), grey / double(range.x));
  constexpr double kMostScatter = 0.5;  // of one surface, with its texture
  if (found.scatter > kMostScatter)
    addWarning(
        messages,
        "the pixels {} scatter by {}%: they show more than one surface, or light and shadow, "
        "and the probe's scale is a mean that fits none; say which part of the plate shows the "
        "ground alone (`ground_in_plate` in [composite])",
        isGiven ? "of the ground" : "around the objects", scatter);
}

}  // namespace

Messages idleMessages(const RenderDescription& description, const LoadedScene& loaded) {
  Messages messages;
  for (const std::string& line : idleSettings(description, contentsOf(loaded)))
    addWarning(messages, "{}", line);
  addGuide(description, messages);
  return messages;
}

Messages loadMessages(const LoadedScene& loaded) {
  const RenderDescription& description = loaded.description;
  const Scene& scene = loaded.scene;
  Messages messages;
  const auto warn = [&](const std::vector<std::string>& lines) {
    for (const std::string& line : lines) addWarning(messages, "{}", line);
  };
  warn(description.warnings);
  if (const auto& composite = description.composite)
    messages.insert(messages.end(), composite->messages.begin(), composite->messages.end());
  warn(loaded.modelWarnings);
  for (const std::string& line : scene.notes) addNote(messages, "{}", line);
  const auto blocksLamps = [&](bool body) {
    return !scene.lights.empty() && hasMaterial(scene, [&](const Material& m) {
      return m.isBody() == body && m.transmitsSharply() && !passesShadows(m);
    });
  };
  if (blocksLamps(true))
    addWarning(messages,
               "punctual lights do not pass smooth bodies of glass, which refract their light: "
               "surfaces behind are in full shadow; light from emissive surfaces passes");
  if (blocksLamps(false))
    addWarning(messages,
               "punctual lights do not pass smooth sheets with a coat, sheen, film or anisotropy: "
               "surfaces behind are in full shadow; light from emissive surfaces passes");
  if (receivesNoShadow(loaded))
    addWarning(messages,
               "the local scene is unlit (KHR_materials_unlit): it shows neither shadows nor light "
               "of the objects; give it a material that is lit");
  const Messages idle = idleMessages(description, loaded);
  messages.insert(messages.end(), idle.begin(), idle.end());
  if (description.settings.denoise && description.settings.isPart())
    addNote(messages, "{}: a part is denoised when all are merged",
            namedOrigin(description, "render.denoise"));
  addMemory(loaded, messages);
  if (const auto& probe = description.probe.file)
    addProbe(*probe, loaded.loadedProbe, messages);
  else if (!description.probe.map)
    addLights(description, scene, messages);
  addSides(description, messages);
  addSources(loaded, messages);
  if (const auto& scale = loaded.plateScale)
    addPlateScale(description.composite->entry, *scale, messages);
  return messages;
}

}  // namespace chromeball
