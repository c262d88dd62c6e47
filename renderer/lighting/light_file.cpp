#include "lighting/light_file.h"

#include <map>
#include <nlohmann/json.hpp>

#include "image/file.h"
#include "math/error.h"

namespace chromeball {
namespace {

using glm::dvec3;

// With floats for numbers, so that each is written with the digits a float has, and no more.
using Json = nlohmann::basic_json<nlohmann::ordered_map, std::vector, std::string, bool, int64_t,
                                  uint64_t, float>;

std::string text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json toJson(const vec3& v) { return {v.x, v.y, v.z}; }

// One line a light.
std::string formatJson(const LightRig& rig) {
  std::string result =
      fmt::format("{{\n  \"probe\": {},\n  \"method\": {},\n", text(rig.probe), text(rig.method));
  if (rig.ambient) result += fmt::format("  \"ambient\": {},\n", text(toJson(*rig.ambient)));
  result += "  \"lights\": [";
  const char* separator = "\n";
  for (const DirectionalLight& light : rig.lights) {
    const Json json{{"direction", toJson(light.direction)},
                    {"irradiance", toJson(light.irradiance)},
                    {"angle", light.angle}};
    result += fmt::format("{}    {}", separator, text(json));
    separator = ",\n";
  }
  return result + "\n  ]\n}\n";
}

// The quaternion (x, y, z, w) of the shortest turn from +Z to `d`; -Z then goes to -d.
Json rotationFromZ(const dvec3& d) {
  const double w = 1 + d.z;
  if (w < 1e-9) return {0, 1, 0, 0};
  const double scale = 1 / std::sqrt(w * w + d.x * d.x + d.y * d.y);
  return {float(-d.y * scale), float(d.x * scale), 0, float(w * scale)};
}

std::string formatGltf(const LightRig& rig) {
  Json lights = Json::array(), nodes = Json::array(), roots = Json::array();
  for (const DirectionalLight& light : rig.lights) {
    const size_t index = lights.size();
    const float intensity = maxComponent(light.irradiance);
    const Rgb color = intensity > 0 ? light.irradiance / intensity : Rgb(1);
    const std::string name = fmt::format("{} {}", rig.method, index + 1);
    lights.push_back({{"type", "directional"},
                      {"name", name},
                      {"color", toJson(color)},
                      {"intensity", intensity},
                      {"extras", {{"angle", light.angle}}}});
    nodes.push_back({{"name", name},
                     {"rotation", rotationFromZ(normalize(dvec3(light.direction)))},
                     {"extensions", {{"KHR_lights_punctual", {{"light", index}}}}}});
    roots.push_back(index);
  }
  // The format allows no empty list.
  Json gltf{{"asset", {{"version", "2.0"}, {"generator", "chromeball " CHROMEBALL_VERSION}}}};
  Json extras{{"probe", rig.probe}, {"method", rig.method}};
  if (rig.ambient) extras["ambient"] = toJson(*rig.ambient);
  gltf["extras"] = extras;
  if (rig.lights.empty()) return text(gltf, 1) + "\n";
  gltf["extensionsUsed"] = {"KHR_lights_punctual"};
  gltf["extensions"]["KHR_lights_punctual"]["lights"] = lights;
  gltf["scene"] = 0;
  gltf["scenes"] = Json::array({Json{{"nodes", roots}}});
  gltf["nodes"] = nodes;
  return text(gltf, 1) + "\n";
}

std::string formatCsv(const LightRig& rig) {
  std::string result = "x,y,z,r,g,b,angle\n";
  for (const DirectionalLight& light : rig.lights) {
    const vec3& d = light.direction;
    const Rgb& e = light.irradiance;
    result += fmt::format("{},{},{},{},{},{},{}\n", d.x, d.y, d.z, e.x, e.y, e.z, light.angle);
  }
  return result;
}

// The error of a file that does not say what it should, where.
struct Reader {
  std::string file;

  [[noreturn]] void fail(const std::string& where, const char* expected) const {
    throwInput("{}: {} should be {}", file, where, expected);
  }
  const Json& member(const Json& object, const char* key, const std::string& where) const {
    if (!object.is_object() || !object.contains(key))
      fail(where, fmt::format("an object with a `{}`", key).c_str());
    return object[key];
  }
  std::string string(const Json& json, const std::string& where) const {
    if (!json.is_string()) fail(where, "a string");
    return json.get<std::string>();
  }
  vec3 triple(const Json& json, const std::string& where) const {
    if (!json.is_array() || json.size() != 3) fail(where, "three numbers");
    for (const Json& number : json)
      if (!number.is_number()) fail(where, "three numbers");
    return {json[0].get<float>(), json[1].get<float>(), json[2].get<float>()};
  }
  Rgb color(const Json& json, const std::string& where) const {
    const Rgb result = triple(json, where);
    if (glm::any(glm::lessThan(result, Rgb(0)))) fail(where, "three numbers that are not negative");
    return result;
  }
  DirectionalLight light(const Json& json, const std::string& where) const {
    const dvec3 direction = triple(member(json, "direction", where), where + ".direction");
    if (direction == dvec3(0)) fail(where + ".direction", "a direction, not zero");
    DirectionalLight result{normalize(direction),
                            color(member(json, "irradiance", where), where + ".irradiance")};
    if (!json.contains("angle")) return result;
    const Json& angle = json["angle"];
    if (!angle.is_number() || angle < 0 || angle > 360)
      fail(where + ".angle", "a number of degrees");
    result.angle = angle.get<float>();
    return result;
  }
};

Json parse(const std::filesystem::path& path) {
  const std::vector<uint8_t> bytes = readFile(path);
  try {
    return Json::parse(bytes);
  } catch (const Json::exception& error) {
    throwInput("{}: {}", path.string(), error.what());
  }
}

}  // namespace

void writeLights(const std::filesystem::path& path, const LightRig& rig) {
  for (const DirectionalLight& light : rig.lights)
    if (!isFinite(light.irradiance) || !isFinite(light.direction))
      throwRun("{}: a light of `{}` is not finite: the probe is too bright", path.string(),
               rig.method);
  static const std::map<std::string, std::string (*)(const LightRig&)> kFormats{
      {".json", formatJson}, {".gltf", formatGltf}, {".csv", formatCsv}};
  const auto format = kFormats.find(path.extension().string());
  if (format == kFormats.end())
    throwInput("{}: the name should end in .json, .gltf or .csv", path.string());
  const std::string contents = format->second(rig);
  writeFile(path, {reinterpret_cast<const uint8_t*>(contents.data()), contents.size()});
}

LightRig readLights(const std::filesystem::path& path) {
  const Json json = parse(path);
  const Reader reader{path.string()};
  LightRig rig;
  const Json& lights = reader.member(json, "lights", "the file");
  if (!lights.is_array()) reader.fail("lights", "a list");
  for (size_t i = 0; i < lights.size(); ++i)
    rig.lights.push_back(reader.light(lights[i], fmt::format("lights[{}]", i)));
  if (json.contains("probe")) rig.probe = reader.string(json["probe"], "probe");
  if (json.contains("method")) rig.method = reader.string(json["method"], "method");
  if (json.contains("ambient")) rig.ambient = reader.color(json["ambient"], "ambient");
  return rig;
}

}  // namespace chromeball
