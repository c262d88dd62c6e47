// SPDX-License-Identifier: Apache-2.0
#include "job/job_changes.h"

#include <fmt/format.h>

#include <bit>
#include <climits>
#include <cmath>
#include <initializer_list>

#include "base/hash.h"
#include "base/json.h"
#include "base/json_text.h"
#include "job/check_job.h"

namespace chromeball {
namespace {

using Json = nlohmann::ordered_json;

template <class Vector>
Json numbersIn(const Vector& v) {
  Json numbers = Json::array();
  for (int i = 0; i < int(Vector::length()); ++i) numbers.push_back(v[i]);
  return numbers;
}

Json partOf(const ModelEntry& model) {
  const GltfChoice& choice = model.choice;
  Json part = {{"file", model.file},
               {"linear", Json::array()},
               {"translation", numbersIn(model.placement.translation)},
               {"external", int(choice.external)},
               {"units", int(choice.lightUnits)},
               {"environment", choice.environment}};
  for (int column = 0; column < 3; ++column)
    part["linear"].push_back(numbersIn(model.placement.linear[column]));
  if (choice.animation) part["animation"] = {choice.animation->name, choice.animation->seconds};
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
          {"radius", around.shape.radius},       {"model", around.shape.model},
          {"capture", numbersIn(around.capture)}};
}

Json partOf(const CompositeEntry& entry) {
  Json part = {{"ground", numbersIn(entry.groundReflectance)},
               {"range", numbersIn(entry.groundReflectanceRange)},
               {"nodes", Json::array()}};
  for (const NamedSetting& node : entry.localScene) part["nodes"].push_back(node.name);
  return part;
}

uint64_t pixelHash(const Image& image) {
  uint64_t sum = hash(uint64_t(image.width), uint64_t(image.height), uint64_t(image.channels));
  for (const float texel : image.texels) sum = hash(sum, uint64_t(std::bit_cast<uint32_t>(texel)));
  return sum;
}

// loadScene() may decide the reflectance.
Json partOf(const CompositePlan& plan) {
  return {{"plate", pixelHash(plan.plate)},
          {"mode", int(plan.mode)},
          {"reflectance", plan.choosesReflectance ? -1 : int(plan.reflectance)},
          {"iterations", plan.iterations},
          {"passes", int(plan.passes)},
          {"layers", plan.layers}};
}

template <class Part>
Json partOf(const std::optional<Part>& part) {
  return part ? partOf(*part) : Json();
}

template <class Part>
Json partOf(const std::vector<Part>& parts) {
  Json list = Json::array();
  for (const Part& part : parts) list.push_back(partOf(part));
  return list;
}

Json describeParts(const RenderJob& job) {
  const SceneFile& file = job.file;
  return {{"models", partOf(file.models)},
          {"scene-camera", partOf(file.camera)},
          {"lens", partOf(file.lens)},
          {"optics", partOf(file.optics)},
          {"lights", partOf(file.lamps)},
          {"sources", partOf(file.sources)},
          {"surroundings", partOf(file.surroundings)},
          {"local-scene", partOf(file.composite)},
          {"composite", partOf(job.composite)}};
}

// Null where there is no limit.
Json limitOf(int depth) { return depth < INT_MAX ? Json(depth) : Json(); }
template <class Number>
Json numberOf(const std::optional<Number>& number) {
  return number ? Json(double(*number)) : Json();
}
Json nameAt(int index, std::initializer_list<const char*> names) { return names.begin()[index]; }

std::vector<std::string> plainLayers(const RenderSettings& settings) {
  std::vector<std::string> names;
  for (const Aov aov : settings.aovs) names.emplace_back(aovInfo(aov).name);
  if (settings.lightGroups) names.emplace_back(kLightGroups);
  if (settings.shadowMattes) names.emplace_back(kShadowMattes);
  return names;
}

Json cropText(const RenderSettings& settings) {
  const auto& c = settings.crop;
  return c ? Json(fmt::format("{},{},{},{}", c->x, c->y, c->width, c->height)) : Json();
}

Json shardText(const Shard& shard) {
  if (shard.samplesOfAll == 0) return {};
  return fmt::format("{}/{}", shard.index + 1, shard.count);
}

// The values that settings name, under the names of the description; null or false: not there.
Json describeValues(const RenderJob& job) {
  const RenderSettings& s = job.settings;
  Json d = {
      {"noise-limit", s.noiseLimit ? Json(100 * *s.noiseLimit) : Json()},
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
      {"ao-distance", std::isfinite(s.occlusion.distance) ? Json(s.occlusion.distance) : Json()},
      {"bent", nameAt(s.occlusion.uniformBent, {"cosine", "uniform"})},
      {"irradiance-cache", numberOf(s.cacheError)},
      {"mis", nameAt(int(s.mis), {"off", "balance", "power"})},
      {"seed", s.seed},
      {"transparent", s.hideProbe},
      {"clamp", numberOf(s.clamp)},
      {"regularize", s.regularize},
      {"denoise", s.denoise},
      {"single-sided", nameAt(int(job.singleSided), {"camera", "light", "off"})},
      {"glass-shadows", nameAt(job.straightGlassShadows, {"refract", "straight"})}};
  if (!job.composite) d["aov"] = fmt::format("{}", fmt::join(plainLayers(s), ","));
  if (const auto& shutter = job.shutter) {
    const double frames = shutter->seconds * job.file.settings.get<double>("fps");
    d["shutter"] = frames;
    d["shutter-steps"] = shutter->steps;
    d["orbit-step"] = shutter->turn / frames;
  }
  return d;
}

}  // namespace

std::string partsOf(const RenderJob& job) { return jsonText(describeParts(job)); }

std::vector<std::string> layerNames(const RenderJob& job) {
  if (job.composite) return job.composite->layers;
  const std::vector<std::string> names = plainLayers(job.settings);
  if (names != plainLayers(plannedSettings(job.file).settings)) return names;
  return job.file.settings.get<std::vector<std::string>>("output.aovs");
}

void describeChanges(const RenderJob& job, Json& d) {
  RenderJob plan = plannedSettings(job.file);
  if (job.composite) plan.composite.emplace();
  const Json planned = describeValues(plan), values = describeValues(job);
  Json names = planned;
  names.update(values);
  for (const auto& [name, ignored] : names.items()) {
    const Json value = values.value(name, Json());
    if (value == planned.value(name, Json())) continue;
    if (value.is_null() || value == Json(false))
      d.erase(name);
    else
      d[name] = value;
  }
  const Json before = readJson(job.plannedParts), now = readJson(partsOf(job));
  for (const auto& [name, part] : now.items())
    if (part != before.at(name)) d[name] = part;
}

}  // namespace chromeball
