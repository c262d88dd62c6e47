// SPDX-License-Identifier: Apache-2.0
#include "front/plan_render.h"

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "composite/layers.h"
#include "description/capabilities.h"
#include "front/arguments.h"
#include "front/settings.h"

namespace chromeball {
namespace {

// Whole numbers up to a million, with this character between; nullopt for any other text.
std::optional<std::vector<uint32_t>> splitNumbers(const std::string& text, char between) {
  std::vector<uint32_t> numbers;
  for (const std::string_view part : splitAt(text, between)) {
    const bool isWhole = part.find_first_not_of("0123456789") == std::string_view::npos &&
                         toNumber(part, numbers.emplace_back());
    if (!isWhole || numbers.back() > 1'000'000) return {};
  }
  return numbers;
}

// The layers of plain renders; the layers of composites are in CompositeDescription.
std::vector<Aov> layersOf(const SceneFile& file) {
  std::vector<Aov> layers;
  const std::string location = file.settings.location("output.aovs");
  for (const auto& name : file.settings.get<std::vector<std::string>>("output.aovs")) {
    if (isOfLight(name)) continue;
    const CompositeLayerInfo* composite = findCompositeLayer(name);
    if (!composite || composite->layer == CompositeLayer::Alpha)
      layers.push_back(aovFromName(name, location));
    else if (!file.composite)
      throwInput("{}: layer `{}` is a composite's, and this is none", location, name);
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
  const auto guide = s.get<std::string>("render.guide");
  r.guiding = guide == "off" ? Guiding::Off : guide == "on" ? Guiding::On : Guiding::Auto;
  r.maxDepth = int(s.get<uint64_t>("render.max_depth"));
  if (const auto depth = s.getIfGiven<uint64_t>("render.max_diffuse_depth"))
    r.maxDiffuseDepth = int(*depth);
  if (const auto depth = s.getIfGiven<uint64_t>("render.max_specular_depth"))
    r.maxSpecularDepth = int(*depth);
  r.integrator = s.choice<IntegratorKind>("render.integrator");
  if (const auto error = s.getIfGiven<double>("render.irradiance_cache"))
    r.cacheError = float(*error);
  r.occlusion.ambient = s.get<bool>("render.ao");
  r.occlusion.reflection = s.get<bool>("render.reflection_occlusion");
  if (const auto distance = s.getIfGiven<double>("render.ao_distance"))
    r.occlusion.distance = float(*distance);
  r.occlusion.uniformBent = s.choice<bool>("render.bent");
  r.maxTransmissionDepth = int(s.get<uint64_t>("render.max_transmission_depth"));
  r.seed = s.get<uint64_t>("render.seed");
  r.mis = s.choice<Mis>("lighting.mis");
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

std::optional<Shutter> shutterOf(const Settings& s) {
  const auto open = s.getIfGiven<double>("camera.shutter");
  if (!open || *open == 0) return {};
  Shutter shutter{*open, s.get<double>("fps")};
  if (const auto steps = s.getIfGiven<uint64_t>("camera.shutter_steps"))
    shutter.steps = int(*steps);
  shutter.turn = *open * s.getIfGiven<double>("orbit-step").value_or(0);
  return shutter;
}

std::optional<ViewAngles> plannedView(const Settings& s) {
  const auto angles = s.getIfGiven<std::vector<double>>("camera.view");
  if (!angles) return {};
  constexpr double kUsualElevation = 18;
  const double elevation = angles->size() > 1 ? (*angles)[1] : kUsualElevation;
  if (std::fabs(elevation) > 90)
    throwInput("{}: the elevation, {:g} degrees, should be from -90 to 90",
               s.location("camera.view"), elevation);
  return ViewAngles{angles->front(), elevation, angles->size() > 2 ? angles->back() : 0};
}

StandDescription plannedStand(const Settings& s) {
  StandDescription stand{.turntable = s.getIfGiven<double>("turntable"),
                         .drops = s.get<bool>("render.drop"),
                         .hasGround = s.has("render.ground")};
  double height = 0;  // the only other text is "auto"
  if (stand.hasGround && toNumber(s.get<std::string>("render.ground"), height))
    stand.height = height;
  return stand;
}

CameraDescription plannedCamera(const SceneFile& file) {
  const Settings& s = file.settings;
  return {.placed = file.camera,
          .name = s.getIfGiven<std::string>("camera.name"),
          .file = s.getIfGiven<std::string>("camera.file"),
          .lens = file.lens,
          .optics = file.optics,
          .view = plannedView(s),
          .node = s.getIfGiven<std::string>("camera.look_at_node"),
          .fov = s.getIfGiven<double>("camera.fov"),
          .zoom = s.getIfGiven<double>("camera.zoom").value_or(1),
          .orbit = s.getIfGiven<double>("orbit").value_or(0),
          .turns = s.has("orbit") || s.has("orbit-step"),
          .shutter = shutterOf(s)};
}

ProbeDescription plannedProbe(const SceneFile& file) {
  const Settings& s = file.settings;
  return {.file = s.getIfGiven<std::string>("probe.file"),
          .mapping = s.get<std::string>("probe.mapping"),
          .rotation = parseRotation(s.get<std::vector<double>>("probe.rotation"),
                                    s.location("probe.rotation")),
          .scale = colorOf(s.get<std::vector<double>>("probe.scale")),
          .isScaledByPlate = file.plateScale.has_value()};
}

LightingDescription plannedLighting(const Settings& s) {
  return {.strategy = s.get<std::string>("lighting.strategy"),
          .from = s.choice<LightFrom>("lighting.from"),
          .lamps = s.get<double>("lighting.lights"),
          .sunAngle = s.getIfGiven<double>("lighting.sun_angle"),
          .showLights = s.get<bool>("lighting.show_lights")};
}

RunDescription plannedRun(const Settings& s) {
  const auto bytes = [&](const char* name) {
    const auto gigabytes = s.getIfGiven<double>(name);
    return gigabytes ? std::optional(1e9 * *gigabytes) : std::nullopt;
  };
  return {.memory = bytes("memory"),
          .textureMemory = bytes("texture-memory"),
          .cache = s.getIfGiven<std::string>("cache"),
          .checkpoint = s.getIfGiven<std::string>("checkpoint"),
          .checkpointEvery = s.get<double>("checkpoint-every"),
          .writeEvery = s.getIfGiven<double>("write-every"),
          .resumes = s.get<bool>("resume"),
          .isOfFrames = s.has("frames")};
}

DevelopSettings plannedDevelop(const Settings& s) {
  const auto text = s.getIfGiven<std::string>("output.develop");
  if (!text) return {};
  const std::string location = s.location("output.develop");
  DevelopSettings develop = parseDevelop(*text, location);
  if (develop.lens &&
      std::ranges::count(s.get<std::vector<std::string>>("output.aovs"), "depth") == 0)
    throw InputError(fmt::format("{}: depth-blur needs the layer `depth`", location),
                     Remedy{"output.aovs", "depth"});
  return develop;
}

OutputDescription plannedOutput(const Settings& s) {
  OutputDescription output{.files = s.get<std::vector<std::string>>("output.file"),
                           .layers = s.get<std::vector<std::string>>("output.aovs"),
                           .stats = s.getIfGiven<std::string>("stats"),
                           .noiseMap = s.getIfGiven<std::string>("noise-map")};
  const PlannedDisplay display = planDisplay(s);
  output.display = display.transform, output.choosesExposure = display.choosesExposure;
  output.develop = plannedDevelop(s);
  return output;
}

// From a temperature, or a colour.
Rgb plannedBalance(const Settings& s) {
  const auto light = s.getIfGiven<std::vector<double>>("output.white_balance");
  if (!light) return Rgb(1);
  if (light->size() == 3 && std::ranges::all_of(*light, isPositiveFloat))
    return balanceOf(Rgb(colorOf(*light)));
  const double kelvin = light->front();
  if (light->size() == 3 || kelvin < kLeastKelvin || kelvin > kMostKelvin)
    throwInput("{}: should be {:g} to {:g} kelvin, or a colour with channels above 0",
               s.location("output.white_balance"), kLeastKelvin, kMostKelvin);
  return balanceOf(kelvin);
}

}  // namespace

PlannedDisplay planDisplay(const Settings& settings) {
  const auto exposure = settings.get<std::string>("output.exposure");
  double stops = 0;
  const bool isChosen = !toNumber(exposure, stops);  // the only other text is "auto"
  return {{parseToneOperator(settings.get<std::string>("output.tonemap")), float(stops),
           plannedBalance(settings)},
          isChosen};
}

RenderDescription planRender(SceneFile scene, const Settings& over) {
  overrideSettings(scene, over);
  RenderDescription description;
  static_cast<SceneParts&>(description) = scene;
  const Settings& s = scene.settings;
  for (const Setting& setting : settingTable())
    if (const auto* given = s.find(setting.name()); given && !scene.origins.has(setting.name()))
      description.origins.set(setting.name(), given->location);
  description.camera = plannedCamera(scene);
  description.stand = plannedStand(s);
  description.probe = plannedProbe(scene);
  if (scene.plateScale) description.origins.set("probe.scale", *scene.plateScale);
  description.lighting = plannedLighting(s);
  description.settings = integratorSettings(scene);
  description.size = s.getIfGiven<ImageSize>("render.size");
  description.choosesSides = !s.has("render.single_sided");
  if (!description.choosesSides)
    description.singleSided = s.choice<SingleSided>("render.single_sided");
  description.straightGlassShadows = s.choice<bool>("render.glass_shadows");
  description.output = plannedOutput(s);
  description.output.makesFolders = !over.has("output.file");
  description.run = plannedRun(s);
  if (scene.composite) planComposite(s, std::move(*scene.composite), description);
  if (description.hasPlate() && !s.has("output.exposure"))
    description.output.choosesExposure = false;
  checkCapabilities(description);
  return description;
}

}  // namespace chromeball
