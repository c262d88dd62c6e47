// SPDX-License-Identifier: Apache-2.0
#include "job/render_job.h"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "base/error.h"
#include "composite/layers.h"
#include "job/arguments.h"
#include "job/scene_file_camera.h"

namespace chromeball {
namespace {

Mis misNamed(const std::string& name) {
  return name == "off" ? Mis::Off : name == "power" ? Mis::Power : Mis::Balance;
}

Guiding guidingNamed(const std::string& name) {
  return name == "off" ? Guiding::Off : name == "on" ? Guiding::On : Guiding::Auto;
}

// Whole numbers up to a million, with this character between; nullopt for any other text.
std::optional<std::vector<uint32_t>> splitNumbers(const std::string& text, char between) {
  std::vector<uint32_t> numbers;
  const char *at = text.data(), *end = at + text.size();
  for (;; ++at) {
    uint32_t number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc() || number > 1'000'000) return {};
    numbers.push_back(number);
    at = next;
    if (at == end) return numbers;
    if (*at != between) return {};
  }
}

SingleSided singleSidedNamed(const std::string& name) {
  return name == "off"     ? SingleSided::Off
         : name == "light" ? SingleSided::Light
                           : SingleSided::Camera;
}

NamedSetting named(const Settings& settings, std::string_view name) {
  return {settings.get<std::string>(name), settings.location(name)};
}

// Applies the settings that are stored per model.
void applyToModels(const Settings& over, SceneFile& file) {
  const Settings& all = file.settings;
  for (ModelEntry& model : file.models) {
    GltfChoice& choice = model.choice;
    for (const char* name : {"model.time", "model.animation"})
      if (over.has(name)) {
        if (!choice.animation) choice.animation.emplace();
        choice.animation->ifAny =
            (all.has("frames") || !file.probeTurns.empty()) && !over.has("model.animation");
        if (choice.animation->location.empty() || name == std::string_view("model.animation"))
          choice.animation->location = over.location(name);
      }
    if (const auto time = over.getIfGiven<double>("model.time")) choice.animation->seconds = *time;
    if (const auto name = over.getIfGiven<std::string>("model.animation"))
      choice.animation->name = *name;
    if (const auto variant = over.getIfGiven<std::string>("model.variant"))
      choice.variant = {*variant, over.location("model.variant")};
    choice.lightUnits = parseLightUnits(named(all, "lighting.light_units"));
    if (all.get<bool>("allow-external")) choice.external = ExternalFiles::Allow;
  }
}

// Before the first key and after the last one constant.
std::vector<double> rotationAt(const std::vector<ProbeTurn>& keys, double seconds) {
  const auto after = std::upper_bound(keys.begin(), keys.end(), seconds,
                                      [](double t, const auto& key) { return t < key.seconds; });
  if (after == keys.begin()) return keys.front().rotation;
  if (after == keys.end()) return keys.back().rotation;
  const ProbeTurn &from = *(after - 1), &to = *after;
  const double elapsed = seconds - from.seconds, duration = to.seconds - from.seconds;
  if (from.rotation.size() == 1 && to.rotation.size() == 1) {
    const double degrees = from.rotation.front();
    return {degrees + (to.rotation.front() - degrees) * elapsed / duration};
  }
  return numbersOf(between(parseRotation(from.rotation, "rotation_keys"),
                           parseRotation(to.rotation, "rotation_keys"), elapsed / duration));
}

void mergeCamera(SceneFile& file, const Settings& over) {
  const auto path = over.getIfGiven<std::string>("camera.file");
  if (over.has("camera.name")) {
    if (path)
      throwInput("{}: excludes {}; give one", over.location("camera.file"),
                 over.location("camera.name"));
    if (file.settings.has("camera.file")) file.optics.reset();
    file.settings.erase("camera.file");
    file.camera.reset();
  }
  if (path) {
    file.settings.erase("camera.name");
    readCameraFile(*path, file);
  }
}

// Overrides the settings of the scene file by `over`.
void merge(SceneFile& file, const Settings& over) {
  mergeCamera(file, over);
  const std::string_view limits[] = {"render.samples", "render.time", "render.noise"};
  const auto isGiven = [&](std::string_view name) { return over.has(name); };
  if (std::any_of(std::begin(limits), std::end(limits), isGiven))  // the limits are one decision
    for (const std::string_view name : limits) file.settings.erase(name);
  if (over.has("probe.scale")) file.plateScale.reset();
  file.settings.merge(over);
  applyToModels(over, file);
  if (!file.probeTurns.empty() && !over.has("probe.rotation"))
    file.settings.set(
        "probe.rotation",
        rotationAt(file.probeTurns, over.getIfGiven<double>("model.time").value_or(0)));
}

// --shadow-catcher NODE,...: a composite without a plate.
void applyShadowCatcher(SceneFile& file) {
  const auto nodes = file.settings.getIfGiven<std::string>("shadow-catcher");
  if (!nodes) return;
  const std::string location = file.settings.location("shadow-catcher");
  if (file.composite)
    throwInput("{}: the scene file has [composite]; give it mode = \"shadow-catcher\"", location);
  file.settings.set("composite.mode", std::string("shadow-catcher"), location);
  file.composite.emplace().location = location;
  std::istringstream names(*nodes);
  for (std::string name; std::getline(names, name, ',');)
    file.composite->localScene.push_back({name, location});
  if (file.composite->localScene.empty()) throwInput("{}: names no node", location);
}

constexpr std::string_view kLightGroups = "light_groups", kShadowMattes = "shadow_mattes";

bool isOfLight(std::string_view layer) { return layer == kLightGroups || layer == kShadowMattes; }

// The layers of plain renders; those of composites are in CompositePlan.
std::vector<Aov> layersOf(const SceneFile& file) {
  std::vector<Aov> layers;
  const std::string location = file.settings.location("output.aovs");
  for (const auto& name : file.settings.get<std::vector<std::string>>("output.aovs")) {
    if (isOfLight(name)) continue;
    const CompositeLayerInfo* composite = findCompositeLayer(name);
    if (!composite || composite->layer == CompositeLayer::Alpha)
      layers.push_back(aovFromName(name, location));
    else if (!file.composite)
      throwInput("{}: layer `{}` is a composite's; the scene file has no [composite]", location,
                 name);
  }
  return layers;
}

// "K/N": the K-th of N shards of all samples.
RenderSettings withShard(const Settings& s, RenderSettings whole) {
  const auto text = s.getIfGiven<std::string>("shard");
  if (!text) return whole;
  const auto numbers = splitNumbers(*text, '/');
  if (!numbers || numbers->size() != 2 || (*numbers)[0] < 1 || (*numbers)[0] > (*numbers)[1])
    throwInput("{}: `{}` is not a shard; give K/N with K from 1 to N, such as 2/8",
               s.location("shard"), *text);
  const uint32_t index = (*numbers)[0] - 1, count = (*numbers)[1];
  if (whole.samples / 2 < count)
    throwInput("{}: {} samples per pixel are less than two for each of {} shards",
               s.location("shard"), whole.samples, count);
  return shardOf(std::move(whole), index, count);
}

std::optional<Crop> cropOf(const Settings& s) {
  const auto text = s.getIfGiven<std::string>("crop");
  if (!text) return {};
  const auto numbers = splitNumbers(*text, ',');
  if (!numbers || numbers->size() != 4 || (*numbers)[2] < 1 || (*numbers)[3] < 1)
    throwInput("{}: `{}` is not a part of an image; give X,Y,WIDTH,HEIGHT in pixels",
               s.location("crop"), *text);
  const auto& n = *numbers;
  return Crop{int(n[0]), int(n[1]), int(n[2]), int(n[3])};
}

RenderSettings integratorSettings(const SceneFile& file) {
  const Settings& s = file.settings;
  RenderSettings r;
  r.timeLimit = s.getIfGiven<double>("render.time");
  r.noiseLimit = s.getIfGiven<double>("render.noise");
  if (r.noiseLimit) *r.noiseLimit /= 100;
  r.samples = uint32_t(s.get<uint64_t>("render.samples"));
  if ((r.timeLimit || r.noiseLimit) && !s.has("render.samples")) r.samples = kMaxSamples;
  r.crop = cropOf(s);
  r.adaptive = s.get<std::string>("render.adaptive") == "on";
  r.guiding = guidingNamed(s.get<std::string>("render.guide"));
  r.maxDepth = int(s.get<uint64_t>("render.max_depth"));
  r.maxTransmissionDepth = int(s.get<uint64_t>("render.max_transmission_depth"));
  r.seed = s.get<uint64_t>("render.seed");
  r.mis = misNamed(s.get<std::string>("lighting.mis"));
  r.hideProbe = s.get<bool>("transparent");
  if (const auto clamp = s.getIfGiven<double>("clamp")) r.clamp = float(*clamp);
  r.aovs = layersOf(file);
  const auto layers = s.get<std::vector<std::string>>("output.aovs");
  r.lightGroups = std::ranges::count(layers, kLightGroups) > 0;
  r.shadowMattes = std::ranges::count(layers, kShadowMattes) > 0;
  r.regularize = s.get<bool>("render.regularize");
  r.denoise = s.get<bool>("render.denoise");
  if (r.hideProbe && std::count(r.aovs.begin(), r.aovs.end(), Aov::Alpha) == 0)
    r.aovs.push_back(Aov::Alpha);
  return withShard(s, std::move(r));
}

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

RenderJob planJob(SceneFile scene, const Settings& over) {
  RenderJob job;
  job.file = std::move(scene);
  merge(job.file, over);
  applyShadowCatcher(job.file);
  const Settings& s = job.file.settings;
  parseRotation(s.get<std::vector<double>>("probe.rotation"), s.location("probe.rotation"));
  checkTwoPass(job.file);
  checkTransparent(job.file);
  checkOrbit(job.file);
  checkGuide(job.file);
  checkShowLights(job.file);
  checkDenoise(job.file);
  checkGroups(job.file);
  checkParts(job.file);
  checkPlateScale(job.file);
  job.settings = integratorSettings(job.file);
  job.size = s.getIfGiven<ImageSize>("render.size");
  job.singleSided = singleSidedNamed(s.get<std::string>("render.single_sided"));
  job.straightGlassShadows = s.get<std::string>("render.glass_shadows") == "straight";
  job.strategy = named(s, "lighting.strategy");
  job.outputs = s.get<std::vector<std::string>>("output.file");
  job.makesOutputFolders = !over.has("output.file");
  job.display = {parseToneOperator(s.get<std::string>("tonemap")),
                 float(s.get<double>("exposure"))};
  if (job.file.composite) planComposite(job);
  return job;
}

}  // namespace chromeball
