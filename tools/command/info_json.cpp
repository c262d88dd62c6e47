// SPDX-License-Identifier: Apache-2.0
#include "info_json.h"

#include <filesystem>

#include "session/memory_estimate.h"

namespace chromeball {
namespace {

JsonValue toJson(const Bounds& bounds) {
  if (bounds.empty()) return nullptr;
  return {{"min", vectorToJson(bounds.min)}, {"max", vectorToJson(bounds.max)}};
}

JsonValue toJson(const Camera& c) {
  JsonValue json = {{"name", c.name},
                    {"node", c.node},
                    {"type", c.orthographic ? "orthographic" : "perspective"},
                    {"position", vectorToJson(c.position)},
                    {"forward", vectorToJson(-c.back)},
                    {"aspect", c.aspect > 0 ? JsonValue(c.aspect) : JsonValue()}};
  if (c.orthographic)
    json["height"] = 2 * c.halfHeight;
  else
    json["fov"] = glm::degrees(c.fov);
  return json;
}

JsonValue toJson(const PunctualLight& light) {
  return {{"name", light.name},
          {"type", lightKind(light)},
          {"intensity", vectorToJson(light.intensity)},
          {"position", vectorToJson(light.position)},
          {"direction", vectorToJson(light.direction)}};
}

template <class List, class ToJson>
JsonValue listOf(const List& list, const ToJson& toJson) {
  JsonValue array = JsonValue::array();
  for (const auto& element : list) array.push_back(toJson(element));
  return array;
}

}  // namespace

uint64_t byteCountOf(const std::vector<std::string>& files) {
  uint64_t bytes = 0;
  for (const std::string& file : files) bytes += std::filesystem::file_size(file);
  return bytes;
}

const char* lightKind(const PunctualLight& light) {
  constexpr const char* kKinds[] = {"directional", "point", "spot"};
  return kKinds[size_t(light.kind)];
}

JsonValue modelToJson(const ModelInfo& info, const std::string& file) {
  using Info = ModelInfo;
  const Scene& scene = info.scene;
  JsonValue json = {
      {"file", file},
      {"files", scene.files},
      {"bytes", byteCountOf(scene.files)},
      {"generator", info.generator},
      {"bounds", toJson(bounds(scene))},
      {"triangles", scene.triangleCount()},
      {"meshes", scene.meshes.size()},
      {"instances", scene.instances.size()},
      {"memory", {{"geometry", geometryBytes(scene)}, {"textures", scene.texelByteCount()}}}};
  json["nodes"] = listOf(info.nodes, [](const Info::Node& node) {
    return JsonValue{{"name", node.name},
                     {"parent", node.parent},
                     {"triangles", node.triangles},
                     {"bounds", toJson(node.bounds)}};
  });
  json["materials"] = listOf(info.materials, [](const Info::Material& m) {
    return JsonValue{{"name", m.name},
                     {"extensions", m.extensions},
                     {"alpha_mode", m.alphaMode},
                     {"double_sided", m.isDoubleSided},
                     {"emits", m.emits},
                     {"textures", m.textures}};
  });
  json["textures"] = listOf(info.textures, [](const Info::Texture& t) {
    return JsonValue{
        {"image", t.image}, {"width", t.width}, {"height", t.height}, {"bytes", t.bytes}};
  });
  json["cameras"] = listOf(scene.cameras, [](const Camera& c) { return toJson(c); });
  json["lamps"] = listOf(scene.lights, [](const PunctualLight& l) { return toJson(l); });
  json["animations"] = listOf(info.animations, [](const Info::Animation& a) {
    return JsonValue{{"name", a.name}, {"seconds", a.seconds}, {"channels", a.channels}};
  });
  json["variants"] = info.variants;
  json["has_own_probe"] = scene.environment.has_value();
  json["extensions"] = listOf(info.extensions, [](const Info::Extension& e) {
    return JsonValue{{"name", e.name}, {"required", e.isRequired}, {"supported", e.isSupported}};
  });
  json["warnings"] = info.warnings;
  return json;
}

}  // namespace chromeball
