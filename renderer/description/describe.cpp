// SPDX-License-Identifier: Apache-2.0
#include "description/describe.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <climits>
#include <cmath>
#include <filesystem>

#include "base/checksum.h"
#include "base/hash.h"
#include "base/json.h"
#include "base/json_text.h"
#include "description/scene_hash.h"
#include "film/aov.h"
#include "lighting/strategy.h"
#include "render/render_settings.h"

namespace chromeball {
namespace {

using Json = nlohmann::ordered_json;

// Folders may differ where the contents are the same.
std::string fileName(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

template <class Vector>
Json numbersIn(const Vector& v) {
  Json numbers = Json::array();
  for (int i = 0; i < int(Vector::length()); ++i) numbers.push_back(v[i]);
  return numbers;
}

Json partOf(const ModelEntry& model) {
  const GltfChoice& choice = model.choice;
  Json part = {{"file", fileName(model.file)},
               {"linear", Json::array()},
               {"translation", numbersIn(model.placement.translation)},
               {"external", int(choice.external)},
               {"units", int(choice.lightUnits)},
               {"environment", choice.environment}};
  for (int column = 0; column < 3; ++column)
    part["linear"].push_back(numbersIn(model.placement.linear[column]));
  if (choice.variant) part["variant"] = choice.variant->name;
  return part;
}

Json partOf(const CameraEntry& entry) {
  const Camera& lens = entry.lens;
  return {{"position", numbersIn(entry.position)},
          {"target", numbersIn(entry.target)},
          {"up", numbersIn(entry.up)},
          {"orthographic", lens.orthographic},
          {"view", {lens.fov, lens.halfHeight, lens.aspect}},
          {"lens", {lens.lensRadius, lens.focus}},
          {"principalPoint", numbersIn(lens.principalPoint)},
          {"distortion", {lens.distortion.k1, lens.distortion.k2}}};
}

Json partOf(const Lens& lens) { return {lens.aperture, lens.focus}; }

Json partOf(const Optics& optics) {
  Json part = {{"distortion", {optics.distortion.k1, optics.distortion.k2}}};
  if (optics.principalPoint) part["principalPoint"] = numbersIn(*optics.principalPoint);
  return part;
}

Json partOf(const Lamp& lamp) {
  Json part = {{"name", lamp.name}, {"position", numbersIn(lamp.position)}};
  if (const auto& light = lamp.punctual)
    part["punctual"] = {int(light->kind),
                        numbersIn(light->intensity),
                        numbersIn(light->direction),
                        light->range,
                        light->cosInner,
                        light->cosOuter};
  if (const auto& disc = lamp.disc)
    part["disc"] = {numbersIn(disc->direction), disc->radius, numbersIn(disc->radiance)};
  if (const auto& sun = lamp.sun)
    part["sun"] = {numbersIn(sun->sun.direction), numbersIn(sun->sun.irradiance), sun->sun.angle,
                   sun->isVisible, sun->name};
  if (const auto& ambient = lamp.ambient)
    part["ambient"] = {numbersIn(ambient->radiance), ambient->isVisible, ambient->name};
  return part;
}

Json partOf(const SourceEntry& source) {
  Json part = {{"name", source.name}, {"illum", source.isIllum}, {"corners", Json::array()}};
  for (const glm::dvec2& corner : source.corners) part["corners"].push_back(numbersIn(corner));
  return part;
}

Json partOf(const SurroundingsEntry& around) {
  return {{"shape", int(around.shape.shape)},    {"min", numbersIn(around.min)},
          {"max", numbersIn(around.max)},        {"center", numbersIn(around.center)},
          {"radius", around.shape.radius},       {"model", fileName(around.shape.model)},
          {"capture", numbersIn(around.capture)}};
}

Json partOf(const CompositeEntry& entry) {
  Json part = {{"ground", numbersIn(entry.groundReflectance)},
               {"range", numbersIn(entry.groundReflectanceRange)},
               {"nodes", Json::array()}};
  for (const NamedSetting& node : entry.localScene) part["nodes"].push_back(node.name);
  return part;
}

template <class Part>
Json partOf(const std::vector<Part>& parts) {
  Json list = Json::array();
  for (const Part& part : parts) list.push_back(partOf(part));
  return list;
}

uint64_t pixelHash(const Image& image) {
  uint64_t sum = hash(uint64_t(image.width), uint64_t(image.height), uint64_t(image.channels));
  for (const float texel : image.texels) sum = hash(sum, uint64_t(std::bit_cast<uint32_t>(texel)));
  return sum;
}

// Loading may decide the reflectance.
Json partOf(const CompositeDescription& c) {
  return {{"reflectance", c.choosesReflectance ? -1 : int(c.reflectance)},
          {"iterations", c.iterations},
          {"mode", int(c.mode)},
          {"layers", c.layers},
          {"plate", pixelHash(c.plate)},
          {"ground", {int(c.ground), c.groundHeight}},
          {"gloss", {c.specular.value_or(-1), c.roughness.value_or(-1)}}};
}

void addHash(const char* name, const Json& part, Json& d) {
  d[name] = fmt::format("{:016x}", checksum(jsonText(part)));
}
template <class Part>
void addPart(const char* name, const std::optional<Part>& part, Json& d) {
  if (part) addHash(name, partOf(*part), d);
}
template <class Part>
void addPart(const char* name, const std::vector<Part>& parts, Json& d) {
  if (!parts.empty()) addHash(name, partOf(parts), d);
}
// Null where there is no limit.
Json limitOf(int depth) { return depth < INT_MAX ? Json(depth) : Json(); }
// The shortest number that reads as this float.
Json numberOf(float x) { return std::stod(fmt::format("{}", x)); }
Json numberOf(const std::optional<float>& x) { return x ? numberOf(*x) : Json(); }
Json numberOf(const std::optional<double>& x) { return x ? Json(*x) : Json(); }
// The shortest number near `guess` of which `map` makes exactly `image`, as it has of what a user
// gave; `guess` where rounding leaves none.
template <class Map>
Json inverseOf(const Map& map, double image, double guess) {
  for (const double number : {std::stod(fmt::format("{:.15g}", guess)), guess,
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
            {"strategy", resolveStrategy(light.strategy.name)},
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
            {"orbit", camera.orbit != 0 ? Json(camera.orbit) : Json()}});
  if (const auto& shutter = camera.shutter)
    d.update({{"shutter", shutter->frames},
              {"shutter-steps", shutter->steps},
              {"fps", shutter->fps},
              {"orbit-step", shutter->turn != 0 ? orbitStep(*shutter) : Json()}});
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
  std::vector<std::string> nodes;
  for (const NamedSetting& node : composite->entry.localScene) nodes.push_back(node.name);
  d["shadow-catcher"] = fmt::format("{}", fmt::join(nodes, ","));
}

void addParts(const RenderDescription& description, Json& d) {
  addPart("models", description.models, d);
  if (description.scene) d["scene-in-memory"] = fmt::format("{:016x}", hashOf(*description.scene));
  if (const auto& map = description.probe.map)
    d["probe-in-memory"] = fmt::format("{:016x}", pixelHash(*map));
  addPart("scene-camera", description.camera.placed, d);
  addPart("lens", description.camera.lens, d);
  addPart("optics", description.camera.optics, d);
  addPart("scene-lights", description.lamps, d);
  addPart("sources", description.sources, d);
  addPart("surroundings", description.surroundings, d);
  if (!description.composite) return;
  addHash("local-scene", partOf(description.composite->entry), d);
  addPart("composite", description.composite, d);
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
  addModels(description, all);
  addComposite(description, all);
  addParts(description, all);
  Json d;
  for (const auto& [name, value] : all.items())
    if (!value.is_null() && value != Json(false)) d[name] = value;
  return d;
}

}  // namespace chromeball
