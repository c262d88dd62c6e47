// SPDX-License-Identifier: Apache-2.0
#include "description/capabilities.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "lighting/strategy.h"

namespace chromeball {
namespace {

using D = RenderDescription;

bool wants(const D& d, std::string_view layer) {
  return std::ranges::count(d.output.layers, layer) > 0 ||
         std::ranges::any_of(d.settings.aovs, [&](Aov a) { return aovInfo(a).name == layer; });
}
bool approximates(const D& d) { return usesEnvironment(d.settings.integrator); }

// Features that may be in a description.
constexpr Feature kComposite{"a composite", "", [](const D& d) { return d.composite.has_value(); }};
constexpr Feature kPlate{"a composite with a plate", "", [](const D& d) { return d.hasPlate(); }};
constexpr Feature kShadowCatcher{"a shadow catcher", "shadow-catcher",
                                 [](const D& d) { return d.composite && !d.hasPlate(); }};
constexpr Feature kTwoPass{"a reference of two passes", "two-pass", [](const D& d) {
                             return d.composite ? d.composite->passes == Passes::Two
                                                : d.origins.has("two-pass");
                           }};
constexpr Feature kClamp{"a clamp", "clamp", [](const D& d) { return bool(d.settings.clamp); }};
constexpr Feature kRegularize{"regularisation", "render.regularize",
                              [](const D& d) { return d.settings.regularize; }};
constexpr Feature kDenoise{"denoising", "render.denoise",
                           [](const D& d) { return d.settings.denoise; }};
constexpr Feature kDenoiseLayers{"layers to denoise later", "output.aovs",
                                 [](const D& d) { return wants(d, "denoise"); }};
constexpr Feature kStraightGlass{"straight shadows of glass", "render.glass_shadows",
                                 [](const D& d) { return d.straightGlassShadows; }};
constexpr Feature kGuide{"a guide that is on", "render.guide",
                         [](const D& d) { return d.settings.guiding == Guiding::On; }};
constexpr Feature kShowLights{"visible lights of a strategy", "lighting.show_lights",
                              [](const D& d) { return d.lighting.showLights; }};
constexpr Feature kLightLayers{"layers by light", "output.aovs",
                               [](const D& d) { return d.settings.wantsGroups(); }};
constexpr Feature kAmbientOcclusion{"ambient occlusion of an environment map", "render.ao",
                                    [](const D& d) { return d.settings.occlusion.ambient; }};
constexpr Feature kReflectionOcclusion{"occlusion of reflections", "render.reflection_occlusion",
                                       [](const D& d) { return d.settings.occlusion.reflection; }};
constexpr Feature kOcclusionDistance{
    "a distance of occlusion", "render.ao_distance",
    [](const D& d) { return std::isfinite(d.settings.occlusion.distance); }};
constexpr Feature kUniformBent{"uniform bent normals", "render.bent",
                               [](const D& d) { return d.settings.occlusion.uniformBent; }};
constexpr Feature kApproximation{"an integrator that follows no paths", "render.integrator",
                                 approximates};
constexpr Feature kCache{"an irradiance cache", "render.irradiance_cache",
                         [](const D& d) { return d.settings.cacheError.has_value(); }};
constexpr Feature kCacheFile{"a file of a cache", "cache",
                             [](const D& d) { return d.run.cache.has_value(); }};
constexpr Feature kSurroundings{"finite surroundings", "",
                                [](const D& d) { return d.surroundings.has_value(); }};
constexpr Feature kSources{"sources in the probe", "",
                           [](const D& d) { return !d.sources.empty(); }};
constexpr Feature kLamps{"lamps of the scene file", "",
                         [](const D& d) { return !d.lamps.empty(); }};
constexpr Feature kPartOfLight{"a part of the light", "lighting.from",
                               [](const D& d) { return d.lighting.from != LightFrom::All; }};
constexpr Feature kDepthByKind{"limits of depth by kind", "render.max_diffuse_depth",
                               [](const D& d) { return d.settings.path().limitsKinds(); }};
constexpr Feature kShutter{"an open shutter", "camera.shutter",
                           [](const D& d) { return d.camera.shutter.has_value(); }};
constexpr Feature kOrbit{"a turned camera", "orbit",
                         [](const D& d) { return d.origins.has("orbit") || d.camera.orbit != 0; }};
constexpr Feature kTurntable{"turned models", "turntable",
                             [](const D& d) { return d.stand.turntable.has_value(); }};
constexpr Feature kDrop{"dropped models", "render.drop", [](const D& d) { return d.stand.drops; }};
constexpr Feature kPlainGround{"a ground", "render.ground",
                               [](const D& d) { return d.stand.hasGround; }};
constexpr Feature kOwnGround{"a composite that does not name the ground", "", [](const D& d) {
                               return d.composite && d.composite->ground !=
                                                         CompositeDescription::GroundPlane::IfNamed;
                             }};
constexpr Feature kFromMemory{"a scene from memory", "",
                              [](const D& d) { return d.scene != nullptr; }};
constexpr Feature kOrbitStep{"a turn while the shutter is open", "orbit-step",
                             [](const D& d) { return d.origins.has("orbit-step"); }};
constexpr Feature kFps{"frames per second", "fps", [](const D& d) { return d.origins.has("fps"); }};
constexpr Feature kTransparent{"a transparent background", "transparent",
                               [](const D& d) { return d.settings.hideProbe; }};
constexpr Feature kShard{"a shard", "shard",
                         [](const D& d) { return d.settings.shard.samplesOfAll > 0; }};
constexpr Feature kCrop{"a crop", "crop", [](const D& d) { return d.settings.crop.has_value(); }};
constexpr Feature kCheckpoint{"a checkpoint", "checkpoint",
                              [](const D& d) { return d.run.checkpoint.has_value(); }};
constexpr Feature kCheckpointEvery{"a time between checkpoints", "checkpoint-every",
                                   [](const D& d) { return d.origins.has("checkpoint-every"); }};
constexpr Feature kResume{"going on", "resume", [](const D& d) { return d.run.resumes; }};
constexpr Feature kWriteEvery{"images while it renders", "write-every",
                              [](const D& d) { return d.run.writeEvery.has_value(); }};
constexpr Feature kPreview{"a preview", "preview",
                           [](const D& d) { return d.origins.has("preview"); }};
constexpr Feature kDisplay{"a display", "display",
                           [](const D& d) { return d.origins.has("display"); }};
constexpr Feature kScaleByPlate{"a probe scaled by the plate", "probe.scale",
                                [](const D& d) { return d.probe.isScaledByPlate; }};
constexpr Feature kAutoExposure{"an exposure that the picture decides", "output.exposure",
                                [](const D& d) { return d.output.choosesExposure; }};

// Features that may be missing.
constexpr Feature kNoPlate{"no plate", "", [](const D& d) { return !d.hasPlate(); }};
constexpr Feature kNoGround{"no ground of a composite", "", [](const D& d) {
                              return !d.composite || d.composite->ground !=
                                                         CompositeDescription::GroundPlane::Always;
                            }};
constexpr Feature kNoProbeFile{"no probe's file", "probe.file",
                               [](const D& d) { return !d.probe.file && !d.probe.map; }};
constexpr Feature kNotImportance{
    "another strategy than importance", "lighting.strategy",
    [](const D& d) { return resolveStrategy(d.lighting.strategy) != "importance"; }};
constexpr Feature kNoLightSamples{
    "a strategy without light samples", "lighting.strategy",
    [](const D& d) { return resolveStrategy(d.lighting.strategy) == "bsdf"; }};
constexpr Feature kNoLights{"a strategy without lights", "lighting.strategy",
                            [](const D& d) { return !hasLights(d.lighting.strategy); }};
constexpr Feature kOneSample{"one sample per pixel", "render.samples",
                             [](const D& d) { return d.settings.samples < 2; }};
constexpr Feature kNotEnvironmentMap{
    "another integrator than environment-map", "render.integrator",
    [](const D& d) { return d.settings.integrator != IntegratorKind::EnvironmentMap; }};
constexpr Feature kNotPath{"another integrator than path", "render.integrator", [](const D& d) {
                             return d.settings.integrator != IntegratorKind::Path;
                           }};
constexpr Feature kNoOcclusion{"no ambient occlusion", "output.aovs", [](const D& d) {
                                 return !d.settings.usedOcclusion().ambient && !wants(d, "ao") &&
                                        !wants(d, "bent_normal");
                               }};
constexpr Feature kNoBentNormal{"no layer of bent normals", "output.aovs",
                                [](const D& d) { return !wants(d, "bent_normal"); }};
constexpr Feature kNoCache{"no irradiance cache", "render.irradiance_cache",
                           [](const D& d) { return !d.settings.cacheError; }};
constexpr Feature kNoShutter{"a closed shutter", "camera.shutter",
                             [](const D& d) { return !d.camera.shutter; }};
constexpr Feature kNoFrames{"neither frames nor a shutter", "camera.shutter", [](const D& d) {
                              return !d.run.isOfFrames && !d.origins.has("camera.shutter");
                            }};
constexpr Feature kNoCheckpoint{"no checkpoint", "checkpoint",
                                [](const D& d) { return !d.run.checkpoint; }};

constexpr std::string_view kBiased = "is biased; leave it out in a reference of two passes";
constexpr std::string_view kNotTwo = "not for a reference of two passes; leave one of the two out";

constexpr std::array kConflicts = {
    Conflict{kTwoPass, kNoPlate, "is for composites with a plate, and there is none"},
    Conflict{kClamp, kTwoPass, kBiased},
    Conflict{kRegularize, kTwoPass, kBiased},
    Conflict{kDenoise, kTwoPass, kBiased},
    Conflict{kStraightGlass, kTwoPass, kBiased},
    Conflict{kGuide, kTwoPass, "a reference of two passes is not guided; leave one of the two out"},
    Conflict{kGuide, kNotImportance, "guides renders with the strategy `importance`, not others"},
    Conflict{kShowLights, kNoLights,
             "the strategy has no lights; give one that replaces the probe by lights, such as "
             "median-cut:64"},
    Conflict{kDenoiseLayers, kComposite,
             "composites have no layers to denoise later; denoise the render"},
    Conflict{kDenoise, kOneSample, "needs at least 2 samples per pixel"},
    Conflict{kDenoiseLayers, kOneSample, "needs at least 2 samples per pixel"},
    Conflict{kLightLayers, kComposite,
             "composites have no layers by light (light_groups, shadow_mattes); render the scene "
             "without one"},
    Conflict{kDenoise, kLightLayers,
             "layers by light would not add up to the denoised picture; leave one of the two out"},
    Conflict{kAmbientOcclusion, kNotEnvironmentMap, "is for the integrator environment-map"},
    Conflict{kReflectionOcclusion, kNotEnvironmentMap, "is for the integrator environment-map"},
    Conflict{kOcclusionDistance, kNoOcclusion,
             "is for ambient occlusion: the layers `ao` and `bent_normal`, or an integrator with "
             "it"},
    Conflict{kUniformBent, kNoBentNormal, "is for the layer `bent_normal`"},
    Conflict{kApproximation, kComposite,
             "knows only light of a distant probe; leave the composite out"},
    Conflict{kApproximation, kSurroundings,
             "knows only light of a distant probe; leave [surroundings] out"},
    Conflict{kApproximation, kSources, "knows only light of a distant probe; leave [[source]] out"},
    Conflict{kApproximation, kShowLights,
             "knows only light of a distant probe; leave the strategy's visible lights out"},
    Conflict{kApproximation, kLightLayers,
             "knows only light of a distant probe; leave the light groups out"},
    Conflict{kApproximation, kGuide, "follows no paths that could be guided; leave the guide out"},
    Conflict{kApproximation, kRegularize, "follows no paths; leave regularisation out"},
    Conflict{kApproximation, kStraightGlass, "follows no paths; leave straight shadows out"},
    Conflict{kApproximation, kDepthByKind, "follows no paths; leave the limits of depth out"},
    Conflict{kCacheFile, kNoCache, "needs an irradiance cache"},
    Conflict{kCache, kNotPath, "not with another integrator; leave one of the two out"},
    Conflict{kCache, kComposite, "not with a composite; leave one of the two out"},
    Conflict{kCache, kShutter, "not with an open shutter; leave one of the two out"},
    Conflict{kCache, kLightLayers, "not with light groups; leave one of the two out"},
    Conflict{kCache, kRegularize, "not with regularisation; leave one of the two out"},
    Conflict{kCache, kDepthByKind, "not with limits of depth by kind; leave one of the two out"},
    Conflict{kCache, kNoLightSamples,
             "not with a strategy without light samples; leave one of the two out"},
    Conflict{kOrbitStep, kNoShutter, "needs an open shutter"},
    Conflict{kFps, kNoFrames, "needs frames or a shutter"},
    Conflict{kResume, kNoCheckpoint, "needs a checkpoint"},
    Conflict{kCheckpointEvery, kNoCheckpoint, "needs a checkpoint"},
    Conflict{kShard, kTwoPass, kNotTwo},
    Conflict{kCrop, kTwoPass, kNotTwo},
    Conflict{kCheckpoint, kTwoPass, kNotTwo},
    Conflict{kWriteEvery, kTwoPass, kNotTwo},
    Conflict{kPreview, kTwoPass, kNotTwo},
    Conflict{kDisplay, kTwoPass, kNotTwo},
    Conflict{kAutoExposure, kPlate,
             "a composite is shown as its photograph is; give a number of stops"},
    Conflict{kOrbit, kPlate, "the plate of a composite does not turn"},
    Conflict{kTurntable, kPlate, "the plate of a composite does not turn"},
    Conflict{kTurntable, kShutter,
             "models do not turn while the shutter is open; turn the camera, or close the shutter"},
    Conflict{kTurntable, kFromMemory, "is for models of files; build the scene as it shall be"},
    Conflict{kDrop, kFromMemory, "is for models of files; build the scene as it shall be"},
    Conflict{kPlainGround, kOwnGround,
             "[composite] has a ground of its own; give `ground = true` and `ground_height` there"},
    Conflict{kPlainGround, kSurroundings,
             "[surroundings] have a floor of their own; leave one of the two out"},
    Conflict{kTransparent, kComposite,
             "is for plain renders; the layer alpha of a composite shows its objects"},
    Conflict{kScaleByPlate, kShadowCatcher,
             "scale = \"plate\" needs a plate, and a shadow catcher has none"},
    Conflict{kScaleByPlate, kNoGround,
             "scale = \"plate\" needs [composite] with `ground = true`; else give a number"},
    Conflict{kScaleByPlate, kNoProbeFile, "scale = \"plate\" needs a probe's `file`"},
    Conflict{kScaleByPlate, kSurroundings,
             "scale = \"plate\" needs a distant probe, and there are [surroundings]"},
    Conflict{kScaleByPlate, kLamps,
             "scale = \"plate\" needs the probe as the only light, and there are [[light]]"},
    Conflict{kScaleByPlate, kPartOfLight,
             "scale = \"plate\" needs the whole light; give the numbers that a render with all of "
             "it prints"},
};

struct Range {
  std::string_view setting;
  std::string_view should;  // "be ..."
  bool (*isMet)(const D&);
};

// A limit of 0 is never met, as one that underflows.
bool isNotNegative(const std::optional<double>& number) { return !number || *number >= 0; }

constexpr std::array kRanges = {
    Range{"render.size", "have at least one pixel",
          [](const D& d) {
            return d.size ? d.size->width > 0 && d.size->height > 0 : d.settings.height > 0;
          }},
    Range{"render.samples", "be 1 or more", [](const D& d) { return d.settings.samples > 0; }},
    Range{"render.noise", "not be negative",
          [](const D& d) { return isNotNegative(d.settings.noiseLimit); }},
    Range{"render.time", "not be negative",
          [](const D& d) { return isNotNegative(d.settings.timeLimit); }},
    Range{"clamp", "be above 0",
          [](const D& d) { return !d.settings.clamp || *d.settings.clamp > 0; }},
    Range{"render.max_depth", "not be negative",
          [](const D& d) {
            const RenderSettings& s = d.settings;
            return std::min({s.maxDepth, s.maxTransmissionDepth, s.maxDiffuseDepth,
                             s.maxSpecularDepth}) >= 0;
          }},
    Range{"lighting.lights", "be finite, and not negative",
          [](const D& d) { return d.lighting.lamps >= 0 && std::isfinite(d.lighting.lamps); }},
    Range{"orbit", "be finite", [](const D& d) { return std::isfinite(d.camera.orbit); }},
    Range{"turntable", "be finite",
          [](const D& d) { return std::isfinite(d.stand.turntable.value_or(0)); }},
    Range{"render.ground", "be finite",
          [](const D& d) { return std::isfinite(d.stand.height.value_or(0)); }},
    Range{"camera.view", "be finite",
          [](const D& d) {
            const ViewAngles v = d.camera.view.value_or(ViewAngles());
            return std::isfinite(v.azimuth + v.elevation + v.roll);
          }},
    Range{"camera.zoom", "be above 0, and finite",
          [](const D& d) { return d.camera.zoom > 0 && std::isfinite(d.camera.zoom); }},
    Range{"camera.fov", "be above 0, and below 180 degrees",
          [](const D& d) {
            const double fov = d.camera.fov.value_or(90);
            if (!(fov > 0 && fov < 180)) return false;
            const auto& placed = d.camera.placed;
            if (!placed) return true;
            const Camera& lens = placed->lens;
            return lens.orthographic ? lens.halfHeight > 0 && std::isfinite(lens.halfHeight)
                                     : lens.fov > 0 && lens.fov < kPi;
          }},
    Range{"camera.aperture", "be above 0",
          [](const D& d) { return !d.camera.lens || d.camera.lens->aperture > 0; }},
    Range{"camera.focus", "be above 0",
          [](const D& d) { return !d.camera.lens || d.camera.lens->focus > 0; }},
};

}  // namespace

void checkNumbers(const RenderDescription& description) {
  for (const Range& range : kRanges)
    if (!range.isMet(description))
      throwInput("{}: should {}", description.origins.of(range.setting), range.should);
}

std::span<const Conflict> conflicts() { return kConflicts; }

const Conflict* conflictIn(const RenderDescription& description) {
  const auto found = std::ranges::find_if(kConflicts, [&](const Conflict& c) {
    return c.feature.isIn(description) && c.with.isIn(description);
  });
  return found == kConflicts.end() ? nullptr : &*found;
}

void checkCapabilities(const RenderDescription& description) {
  const Conflict* found = conflictIn(description);
  if (!found) return;
  const std::string text =
      fmt::format("{}: {}", description.origins.of(found->feature.setting), found->why);
  if (found->with.setting.empty()) throw InputError(text);
  throw InputError(text, Remedy{std::string(found->with.setting), {}});
}

}  // namespace chromeball
