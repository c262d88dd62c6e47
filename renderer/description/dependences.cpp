// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "description/capabilities.h"
#include "lighting/strategy.h"

namespace chromeball {
namespace {

using D = RenderDescription;

std::string strategyOf(const D& d) { return resolveStrategy(d.lighting.strategy); }

// Whether the picture or a layer has paths, and of how many bounces.
bool followsPaths(const D& d) {
  return !d.settings.usesEnvironmentMaps() || d.settings.wantsAov(Aov::Irradiance);
}
int bouncesOf(const D& d) { return followsPaths(d) ? d.settings.path().maxDepth : 0; }

// Whether light is sampled at surfaces: also at those of glass, whose bounces are counted apart.
bool lightsSurfaces(const D& d, const SceneContents& c) {
  return bouncesOf(d) > 0 || (followsPaths(d) && c.hasBodies);
}
// Whether samples of the BSDF find light that the strategy samples too.
bool samplesAreas(const D& d) {
  if (d.lighting.make) return true;
  const std::string strategy = strategyOf(d);
  return strategy == "suns" || (strategy != "bsdf" && !hasLights(strategy));
}

bool isLitFromEverywhere(const D& d, const SceneContents& c) {
  return (c.hasProbe && d.lighting.from != LightFrom::Suns) || c.hasAmbientLight;
}

bool hasOcclusionLayer(const D& d) {
  return d.settings.wantsAov(Aov::AmbientOcclusion) || d.settings.wantsAov(Aov::BentNormal);
}

bool hasProbe(const D&, const SceneContents& c) { return c.hasProbe; }
bool hasModelLights(const D&, const SceneContents& c) { return c.hasModelLights; }
bool isNotOfSuns(const D& d, const SceneContents&) { return d.lighting.from != LightFrom::Suns; }
bool hasPaths(const D& d, const SceneContents&) { return followsPaths(d); }

// A shadow catcher of nodes has a ground only if it names that. `drop` takes its height from it.
bool hasGround(const D& d, const SceneContents&) {
  return d.stand.drops || !d.composite ||
         std::ranges::count(d.composite->entry.localScene, "ground") > 0;
}

constexpr std::array kDependences = {
    Dependence{"render.ground", "a shadow catcher on `ground` (beside other shadow catchers)",
               hasGround},
    Dependence{"camera.shutter", "anything that moves",  // at the times of other frames it may
               [](const D& d, const SceneContents& c) {
                 return !d.camera.shutter || c.moves || d.run.isOfFrames;
               }},
    Dependence{"camera.shutter_steps", "an open shutter",
               [](const D& d, const SceneContents&) { return d.camera.shutter.has_value(); }},
    Dependence{"probe.mapping", "a probe's file",
               [](const D& d, const SceneContents&) { return d.probe.file || d.probe.map; }},
    Dependence{"probe.mapping", "a probe's file: the probe is in memory",
               [](const D& d, const SceneContents&) { return d.probe.file || !d.probe.map; }},
    Dependence{"probe.rotation", "a probe",
               [](const D& d, const SceneContents& c) {
                 return c.hasProbe || d.origins.has("probe.rotation_keys");  // which are named
               }},
    Dependence{"probe.rotation_keys", "a probe", hasProbe},
    Dependence{"probe.scale", "a probe", hasProbe},
    Dependence{"lighting.strategy", "a probe", hasProbe},
    Dependence{"lighting.strategy", "an integrator that samples the probe (path, direct)",
               [](const D& d, const SceneContents&) {
                 return followsPaths(d) || strategyOf(d) == "suns";
               }},
    Dependence{"lighting.strategy", "bounces",
               [](const D& d, const SceneContents& c) {
                 return lightsSurfaces(d, c) || !followsPaths(d) || !c.hasProbe ||
                        d.lighting.showLights || strategyOf(d) == "suns";
               }},
    Dependence{"lighting.mis", "an integrator that samples the probe (path, direct)", hasPaths},
    Dependence{"lighting.mis", "bounces",
               [](const D& d, const SceneContents& c) {
                 return lightsSurfaces(d, c) || !followsPaths(d);
               }},
    Dependence{"lighting.mis", "light that light samples and BSDF samples both find",
               [](const D& d, const SceneContents& c) {
                 return c.hasAreaLights || c.hasAmbientLight || (c.hasProbe && samplesAreas(d)) ||
                        !lightsSurfaces(d, c);
               }},
    Dependence{"lighting.from", "suns",
               [](const D& d, const SceneContents& c) {
                 return d.lighting.from == LightFrom::All || c.hasSuns;
               }},
    Dependence{"lighting.sun_angle", "the strategy `suns`",
               [](const D& d, const SceneContents&) { return strategyOf(d) == "suns"; }},
    Dependence{"lighting.sun_angle", "suns in the probe's light",
               [](const D& d, const SceneContents& c) {
                 return strategyOf(d) != "suns" ||
                        (c.hasProbeSuns && d.lighting.from != LightFrom::Rest);
               }},
    Dependence{"lighting.lights", "punctual lights of the models", hasModelLights},
    Dependence{"lighting.lights", "more light than that of suns", isNotOfSuns},
    Dependence{"lighting.light_units", "punctual lights of the models", hasModelLights},
    Dependence{"lighting.light_units", "more light than that of suns", isNotOfSuns},
    Dependence{"render.guide", "light of a probe",
               [](const D& d, const SceneContents& c) {
                 return d.settings.guiding != Guiding::On ||
                        (c.hasProbe && d.lighting.from != LightFrom::Suns);
               }},
    Dependence{"render.glass_shadows", "smooth bodies of glass",
               [](const D& d, const SceneContents& c) {
                 return !d.straightGlassShadows || c.hasStraightGlass;
               }},
    Dependence{"render.regularize", "paths of more bounces, or bodies of glass",
               [](const D& d, const SceneContents& c) {
                 return !d.settings.regularize || bouncesOf(d) > 1 ||
                        (c.hasBodies && followsPaths(d));  // whose bounces are counted apart
               }},
    Dependence{"render.ao", "light from everywhere",
               [](const D& d, const SceneContents& c) {
                 return !d.settings.occlusion.ambient || isLitFromEverywhere(d, c);
               }},
    Dependence{"render.ao_distance", "light from everywhere",
               [](const D& d, const SceneContents& c) {
                 return isLitFromEverywhere(d, c) || hasOcclusionLayer(d);
               }},
    Dependence{"render.reflection_occlusion", "light from everywhere",
               [](const D& d, const SceneContents& c) {
                 return !d.settings.occlusion.reflection || isLitFromEverywhere(d, c);
               }},
    Dependence{"render.irradiance_cache", "paths of more bounces",
               [](const D& d, const SceneContents&) {
                 return !d.settings.cacheError || d.settings.usesCache();
               }},
    Dependence{
        "render.max_depth", "the integrator path",
        [](const D& d, const SceneContents&) { return bouncesOf(d) == d.settings.maxDepth; }},
    Dependence{"render.max_diffuse_depth", "a higher limit of all bounces",
               [](const D& d, const SceneContents&) {
                 return d.settings.maxDiffuseDepth < d.settings.path().maxDepth;
               }},
    Dependence{"render.max_specular_depth", "a higher limit of all bounces",
               [](const D& d, const SceneContents&) {
                 return d.settings.maxSpecularDepth < d.settings.path().maxDepth;
               }},
    Dependence{"render.max_transmission_depth", "bodies of glass",
               [](const D&, const SceneContents& c) { return c.hasBodies; }},
    Dependence{"render.max_transmission_depth", "an integrator that follows paths (path, direct)",
               hasPaths},
    Dependence{"render.single_sided", "single-sided surfaces",
               [](const D& d, const SceneContents& c) {
                 return d.singleSided == SingleSided::Camera || c.hidesBacks;
               }},
    Dependence{
        "composite.ground_reflectance_range", "`[probe] scale = \"plate\"`",
        [](const D& d, const SceneContents&) { return !d.composite || d.probe.isScaledByPlate; }},
    Dependence{
        "composite.ground_in_plate", "`[probe] scale = \"plate\"`",
        [](const D& d, const SceneContents&) { return !d.composite || d.probe.isScaledByPlate; }},
};

}  // namespace

std::span<const Dependence> dependences() { return kDependences; }

std::string namedOrigin(const RenderDescription& description, std::string_view setting) {
  const std::string origin = description.origins.of(setting);
  const bool isName = origin.starts_with("--") || origin == setting ||
                      origin.find("(): ") != std::string::npos;  // a program's "render(): noise"
  return isName ? origin : fmt::format("{}: `{}`", origin, setting);
}

std::vector<std::string> idleSettings(const RenderDescription& description,
                                      const SceneContents& contents) {
  std::vector<std::string> lines;
  for (const Dependence& d : kDependences) {
    const Origins& origins = description.origins;
    if (!origins.has(d.setting) || d.isMet(description, contents)) continue;
    // A part of a quality may be idle.
    if (origins.has("render.quality") && origins.of(d.setting) == origins.of("render.quality"))
      continue;
    lines.push_back(
        fmt::format("{} has no effect without {}", namedOrigin(description, d.setting), d.needs));
  }
  return lines;
}

}  // namespace chromeball
