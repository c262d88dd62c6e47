// SPDX-License-Identifier: Apache-2.0
#include "job/scene_file_light.h"

namespace chromeball {
namespace {

// The keys beside `type`, `name` and `position`.
struct LampType {
  std::string_view name;
  std::vector<std::string_view> keys;
};
const std::vector<LampType> kTypes = {
    {"point", {"intensity", "power", "range"}},
    {"spot", {"direction", "intensity", "power", "range", "inner_angle", "outer_angle"}},
    {"disc", {"direction", "radiance", "power", "radius"}},
};

std::vector<std::string_view> typeNames() {
  std::vector<std::string_view> names;
  for (const LampType& type : kTypes) names.push_back(type.name);
  return names;
}

std::string listed(const std::vector<std::string_view>& keys) {
  std::string list;
  for (const std::string_view key : keys) (list += list.empty() ? "" : ", ") += key;
  return list;
}

const LampType& typeOf(const Section& light) {
  const Entry entry = light["type"];
  if (!entry) failAt(light.location(), "[light] has no `type`: \"point\", \"spot\" or \"disc\"");
  const std::string name = entry.text();
  for (const LampType& type : kTypes)
    if (type.name == name) return type;
  failAt(entry.location(), "`type` {} is not known; {}", name, didYouMean(name, typeNames()));
}

// A number for grey, or three.
Rgb readColor(const Entry& entry) {
  const Rgb color = entry.node->is_array() ? entry.vector() : Rgb(entry.number());
  if (!glm::all(glm::greaterThanEqual(color, Rgb(0)))) entry.mustBe("0 or above");
  return color;
}

vec3 readDirection(const Section& light) {
  const Entry entry = light["direction"];
  if (!entry) failAt(light.location(), "[light] has no `direction`, where it shines");
  const glm::dvec3 direction(entry.vector());
  if (!(glm::length(direction) > 0)) entry.mustBe("other than 0, 0, 0");
  return vec3(glm::normalize(direction));
}

double readAngle(const Entry& entry, double fallback, double minimum, double maximum) {
  if (!entry) return fallback;
  return entry.number(
      fmt::format("degrees from {:g} to {:g}, between axis and edge", minimum, maximum),
      [&](double x) { return x >= minimum && x <= maximum; });
}

// `key` as it is given, or the share `ofOneWatt` of `power`.
Rgb readStrength(const Section& light, std::string_view key, float ofOneWatt) {
  const Entry own = light[key], power = light["power"];
  if (own && power) failAt(power.location(), "[light] has `{}`; it cannot have `power` too", key);
  if (!own && !power) failAt(light.location(), "[light] has neither `{}` nor `power`", key);
  return own ? readColor(own) : readColor(power) * ofOneWatt;
}

PunctualLight readPunctual(const Section& light, bool isSpot) {
  PunctualLight lamp;
  lamp.kind = isSpot ? PunctualLight::Kind::Spot : PunctualLight::Kind::Point;
  if (isSpot) {
    lamp.direction = readDirection(light);
    const double outer = readAngle(light["outer_angle"], 45, 0.01, 90);
    const double inner = readAngle(light["inner_angle"], 0, 0, outer);
    lamp.cosOuter = float(std::cos(outer * kPiD / 180));
    lamp.cosInner = float(std::cos(inner * kPiD / 180));
  }
  if (const Entry e = light["range"]) lamp.range = float(e.positive());
  lamp.intensity = readStrength(light, "intensity", lamp.intensityOfOneWatt());
  return lamp;
}

DiscLamp readDisc(const Section& light) {
  if (!light["radius"]) failAt(light.location(), "[light] has no `radius`");
  DiscLamp disc;
  disc.direction = readDirection(light);
  disc.radius = float(light["radius"].positive());
  // A Lambertian emitter of area A sends out pi A times its radiance.
  disc.radiance = readStrength(light, "radiance", 1 / (kPi * kPi * disc.radius * disc.radius));
  return disc;
}

}  // namespace

Lamp readLamp(const Entry& entry) {
  if (!entry.node->is_table()) entry.mustBe("a table, [[light]]");
  std::vector<std::string_view> keys = {"type", "name", "position"};
  for (const LampType& type : kTypes) keys.insert(keys.end(), type.keys.begin(), type.keys.end());
  const toml::table& table = *entry.node->as_table();
  const Section light(entry.file, "light", table, keys);
  const LampType& type = typeOf(light);
  for (const std::string_view key : keys) {
    const bool isCommon = key == "type" || key == "name" || key == "position";
    if (const Entry e = light[key];
        e && !isCommon && std::find(type.keys.begin(), type.keys.end(), key) == type.keys.end())
      failAt(e.location(), "a {} light has no `{}`; it has {}", type.name, key, listed(type.keys));
  }
  if (!light["position"]) failAt(light.location(), "[light] has no `position`");
  const vec3 position = light["position"].vector();
  Lamp lamp{light["name"] ? light["name"].text() : "light", {}, {}};
  if (type.name == "disc")
    (lamp.disc = readDisc(light))->position = position;
  else
    (lamp.punctual = readPunctual(light, type.name == "spot"))->position = position;
  return lamp;
}

}  // namespace chromeball
