// SPDX-License-Identifier: Apache-2.0
#include "session/load_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/file.h"
#include "description/capabilities.h"
#include "probe/sun_extraction.h"
#include "render/guide_training.h"
#include "session/memory_estimate.h"

namespace chromeball {
namespace {

class Collector {
 public:
  void note(std::string text) { messages_.push_back({Message::Kind::Note, std::move(text)}); }
  void warn(std::string text) { messages_.push_back({Message::Kind::Warning, std::move(text)}); }
  void add(const Messages& more) { messages_.insert(messages_.end(), more.begin(), more.end()); }
  Messages take() { return std::move(messages_); }

 private:
  Messages messages_;
};

bool hasBodies(const Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& i) {
    return scene.materials[size_t(i.material)].isBody();
  });
}

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
  const auto hasMaterial = [&](const auto& isSuch) {
    return std::ranges::any_of(scene.instances, [&](const Instance& i) {
      return isSuch(scene.materials[size_t(i.material)]);
    });
  };
  const bool hasSuns =
      loaded.loadedProbe.hasSuns || (description.scene && !description.scene->suns.empty()) ||
      std::ranges::any_of(description.lamps, [](const Lamp& l) { return l.sun.has_value(); });
  return {
      .hasProbe = description.probe.file || description.probe.map || scene.environment,
      .hasModelLights = loaded.hasModelLights,
      .hasSuns = hasSuns,
      .hasProbeSuns = hasProbeSuns(loaded),
      .hasAmbientLight = !scene.ambient.empty() ||
                         std::ranges::any_of(description.lamps,
                                             [](const Lamp& l) { return l.ambient.has_value(); }),
      .hasAreaLights =
          hasSuns || loaded.sources || hasMaterial([](const Material& m) { return m.emits(); }),
      .hasBodies = hasBodies(scene),
      .hasStraightGlass = hasMaterial([](const Material& m) { return m.straightShadows; }),
      .hidesBacks = hasMaterial([](const Material& m) { return !m.doubleSided; }),
      .moves =
          loaded.moves || (description.camera.shutter && description.camera.shutter->turn != 0)};
}

void addMemory(const LoadedScene& loaded, Collector& messages) {
  const RenderDescription& description = loaded.description;
  constexpr double kMinBytes = 1e9;
  if (const MemoryEstimate estimate = estimateMemory(loaded); estimate.peak > kMinBytes)
    messages.note(fmt::format("{}: takes {:.2g} GB of memory: {}", description.path,
                              1e-9 * estimate.peak, inWords(estimate)));
}

// Lamps of the scene file that are among the scene's lights.
size_t ofSceneFile(const RenderDescription& description, const Scene& scene) {
  if (scene.lights.empty()) return 0;  // left out (--light-from)
  return size_t(std::ranges::count_if(description.lamps,
                                      [](const Lamp& lamp) { return lamp.punctual.has_value(); }));
}

void addLights(const RenderDescription& description, const Scene& scene, Collector& messages) {
  const std::string model = description.sceneName();
  if (scene.environment)
    messages.note(fmt::format("{}: no probe; lit by the model's own environment", model));
  else if (const size_t count = scene.lights.size() - ofSceneFile(description, scene))
    messages.note(fmt::format("{}: no probe; lit by the model's {} light{}", model, count,
                              count == 1 ? "" : "s"));
}

// `guide = "on"` where nothing can be guided.
void addGuide(const RenderDescription& description, Collector& messages) {
  if (description.settings.guiding != Guiding::On) return;
  const std::string location = description.origins.of("render.guide");
  if (description.settings.path().limitsKinds())
    messages.note(fmt::format(
        "{}: nothing is guided, since limits of depth by kind do not know guided bounces",
        location));
  else if (GuideTraining::samplesOf(description.settings) == 0)
    messages.note(fmt::format("{}: nothing is guided with fewer than {} samples per pixel",
                              location, GuideTraining::kMinSamples));
}

void addSources(const LoadedScene& loaded, Collector& messages) {
  constexpr double kMaxUnevenness = 0.02;
  if (!loaded.sources) return;
  std::vector<PolygonSource> sources;
  for (const PolygonLight& light : loaded.sources->lights) sources.push_back(light.source);
  if (const double change = unevenness(sources); change > kMaxUnevenness)
    messages.warn(fmt::format(
        "[[source]]: the probe is uneven in the polygons; one constant radiance for each changes "
        "irradiance by up to {:.2g}% of that on surfaces facing them; more and smaller polygons "
        "change "
        "it less",
        100 * change));
}

void addProbe(const std::string& path, const LoadedProbe& probe, Collector& messages) {
  for (const Message& message : probe.messages)
    message.kind == Message::Kind::Note ? messages.note(message.text) : messages.warn(message.text);
  for (const std::string& line : warnings(probe, path)) messages.warn(line);
  if (!probe.detected) return;
  const std::string mapping = mappingName(probe.mapping);
  messages.note(fmt::format("{}: detected as {} {} probe because {}", path,
                            mapping.starts_with('a') ? "an" : "a", mapping, probe.reason));
}

void addPlate(const std::string& path, Collector& messages) {
  const std::string extension = lowerExtension(path);
  const bool isLinear =
      extension == ".exr" || extension == ".hdr" || extension == ".pic" || extension == ".pfm";
  if (!isLinear) messages.note(fmt::format("{}: decoded from sRGB", path));
}

std::string plateScaleText(const CompositeEntry& composite, const PlateScale& found) {
  const Rgb &scale = found.scale, &assumed = composite.groundReflectance;
  const double grey = luminance(glm::dvec3(assumed));
  const vec2& range = composite.groundReflectanceRange;
  return fmt::format(
      "the probe's scale is {:.4g},{:.4g},{:.4g} by {} pixels of the ground with reflectance "
      "{:.3g}; "
      "they scatter by {:.2g}%; reflectances of {:.3g} to {:.3g} make it {:.3g} to {:.3g} times "
      "that",
      scale.x, scale.y, scale.z, found.pixels, grey, 100 * found.scatter, range.x, range.y,
      grey / double(range.y), grey / double(range.x));
}

}  // namespace

Messages loadMessages(const LoadedScene& loaded) {
  const RenderDescription& description = loaded.description;
  const Scene& scene = loaded.scene;
  Collector messages;
  for (const std::string& line : description.warnings) messages.warn(line);
  if (description.composite) messages.add(description.composite->messages);
  for (const std::string& line : loaded.modelWarnings) messages.warn(line);
  for (const std::string& line : scene.notes) messages.note(line);
  if (!scene.lights.empty() && hasBodies(scene))
    messages.warn(
        "punctual lights do not pass bodies of glass, which refract their light: surfaces behind "
        "are in full shadow; light from emissive surfaces passes");
  if (receivesNoShadow(loaded))
    messages.warn(
        "the local scene is unlit (KHR_materials_unlit): it shows neither shadows nor light of the "
        "objects; give it a material that is lit");
  for (const std::string& line : idleSettings(description, contentsOf(loaded))) messages.warn(line);
  addMemory(loaded, messages);
  if (const auto& probe = description.probe.file)
    addProbe(*probe, loaded.loadedProbe, messages);
  else if (!description.probe.map)
    addLights(description, scene, messages);
  addGuide(description, messages);
  addSources(loaded, messages);
  if (const auto& scale = loaded.plateScale)
    messages.note(plateScaleText(description.composite->entry, *scale));
  if (description.composite && description.composite->plateFile)
    addPlate(*description.composite->plateFile, messages);
  return messages.take();
}

}  // namespace chromeball
