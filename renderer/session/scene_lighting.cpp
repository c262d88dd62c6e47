// SPDX-License-Identifier: Apache-2.0
#include "session/scene_lighting.h"

#include <algorithm>

#include "base/error.h"
#include "base/progress.h"
#include "lighting/finite_surroundings.h"
#include "lighting/scene_sources.h"
#include "lighting/suns.h"
#include "probe/irradiance.h"
#include "probe/polygon_source.h"
#include "session/load_scene.h"

namespace chromeball {
namespace {

void checkSuns(const RenderDescription& description, bool hasSuns) {
  if (description.lighting.from == LightFrom::Suns && !hasSuns)
    throwInput("{}: there are no suns, neither in the probe nor in the scene file",
               description.origins.of("lighting.from"));
}

// Throws InputError if the part is to be the suns, and there are none.
void keepPart(const RenderDescription& description, const Scene& scene, LoadedProbe& loaded) {
  const LightFrom from = description.lighting.from;
  if (from == LightFrom::All) return;
  Image& latLong = loaded.latLong;
  SunExtraction extraction = extractSuns(latLong);
  loaded.hasSuns = !extraction.suns.empty();
  if (from == LightFrom::Rest) {
    latLong = std::move(extraction.remainder);
    return;
  }
  checkSuns(description, loaded.hasSuns || !scene.suns.empty());
  for (size_t i = 0; i < latLong.texels.size(); ++i)
    latLong.texels[i] -= extraction.remainder.texels[i];
}

void checkProbeMap(const Image& map) {
  if (map.channels != 3 || map.width < 1 || map.height < 1)
    throwInput("the probe's map is {} x {} with {} channels; it must be lat-long, with 3",
               map.width, map.height, map.channels);
  for (size_t i = 0; i < map.texels.size(); ++i)
    if (!(map.texels[i] >= 0 && std::isfinite(map.texels[i])))
      throwInput("the probe's map: texel {}, {} must be finite, and not negative",
                 i / 3 % size_t(map.width), i / 3 / size_t(map.width));
}

LoadedProbe loadWholeProbe(const RenderDescription& description, Scene& scene) {
  if (description.probe.file)
    return loadProbe(*description.probe.file, description.probe.mapping,
                     description.origins.of("probe.mapping"));
  LoadedProbe loaded;
  if (description.probe.map) {
    checkProbeMap(*description.probe.map);
    loaded.latLong = *description.probe.map;
    loaded.fileWidth = loaded.latLong.width, loaded.fileHeight = loaded.latLong.height;
    return loaded;
  }
  if (scene.environment) {
    loaded.latLong = std::move(*scene.environment);
    return loaded;
  }
  checkLit(description, scene);
  loaded.latLong = Image(2, 1, 3);
  return loaded;
}

const Probe& sampledProbe(const LoadedScene& loaded) {
  return loaded.sources ? loaded.sources->remainder : loaded.probe;
}

// The probe's light with the polygons that are sources of their own, mapped onto the surroundings.
std::unique_ptr<LightSource> withSources(std::unique_ptr<LightSource> lighting,
                                         const LoadedScene& loaded, bool splitsProbe) {
  const auto& sources = loaded.sources;
  const Probe& sampled = sampledProbe(loaded);
  if (splitsProbe && lighting->groups() == std::vector<std::string>{"probe"})
    lighting = std::make_unique<SplitProbe>(std::move(lighting), sampled);
  if (sources) {
    std::vector<std::unique_ptr<LightSource>> parts;
    parts.push_back(std::move(lighting));
    parts.push_back(
        std::make_unique<PolygonLights>(sources->lights, sources->hidden, sampled.rotation()));
    lighting = std::make_unique<CombinedLight>(std::move(parts));
  }
  if (loaded.surroundings)
    lighting = std::make_unique<FiniteSurroundings>(
        std::move(lighting), loaded.probe, *loaded.surroundings, loaded.room.get(),
        loaded.description.lighting.showLights || (sources && sources->areSeen()));
  return lighting;
}

}  // namespace

void removeLamps(const RenderDescription& description, Scene& scene) {
  const LightFrom from = description.lighting.from;
  if (from == LightFrom::Rest) scene.suns.clear();
  if (from != LightFrom::Suns) return;
  scene.lights.clear();
  scene.ambient.clear();
  for (Material& material : scene.materials) {
    material.emission = Rgb(0);
    if (material.unlit) material.baseColor = vec4(0, 0, 0, material.baseColor.w);
  }
}

void checkLit(const RenderDescription& description, const Scene& scene) {
  checkSuns(description, !scene.suns.empty());
  const bool lit =
      !scene.lights.empty() ||
      std::ranges::any_of(description.lamps, [](const Lamp& l) { return l.sun || l.ambient; }) ||
      std::ranges::any_of(scene.materials, &Material::emits);
  if (!lit)
    throw InputError(
        fmt::format("{}: nothing lights the scene; it needs a probe", description.sceneName()),
        Remedy{"probe.file", {}});
}

LoadedProbe loadProbeOf(const RenderDescription& description, Scene& scene) {
  reportWork("probe", 0);
  LoadedProbe loaded = loadWholeProbe(description, scene);
  keepPart(description, scene, loaded);
  return loaded;
}

Probe probeOf(const RenderDescription& description, LoadedProbe& loaded) {
  Probe probe(loaded.latLong, description.probe.rotation, Rgb(description.probe.scale));
  loaded.latLong = {};
  return probe;
}

Probe scaled(const Probe& probe, const Rgb& factor) {
  Image map = probe.latLong();
  recolor(map, [&](const Rgb& c) { return factor * c; });
  return Probe(map, probe.rotation());
}

Rgb irradianceOn(const Probe& probe, const vec3& normal) {
  const vec3 turned = probe.rotation().back(normal);
  return Rgb(exactIrradiance(probe.latLong(), {&turned, 1})[0]);
}

std::optional<ProbeSources> sourcesOf(const RenderDescription& description,
                                      const LoadedProbe& loaded, const Probe& probe) {
  const std::vector<SourceEntry>& entries = description.sources;
  if (entries.empty() || description.lighting.from == LightFrom::Suns) return {};
  if (loaded.fileWidth == 0)
    throwInput("{}: [[source]] needs a probe", description.origins.of(elementName("sources", 0)));
  std::vector<PolygonLight> lights;
  Image rest = probe.latLong();
  // The illums come first: the light that they take stays visible.
  const auto take = [&](bool isIllum) {
    std::vector<SphericalPolygon> polygons;
    const size_t first = lights.size();
    std::vector<std::string> locations;
    for (size_t i = 0; i < entries.size(); ++i) {
      const SourceEntry& entry = entries[i];
      if (entry.isIllum != isIllum) continue;
      locations.push_back(description.origins.of(elementName("sources", i)));
      polygons.push_back(polygonOf(entry.corners, loaded, locations.back()));
      lights.push_back({{polygons.back(), dvec3(0)}, isIllum, entry.name});
    }
    PolygonExtraction extraction = extractPolygons(rest, polygons);
    for (size_t i = 0; i < polygons.size(); ++i) {
      if (extraction.sources[i].coveredTexels == 0)
        throwInput("{}: the polygon is smaller than the probe's texels", locations[i]);
      lights[first + i].source = extraction.sources[i];
    }
    rest = std::move(extraction.remainder);
  };
  take(true);
  Image hidden = probe.latLong();
  for (size_t i = 0; i < hidden.texels.size(); ++i) hidden.texels[i] -= rest.texels[i];
  take(false);
  return ProbeSources{std::move(lights), std::move(hidden), Probe(rest, probe.rotation())};
}

std::unique_ptr<LightSource> makeLighting(const NamedSetting& strategy, Mis mis,
                                          const LoadedScene& loaded, bool splitsProbe) {
  const LightingDescription& light = loaded.description.lighting;
  const Probe& sampled = sampledProbe(loaded);
  return withSources(makeStrategy(strategy.name, sampled, {mis, light.sunAngle, light.showLights},
                                  strategy.location),
                     loaded, splitsProbe);
}

std::unique_ptr<LightSource> makeLighting(const LoadedScene& loaded) {
  const RenderDescription& description = loaded.description;
  reportWork("lighting", 0);
  const bool splitsProbe = description.settings.wantsGroups();
  if (description.lighting.make)
    return withSources(description.lighting.make(sampledProbe(loaded), loaded.origin), loaded,
                       splitsProbe);
  return makeLighting({description.lighting.strategy, description.origins.of("lighting.strategy")},
                      description.settings.mis, loaded, splitsProbe);
}

std::unique_ptr<const EnvironmentLight> makeEnvironment(IntegratorKind integrator,
                                                        const std::string& strategy,
                                                        const LoadedScene& loaded) {
  if (!usesEnvironment(integrator)) return nullptr;
  const bool splitsSuns = resolveStrategy(strategy) == "suns";
  return std::make_unique<EnvironmentLight>(loaded.probe, loaded.scene, splitsSuns,
                                            loaded.description.lighting.sunAngle);
}

}  // namespace chromeball
