// SPDX-License-Identifier: Apache-2.0
#include "description/describe.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <climits>
#include <cmath>

#include "base/json.h"
#include "base/text.h"
#include "film/aov.h"
#include "lighting/strategy.h"
#include "render/render_settings.h"

namespace chromeball {
namespace {

using Json = nlohmann::ordered_json;

// Null where there is no limit.
Json limitOf(int depth) { return depth < INT_MAX ? Json(depth) : Json(); }
// What a text of `otherwise` says; `otherwise` where rounding to the text has left the range.
double numberIn(const std::string& text, double otherwise) {
  double number = 0;
  return toNumber(text, number) ? number : otherwise;
}
// The shortest number that reads as this float.
Json numberOf(float x) { return numberIn(fmt::format("{}", x), x); }
Json numberOf(const std::optional<float>& x) { return x ? numberOf(*x) : Json(); }
Json numberOf(const std::optional<double>& x) { return x ? Json(*x) : Json(); }
// The shortest number near `guess` that `map` maps exactly to `image`, as it did with the user's
// number; `guess` if rounding leaves none.
template <class Map>
Json inverseOf(const Map& map, double image, double guess) {
  for (const double number : {numberIn(fmt::format("{:.15g}", guess), guess), guess,
                              std::nextafter(guess, -INFINITY), std::nextafter(guess, INFINITY)})
    if (map(number) == image) return number;
  return guess;
}
Json nameAt(int index, std::initializer_list<const char*> names) { return names.begin()[index]; }
Json textOf(const std::optional<std::string>& text) { return text ? Json(*text) : Json(); }

std::vector<std::string> plainLayers(const RenderSettings& settings) {
  std::vector<std::string> names;
  for (const Aov aov : settings.aovs) names.emplace_back(aovInfo(aov).name);
  if (settings.lightGroups) names.emplace_back(kLightGroups);
  if (settings.shadowMattes) names.emplace_back(kShadowMattes);
  return names;
}

// Alpha is a layer of a transparent image by itself.
Json layersText(const RenderDescription& description) {
  std::vector<std::string> names = layerNames(description);
  if (description.settings.hideProbe) std::erase(names, aovInfo(Aov::Alpha).name);
  return names.empty() ? Json() : Json(fmt::format("{}", fmt::join(names, ",")));
}

Json cropText(const RenderSettings& settings) {
  const auto& c = settings.crop;
  return c ? Json(fmt::format("{},{},{},{}", c->x, c->y, c->width, c->height)) : Json();
}

Json shardText(const Shard& shard) {
  if (shard.samplesOfAll == 0) return {};
  return fmt::format("{}/{}", shard.index + 1, shard.count);
}

// One number, or several with commas between.
Json numbersText(const std::vector<double>& numbers) {
  if (numbers.size() == 1) return numbers.front();
  return fmt::format("{}", fmt::join(numbers, ","));
}

Json rotationText(const Rotation& rotation) {
  return rotation.isTilted() ? numbersText(rotation.numbers()) : numberOf(rotation.yaw());
}

std::vector<double> scaleNumbers(const glm::dvec3& scale) {
  if (scale.x == scale.y && scale.y == scale.z) return {scale.x};
  return {scale.x, scale.y, scale.z};
}

// The following add values; null or false: there is none.

void addRender(const RenderDescription& description, Json& d) {
  const RenderSettings& s = description.settings;
  d.update({{"size", fmt::format("{}x{}", s.width, s.height)},
            {"noise-limit", s.noiseLimit ? inverseOf([](double p) { return p / 100; },
                                                     *s.noiseLimit, 100 * *s.noiseLimit)
                                         : Json()},
            {"time-limit", numberOf(s.timeLimit)},
            {"samples-limit", s.samplesOfAll() < kMaxSamples ? Json(s.samplesOfAll()) : Json()},
            {"crop", cropText(s)},
            {"shard", shardText(s.shard)},
            {"adaptive", nameAt(s.adaptive, {"off", "on"})},
            {"guide", nameAt(int(s.guiding), {"off", "on", "auto"})},
            {"max-depth", limitOf(s.maxDepth)},
            {"max-transmission-depth", limitOf(s.maxTransmissionDepth)},
            {"max-diffuse-depth", limitOf(s.maxDiffuseDepth)},
            {"max-specular-depth", limitOf(s.maxSpecularDepth)},
            {"integrator", kIntegratorNames[size_t(s.integrator)]},
            {"ao", s.occlusion.ambient},
            {"reflection-occlusion", s.occlusion.reflection},
            {"ao-distance",
             std::isfinite(s.occlusion.distance) ? numberOf(s.occlusion.distance) : Json()},
            {"bent", nameAt(s.occlusion.uniformBent, {"cosine", "uniform"})},
            {"irradiance-cache", numberOf(s.cacheError)},
            {"mis", nameAt(int(s.mis), {"off", "balance", "power"})},
            {"seed", s.seed},
            {"transparent", s.hideProbe},
            {"clamp", numberOf(s.clamp)},
            {"regularize", s.regularize},
            {"denoise", s.denoise},
            {"single-sided", nameAt(int(description.singleSided), {"camera", "light", "off"})},
            {"glass-shadows", nameAt(description.straightGlassShadows, {"refract", "straight"})},
            {"aov", layersText(description)}});
}

void addLight(const RenderDescription& description, Json& d) {
  const ProbeDescription& probe = description.probe;
  const LightingDescription& light = description.lighting;
  d.update({{"probe", textOf(probe.file)},
            {"probe-mapping", probe.file ? Json(probe.mapping) : Json()},
            {"probe-rotation", rotationText(probe.rotation)},
            {"probe-scale", numbersText(scaleNumbers(probe.scale))},
            {"strategy", resolveStrategy(light.strategy)},
            {"light-from", nameAt(int(light.from), {"all", "suns", "rest"})},
            {"lights", light.lamps},
            {"sun-angle", numberOf(light.sunAngle)},
            {"show-lights", light.showLights}});
}

Json orbitStep(const Shutter& shutter) {
  return inverseOf([&](double step) { return shutter.frames * step; }, shutter.turn,
                   shutter.turn / shutter.frames);
}

void addCamera(const CameraDescription& camera, Json& d) {
  d.update({{"camera", textOf(camera.name)},
            {"camera-file", textOf(camera.file)},
            {"look-at", textOf(camera.node)},
            {"fov", numberOf(camera.fov)},
            {"zoom", camera.zoom != 1 ? Json(camera.zoom) : Json()},
            {"orbit", camera.orbit != 0 ? Json(camera.orbit) : Json()}});
  if (const auto& view = camera.view)
    d["view"] = fmt::format("{},{},{}", view->azimuth, view->elevation, view->roll);
  if (const auto& shutter = camera.shutter)
    d.update({{"shutter", shutter->frames},
              {"shutter-steps", shutter->steps},
              {"fps", shutter->fps},
              {"orbit-step", shutter->turn != 0 ? orbitStep(*shutter) : Json()}});
}

void addStand(const StandDescription& stand, Json& d) {
  d["turntable"] = stand.turntable.value_or(0) != 0 ? Json(*stand.turntable) : Json();
  d["drop"] = stand.drops;
  if (stand.hasGround) d["ground"] = stand.height ? fmt::format("{}", *stand.height) : "auto";
}

// Options that hold for all models.
void addModels(const RenderDescription& description, Json& d) {
  if (description.models.empty()) return;
  const GltfChoice& choice = description.models.front().choice;
  const Origins& origins = description.origins;
  const auto& animation = choice.animation;
  d.update(
      {{"light-units", nameAt(int(choice.lightUnits), {"photometric", "radiometric"})},
       {"allow-external", choice.external == ExternalFiles::Allow},
       {"variant",
        origins.has("model.variant") && choice.variant ? Json(choice.variant->name) : Json()},
       {"animation", origins.has("model.animation") && animation ? Json(animation->name) : Json()},
       {"animation-time",
        origins.has("model.time") && animation ? Json(animation->seconds) : Json()}});
}

void addComposite(const RenderDescription& description, Json& d) {
  const auto& composite = description.composite;
  if (!composite) return;
  d["two-pass"] = composite->passes == Passes::Two;
  if (!description.origins.has("shadow-catcher")) return;
  d["shadow-catcher"] = fmt::format("{}", fmt::join(composite->entry.localScene, ","));
}

}  // namespace

std::vector<std::string> layerNames(const RenderDescription& description) {
  return description.composite ? description.composite->layers : plainLayers(description.settings);
}

Json describe(const RenderDescription& description) {
  Json all = {{"scene", description.path.empty() ? Json() : Json(description.path)}};
  addRender(description, all);
  addLight(description, all);
  addCamera(description.camera, all);
  addStand(description.stand, all);
  addModels(description, all);
  addComposite(description, all);
  addParts(description, all);
  Json d;
  for (const auto& [name, value] : all.items())
    if (!value.is_null() && value != Json(false)) d[name] = value;
  return d;
}

}  // namespace chromeball
