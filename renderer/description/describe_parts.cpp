// SPDX-License-Identifier: Apache-2.0
#include "description/describe.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/hash.h"
#include "base/json.h"

namespace chromeball {
namespace {

using PartJson = nlohmann::ordered_json;

// Folders may differ where the contents are the same.
std::string fileName(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

template <class Vector>
PartJson numbersIn(const Vector& v) {
  PartJson numbers = PartJson::array();
  for (int i = 0; i < int(Vector::length()); ++i) numbers.push_back(v[i]);
  return numbers;
}

PartJson partOf(const ModelEntry& model) {
  const GltfChoice& choice = model.choice;
  PartJson part = {{"file", fileName(model.file)},
                   {"linear", PartJson::array()},
                   {"translation", numbersIn(model.placement.translation)},
                   {"external", int(choice.external)},
                   {"units", int(choice.lightUnits)},
                   {"environment", choice.environment}};
  for (int column = 0; column < 3; ++column)
    part["linear"].push_back(numbersIn(model.placement.linear[column]));
  if (choice.variant) part["variant"] = choice.variant->name;
  if (const glm::dvec3& rest = model.translationRest; rest != glm::dvec3(0))
    part["rest"] = numbersIn(rest);
  return part;
}

PartJson partOf(const CameraEntry& entry) {
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

PartJson partOf(const Lens& lens) { return {lens.aperture, lens.focus}; }

PartJson partOf(const Optics& optics) {
  PartJson part = {{"distortion", {optics.distortion.k1, optics.distortion.k2}}};
  if (optics.principalPoint) part["principalPoint"] = numbersIn(*optics.principalPoint);
  return part;
}

PartJson partOf(const Lamp& lamp) {
  PartJson part = {{"name", lamp.name}, {"position", numbersIn(lamp.position)}};
  if (const auto& light = lamp.punctual)
    part["punctual"] = {int(light->kind),
                        numbersIn(light->intensity),
                        numbersIn(light->direction),
                        light->range,
                        light->innerCone,
                        light->outerCone};
  if (const auto& disc = lamp.disc)
    part["disc"] = {numbersIn(disc->direction), disc->radius, numbersIn(disc->radiance)};
  if (const auto& sun = lamp.sun)
    part["sun"] = {numbersIn(sun->sun.direction), numbersIn(sun->sun.irradiance), sun->sun.angle,
                   sun->isVisible, sun->name};
  if (const auto& ambient = lamp.ambient)
    part["ambient"] = {numbersIn(ambient->radiance), ambient->isVisible, ambient->name};
  return part;
}

PartJson partOf(const SourceEntry& source) {
  PartJson part = {
      {"name", source.name}, {"illum", source.isIllum}, {"corners", PartJson::array()}};
  for (const glm::dvec2& corner : source.corners) part["corners"].push_back(numbersIn(corner));
  return part;
}

PartJson partOf(const SurroundingsEntry& around) {
  return {{"shape", int(around.shape.shape)},    {"min", numbersIn(around.min)},
          {"max", numbersIn(around.max)},        {"center", numbersIn(around.center)},
          {"radius", around.shape.radius},       {"model", fileName(around.shape.model)},
          {"capture", numbersIn(around.capture)}};
}

PartJson partOf(const CompositeEntry& entry) {
  PartJson part = {
      {"ground", entry.groundReflectance ? numbersIn(*entry.groundReflectance) : "auto"},
      {"range", numbersIn(entry.groundReflectanceRange)},
      {"nodes", PartJson::array()}};
  if (entry.groundInPlate) part["groundInPlate"] = numbersIn(*entry.groundInPlate);
  for (const std::string& node : entry.localScene) part["nodes"].push_back(node);
  return part;
}

template <class Part>
PartJson partOf(const std::vector<Part>& parts) {
  PartJson list = PartJson::array();
  for (const Part& part : parts) list.push_back(partOf(part));
  return list;
}

uint64_t pixelHash(const Image& image) {
  const auto* bytes = reinterpret_cast<const char*>(image.texels.data());
  return hash(uint64_t(image.width), uint64_t(image.height), uint64_t(image.channels),
              checksum({bytes, image.texels.size() * sizeof(float)}));
}

// Loading may decide the reflectance.
PartJson partOf(const CompositeDescription& c) {
  return {{"reflectance", c.choosesReflectance ? -1 : int(c.reflectance)},
          {"iterations", c.iterations},
          {"mode", int(c.mode)},
          {"layers", c.layers},
          {"plate", pixelHash(c.plate)},
          {"ground", {int(c.ground), c.groundHeight}},
          {"gloss", {c.specular.value_or(-1), c.roughness.value_or(-1)}}};
}

void addHash(const char* name, const PartJson& part, PartJson& d) {
  d[name] = fmt::format("{:016x}", checksum(jsonText(part)));
}
template <class Part>
void addPart(const char* name, const std::optional<Part>& part, PartJson& d) {
  if (part) addHash(name, partOf(*part), d);
}
template <class Part>
void addPart(const char* name, const std::vector<Part>& parts, PartJson& d) {
  if (!parts.empty()) addHash(name, partOf(parts), d);
}

}  // namespace

void addParts(const RenderDescription& description, PartJson& d) {
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

}  // namespace chromeball
