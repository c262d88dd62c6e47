// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/lights.h"

#include <fmt/format.h>

#include "scene/gltf/extension_members.h"

namespace chromeball {
namespace {

using Kind = PunctualLight::Kind;
using tinygltf::Value;

constexpr const char* kLightsExtension = "KHR_lights_punctual";

double number(const GltfFile& file, const Value& object, const char* key, double fallback,
              double low, double high, const std::string& where) {
  const Value& v = memberOf(object, key);
  const double x = v.IsNumber() ? v.GetNumberAsDouble() : fallback;
  if (!(x >= low && x <= high))
    file.fail("{}.{}: {} is not in the range {} to {}", where, key, x, low, high);
  return x;
}

Rgb color(const GltfFile& file, const Value& light, const std::string& where) {
  const Value& v = memberOf(light, "color");
  Rgb c(1);
  if (!v.IsArray()) return c;
  for (int i = 0; i < 3; ++i) {
    const Value& x = elementOf(v, size_t(i));  // null if the array is too short
    c[i] = x.IsNumber() ? float(x.GetNumberAsDouble()) : NAN;
    if (!(c[i] >= 0 && std::isfinite(c[i])))
      file.fail("{}.color: must be three numbers >= 0", where);
  }
  return c;
}

PunctualLight readLight(const GltfFile& file, const Value& source, LightUnits units,
                        const std::string& where) {
  const std::string type =
      memberOf(source, "type").IsString() ? memberOf(source, "type").Get<std::string>() : "";
  PunctualLight light;
  light.kind = type == "directional" ? Kind::Directional
               : type == "spot"      ? Kind::Spot
                                     : Kind::Point;
  if (light.kind == Kind::Point && type != "point")
    file.fail("{}.type: \"{}\" is not directional, point or spot", where, type);
  light.intensity =
      color(file, source, where) *
      (float(number(file, source, "intensity", 1, 0, 1e30, where)) / lumensPerWatt(units));
  if (memberOf(source, "range").IsNumber())
    light.range = float(number(file, source, "range", 0, 1e-20, 1e30, where));
  if (light.kind != Kind::Spot) return light;
  const Value& spot = memberOf(source, "spot");
  const std::string at = where + ".spot";
  const double outer = number(file, spot, "outerConeAngle", kPiD / 4, 0, kPiD / 2 + 1e-6, at);
  light.cosOuter = float(std::cos(outer));
  light.cosInner = float(std::cos(number(file, spot, "innerConeAngle", 0, 0, outer, at)));
  return light;
}

}  // namespace

std::vector<PunctualLight> readLights(GltfFile& file, const NodeTree& tree, LightUnits units) {
  std::vector<PunctualLight> lights;
  for (int index : tree.visible) {
    const auto& extensions = file.model.nodes[size_t(index)].extensions;
    const auto found = extensions.find(kLightsExtension);
    if (found == extensions.end() || !memberOf(found->second, "light").IsInt()) continue;
    const int id = memberOf(found->second, "light").GetNumberAsInt();
    const auto root = file.model.extensions.find(kLightsExtension);
    const Value& sources =
        root == file.model.extensions.end() ? found->second : memberOf(root->second, "lights");
    if (id < 0 || !sources.IsArray() || size_t(id) >= sources.ArrayLen())
      file.fail("nodes[{}].{}: lights[{}] does not exist", index, kLightsExtension, id);
    PunctualLight light =
        readLight(file, elementOf(sources, size_t(id)), units, fmt::format("lights[{}]", id));

    const glm::dmat4& toWorld = tree.toWorld[size_t(index)];
    light.position = vec3(toWorld[3]);
    const glm::dvec3 backwards(toWorld[2]);
    const double length = glm::length(backwards);
    if (!isFinite(light.position) || !(length > 0) || !std::isfinite(length)) {
      file.warnOnce(
          "ignored: lights of nodes whose transform leaves them no direction or position");
      continue;
    }
    light.direction = vec3(-backwards / length);
    light.name = tree.names[size_t(index)];
    light.node = index;
    if (!isBlack(light.intensity)) lights.push_back(light);
  }
  return lights;
}

}  // namespace chromeball
