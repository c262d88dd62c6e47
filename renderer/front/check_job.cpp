// SPDX-License-Identifier: Apache-2.0
#include "front/check_job.h"

#include <algorithm>

#include "base/error.h"
#include "integrate/render_settings.h"
#include "lighting/strategy.h"

namespace chromeball {
namespace {

void checkTwoPass(const SceneFile& file) {
  const Settings& s = file.settings;
  if (!s.get<bool>("two-pass")) return;
  if (!file.composite || isShadowCatcher(s))
    throwInput("{}: is for composites with a plate; the scene file has no [composite] plate",
               s.location("two-pass"));
  const auto refuse = [&](const char* name) {
    throwInput("{}: is biased; leave it out in a reference of two passes", s.location(name));
  };
  if (s.has("clamp")) refuse("clamp");
  for (const char* name : {"render.regularize", "render.denoise"})
    if (s.get<bool>(name)) refuse(name);
  if (s.get<std::string>("render.glass_shadows") == "straight") refuse("render.glass_shadows");
}

void checkGuide(const SceneFile& file) {
  const Settings& s = file.settings;
  if (s.get<std::string>("render.guide") != "on") return;
  const std::string location = s.location("render.guide");
  const std::string strategy = resolveStrategy(s.get<std::string>("lighting.strategy"));
  if (s.get<bool>("two-pass"))
    throwInput("{}: a reference of two passes is not guided; leave one of the two out", location);
  if (strategy != "importance")
    throwInput("{}: guides renders with the strategy `importance`, not with `{}`", location,
               strategy);
}

void checkShowLights(const SceneFile& file) {
  const Settings& s = file.settings;
  const std::string strategy = s.get<std::string>("lighting.strategy");
  if (s.get<bool>("lighting.show_lights") && !hasLights(strategy))
    throwInput(
        "{}: the strategy `{}` has no lights; give one that replaces the probe by lights, "
        "such as median-cut:64",
        s.location("lighting.show_lights"), resolveStrategy(strategy));
}

void checkDenoise(const SceneFile& file) {
  const Settings& s = file.settings;
  const auto layers = s.get<std::vector<std::string>>("output.aovs");
  const bool wantsLayers = std::ranges::count(layers, "denoise") > 0;
  const bool denoises = s.get<bool>("render.denoise");
  if (!denoises && !wantsLayers) return;
  const std::string location = s.location(denoises ? "render.denoise" : "output.aovs");
  if (file.composite && wantsLayers)
    throwInput("{}: composites have no layers to denoise later; give --denoise",
               s.location("output.aovs"));
  if (s.has("render.samples") && s.get<uint64_t>("render.samples") < 2)
    throwInput("{}: needs at least 2 samples per pixel", location);
}

void checkGroups(const SceneFile& file) {
  const Settings& s = file.settings;
  const auto layers = s.get<std::vector<std::string>>("output.aovs");
  const auto found = std::ranges::find_if(layers, isOfLight);
  if (found == layers.end()) return;
  if (file.composite)
    throwInput("{}: composites have no `{}`; render the scene without [composite]",
               s.location("output.aovs"), *found);
  if (s.get<bool>("render.denoise"))
    throwInput("{}: `{}` would not add up to the denoised picture; leave one of the two out",
               s.location("render.denoise"), *found);
}

void checkIntegrator(const SceneFile& file) {
  const Settings& s = file.settings;
  const std::string name = s.get<std::string>("render.integrator");
  const bool approximates = name == "environment-map" || name == "ambient-occlusion";
  for (const char* flag : {"render.ao", "render.reflection_occlusion"})
    if (s.get<bool>(flag) && name != "environment-map")
      throwInput("{}: is for `--integrator environment-map`", s.location(flag));
  const auto layers = s.get<std::vector<std::string>>("output.aovs");
  const auto wants = [&](const char* layer) { return std::ranges::count(layers, layer) > 0; };
  if (s.has("render.ao_distance") && !approximates && !wants("ao") && !wants("bent_normal"))
    throwInput("{}: is for ambient occlusion: `--aov ao,bent_normal`, or an integrator with it",
               s.location("render.ao_distance"));
  // The default has no effect and is in the header that reproduces an image.
  if (s.get<std::string>("render.bent") != "cosine" && !wants("bent_normal"))
    throwInput("{}: is for the layer of `--aov bent_normal`", s.location("render.bent"));
  if (!approximates) return;
  const std::string location = s.location("render.integrator");
  const auto refuse = [&](std::string_view what) {
    throwInput("{}: {} knows only light of a distant probe; leave {} out", location, name, what);
  };
  if (file.composite) refuse("[composite]");
  if (file.surroundings) refuse("[surroundings]");
  if (!file.sources.empty()) refuse("[[source]]");
  if (s.get<bool>("lighting.show_lights")) refuse("--show-lights");
  if (std::ranges::any_of(layers, isOfLight)) refuse("the light groups");
  if (s.get<std::string>("render.guide") == "on") refuse("--guide on");
  if (s.get<bool>("render.regularize")) refuse("--regularize");
  if (s.has("render.max_diffuse_depth") || s.has("render.max_specular_depth"))
    refuse("the limits of depth");
}

void checkCache(const SceneFile& file) {
  const Settings& s = file.settings;
  if (!s.has("render.irradiance_cache")) {
    if (s.has("cache")) throwInput("{}: needs --irradiance-cache ERROR", s.location("cache"));
    return;
  }
  const auto refuse = [&](std::string_view what) {
    throwInput("{}: not with {}; leave one of the two out", s.location("render.irradiance_cache"),
               what);
  };
  const std::string integrator = s.get<std::string>("render.integrator");
  if (integrator != "path") refuse("--integrator " + integrator);
  if (file.composite) refuse("[composite]");
  if (s.getIfGiven<double>("camera.shutter").value_or(0) > 0) refuse("--shutter");
  const auto layers = s.get<std::vector<std::string>>("output.aovs");
  if (std::ranges::any_of(layers, isOfLight)) refuse("light groups");
  if (s.get<bool>("render.regularize")) refuse("--regularize");
  if (s.has("render.max_diffuse_depth") || s.has("render.max_specular_depth"))
    refuse("limits of depth by kind");
  if (resolveStrategy(s.get<std::string>("lighting.strategy")) == "bsdf")
    refuse("a strategy without light samples");
}

void checkShutter(const SceneFile& file) {
  const Settings& s = file.settings;
  if (s.has("orbit-step") && !s.has("camera.shutter"))
    throwInput("{}: needs --shutter FRAMES", s.location("orbit-step"));
}

void checkParts(const SceneFile& file) {
  const Settings& s = file.settings;
  if (s.get<bool>("resume") && !s.has("checkpoint"))
    throwInput("{}: needs --checkpoint FILE.exr", s.location("resume"));
  if (s.has("checkpoint-every") && !s.has("checkpoint"))
    throwInput("{}: needs --checkpoint FILE.exr", s.location("checkpoint-every"));
  if (!s.get<bool>("two-pass")) return;
  for (const char* name : {"shard", "crop", "checkpoint", "write-every", "preview", "display"})
    if (s.has(name))
      throwInput("{}: not for a reference of two passes; leave one of the two out",
                 s.location(name));
}

void checkOrbit(const SceneFile& file) {
  if (file.composite && !isShadowCatcher(file.settings) && file.settings.has("orbit"))
    throwInput("{}: the plate of a composite does not turn", file.settings.location("orbit"));
}

void checkTransparent(const SceneFile& file) {
  const Settings& s = file.settings;
  if (file.composite && s.get<bool>("transparent"))
    throwInput("{}: is for plain renders; the layer alpha of a composite shows its objects",
               s.location("transparent"));
}

void checkPlateScale(const SceneFile& file) {
  if (!file.plateScale) return;
  const Settings& s = file.settings;
  const auto refuse = [&](const char* why) {
    throwInput("{}: scale = \"plate\" {}", *file.plateScale, why);
  };
  if (!file.composite || !s.get<bool>("composite.ground"))
    refuse("needs [composite] with `ground = true`; else give a number");
  if (isShadowCatcher(s)) refuse("needs a plate, and a shadow catcher has none");
  if (!s.has("probe.file")) refuse("needs a probe's `file`");
  if (file.surroundings) refuse("needs a distant probe, and there are [surroundings]");
  if (!file.lamps.empty()) refuse("needs the probe as the only light, and there are [[light]]");
  if (s.get<std::string>("lighting.from") != "all")
    refuse("needs the whole light; give the numbers that a render with all of it prints");
}

}  // namespace

void checkJob(const SceneFile& file) {
  checkTwoPass(file);
  checkGuide(file);
  checkShowLights(file);
  checkDenoise(file);
  checkGroups(file);
  checkIntegrator(file);
  checkCache(file);
  checkShutter(file);
  checkParts(file);
  checkOrbit(file);
  checkTransparent(file);
  checkPlateScale(file);
}

}  // namespace chromeball
