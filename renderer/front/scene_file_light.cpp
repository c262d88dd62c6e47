// SPDX-License-Identifier: Apache-2.0
#include "front/scene_file_sections.h"

#include <fmt/format.h>

#include <algorithm>

#include "front/arguments.h"
#include "front/polygon_file.h"
#include "lighting/export/light_file.h"
#include "probe/synth.h"

namespace chromeball {
namespace {

struct LampType {
  std::string_view name;
  std::vector<std::string_view> keys;
};
const std::vector<LampType> kTypes = {
    {"sun", {"type", "name", "direction", "angle", "radiance", "irradiance", "visible"}},
    {"point", {"type", "name", "position", "intensity", "power", "range"}},
    {"spot",
     {"type", "name", "position", "direction", "intensity", "power", "range", "inner_angle",
      "outer_angle"}},
    {"disc", {"type", "name", "position", "direction", "radiance", "power", "radius"}},
    {"list", {"type", "name", "file", "rotation", "visible"}},
};

const LampType& typeOf(const Section& light) {
  const Entry type = light["type"];
  const std::string name = type ? type.choice() : light["file"] ? "list" : "sun";
  return *std::ranges::find(kTypes, name, &LampType::name);
}

vec3 readDirection(const Section& light) {
  const Entry entry = light.required("direction");
  const glm::dvec3 direction(entry.vector());
  if (!(glm::length(direction) > 0)) failAt(entry.location(), "`direction` must not be 0, 0, 0");
  return vec3(glm::normalize(direction));
}

// The value of `key`, or `ofOneWatt` times `power`.
Rgb readStrength(const Section& light, std::string_view key, float ofOneWatt) {
  const Entry own = light[key], power = light["power"];
  if (own && power) failAt(power.location(), "[[light]] has `{}`; it cannot have `power` too", key);
  if (!own && !power) failAt(light.location(), "[[light]] has neither `{}` nor `power`", key);
  return own ? own.oneOrThree() : power.oneOrThree() * ofOneWatt;
}

PunctualLight readPunctual(const Section& light, bool isSpot) {
  PunctualLight lamp;
  lamp.kind = isSpot ? PunctualLight::Kind::Spot : PunctualLight::Kind::Point;
  if (isSpot) {
    lamp.direction = readDirection(light);
    const Entry outerEntry = light["outer_angle"], innerEntry = light["inner_angle"];
    const double outer = outerEntry ? outerEntry.number() : 45;
    const double inner = innerEntry ? innerEntry.number({.min = 0, .max = outer}) : 0;
    lamp.outerCone = coneOf(glm::radians(outer));
    lamp.innerCone = coneOf(glm::radians(inner));
  }
  if (const Entry e = light["range"]) lamp.range = float(e.number());
  lamp.intensity = readStrength(light, "intensity", lamp.intensityOfOneWatt());
  return lamp;
}

DiscLamp readDisc(const Section& light) {
  DiscLamp disc;
  disc.direction = readDirection(light);
  disc.radius = float(light.required("radius").number());
  // A Lambertian emitter of area A and radiance L has the radiant flux pi A L.
  disc.radiance = readStrength(light, "radiance", 1 / (kPi * kPi * disc.radius * disc.radius));
  return disc;
}

SunLamp readSun(const Section& light) {
  const Entry radiance = light["radiance"], irradiance = light["irradiance"];
  if (!radiance == !irradiance)
    failAt((radiance ? irradiance.location() : light.location()),
           "[[light]] of type sun needs either `radiance` or `irradiance`");
  SunLamp lamp{{glm::dvec3(readDirection(light)), {}, kSunDiameter}, true};
  if (const Entry e = light["angle"]) lamp.sun.angle = e.number();
  if (const Entry e = light["visible"]) lamp.isVisible = e.flag();
  lamp.sun.direction = glm::normalize(lamp.sun.direction);
  lamp.sun.irradiance = glm::dvec3(1);
  const glm::dvec3 ofOne = lamp.sun.radiance();
  lamp.sun.irradiance =
      irradiance ? glm::dvec3(irradiance.oneOrThree()) : glm::dvec3(radiance.oneOrThree()) / ofOne;
  if (!isFinite(Rgb(lamp.sun.radiance())))
    failAt((irradiance ? irradiance : radiance).location(),
           "the sun's radiance, {:.3g} of its irradiance for an angle of {:.3g} degrees, exceeds "
           "the largest float, 3.4e38",
           ofOne.x, lamp.sun.angle);
  return lamp;
}

Rotation readProbeRotation(const Entry& entry) {
  if (!entry) return {};
  Entry rotation = entry;
  rotation.setting = findSetting("probe", "rotation");
  return parseRotation(rotation.numbers(), entry.location());
}

// Lights with an angle become suns; lights without one, directional lamps.
std::vector<Lamp> readList(const Section& light, const std::string& name,
                           std::vector<std::string>& files) {
  const Rotation rotation = readProbeRotation(light["rotation"]);
  const std::string path = existingFile(light.required("file"));
  const Entry visible = light["visible"];
  const bool isVisible = !visible || visible.flag();
  const LightList list = readLights(path);
  files.push_back(path);
  std::vector<Lamp> lamps;
  for (const DirectionalLight& from : turned(list.lights, rotation)) {
    Lamp& lamp = lamps.emplace_back();
    lamp.name = fmt::format("{}_{}", name, lamps.size() - 1);
    if (from.angle > 0)
      lamp.sun = {{glm::dvec3(from.direction), glm::dvec3(from.irradiance), double(from.angle)},
                  isVisible,
                  lamp.name};
    else
      lamp.punctual = {.kind = PunctualLight::Kind::Directional,
                       .intensity = from.irradiance,
                       .direction = -from.direction,
                       .name = lamp.name};
  }
  if (list.ambient) {
    Lamp& lamp = lamps.emplace_back();
    lamp.name = name + "_ambient";
    lamp.ambient = {*list.ambient, isVisible, lamp.name};
  }
  return lamps;
}

Lamp readLamp(const Section& light, const LampType& type, const std::string& name) {
  Lamp lamp;
  lamp.name = name;
  if (type.name == "sun") {
    (lamp.sun = readSun(light))->name = name;
    return lamp;
  }
  lamp.position = light.required("position").point();
  if (type.name == "disc") {
    lamp.disc = readDisc(light);
    return lamp;
  }
  lamp.punctual = readPunctual(light, type.name == "spot");
  lamp.punctual->name = name;
  return lamp;
}

}  // namespace

std::vector<Lamp> readLamps(const Entry& entry, std::vector<std::string>& files) {
  if (!entry.node->is_table()) entry.mustBe("a table, [[light]]");
  const Section light(entry.file, "light", *entry.node->as_table());
  const LampType& type = typeOf(light);
  light.allowOnly(type.keys, fmt::format("a {} light", type.name));
  const Entry name = light["name"];
  if (type.name == "list") return readList(light, name ? name.text() : "light", files);
  return {readLamp(light, type, name ? name.text() : type.name == "sun" ? "sun" : "light")};
}

namespace {

PolygonCorners readCorners(const Entry& entry) {
  if (!entry.isArray()) entry.mustBe(entry.setting->form);
  PolygonCorners corners;
  for (size_t i = 0; i < entry.node->as_array()->size(); ++i) {
    const Entry corner = entry.element(i);
    if (!corner.isArrayOf(2)) corner.mustBe("two numbers, [u, v]");
    corners.push_back({corner.element(0).number(), corner.element(1).number()});
  }
  return corners;
}

}  // namespace

void readSources(const Entry& entry, SceneFile& scene) {
  if (!entry.node->is_table()) entry.mustBe("a table, [[source]]");
  const Section source(entry.file, "source", *entry.node->as_table());
  const Entry polygon = source["probe_polygon"], file = source["file"];
  if (!polygon == !file)
    failAt(source.location(), "[[source]] needs either `probe_polygon` or `file`");
  SourceEntry common;
  common.name = source["name"] ? source["name"].text() : "source";
  if (const Entry illum = source["illum"]) common.isIllum = illum.flag();
  if (const Entry offset = source["offset"]) offset.number();
  const auto add = [&](const PolygonCorners& corners, const std::string& location) {
    scene.origins.set(elementName("sources", scene.sources.size()), location);
    SourceEntry& added = scene.sources.emplace_back(common);
    added.corners = corners;
    return &added;
  };
  if (polygon) {
    add(readCorners(polygon), source.location());
    return;
  }
  const std::string path = existingFile(file);
  scene.lightLists.push_back(path);
  size_t i = 0;
  for (const PolygonCorners& corners : readPolygons(path)) {
    add(corners, fmt::format("{}: {}", path, elementName("polygons", i)))->name +=
        fmt::format("_{}", i);
    ++i;
  }
}

}  // namespace chromeball
