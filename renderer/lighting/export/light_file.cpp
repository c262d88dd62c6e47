// SPDX-License-Identifier: Apache-2.0
#include "lighting/export/light_file.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"
#include "base/json.h"
#include "base/text.h"

namespace chromeball {
namespace {

using glm::dvec3;

// JSON with float numbers, so that each is written with the digits of a float.
using Json = nlohmann::basic_json<nlohmann::ordered_map, std::vector, std::string, bool, int64_t,
                                  uint64_t, float>;

std::string text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json toJson(const vec3& v) { return {v.x, v.y, v.z}; }

Rgb radianceOf(const DirectionalLight& light) {
  return Rgb(dvec3(light.irradiance) / projectedSolidAngle(light.angle));
}

// One line per light.
std::string formatJson(const LightRig& rig) {
  std::string result =
      fmt::format("{{\n  \"probe\": {},\n  \"method\": {},\n", text(rig.probe), text(rig.method));
  if (rig.ambient) result += fmt::format("  \"ambient\": {},\n", text(toJson(*rig.ambient)));
  result += "  \"lights\": [";
  const char* separator = "\n";
  for (const DirectionalLight& light : rig.lights) {
    Json json{{"direction", toJson(light.direction)},
              {"irradiance", toJson(light.irradiance)},
              {"angle", light.angle}};
    if (light.angle > 0) json["radiance"] = toJson(radianceOf(light));
    result += fmt::format("{}    {}", separator, text(json));
    separator = ",\n";
  }
  return result + "\n  ]\n}\n";
}

// The quaternion (x, y, z, w) of the shortest rotation that takes +Z to `d`, and so -Z to -d.
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
                      {"intensity", intensity * lumensPerWatt(rig.units)},
                      {"extras", {{"angle", light.angle}}}});
    nodes.push_back({{"name", name},
                     {"rotation", rotationFromZ(normalize(dvec3(light.direction)))},
                     {"extensions", {{"KHR_lights_punctual", {{"light", index}}}}}});
    roots.push_back(index);
  }
  // glTF allows no empty arrays, so without lights only extras are written.
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

struct NamedFormat {
  std::string_view name, extension;
  LightFormat format;
  std::string (*text)(const LightRig&);
};

// In the order of LightFormat.
constexpr NamedFormat kFormats[] = {{"json", ".json", LightFormat::Json, formatJson},
                                    {"gltf", ".gltf", LightFormat::Gltf, formatGltf},
                                    {"csv", ".csv", LightFormat::Csv, formatCsv},
                                    {"opengl", ".h", LightFormat::OpenGl, formatOpenGl}};

}  // namespace

double projectedSolidAngle(double degrees) {
  const double sine = std::sin(degrees / 2 * kPiD / 180);
  return kPiD * sine * sine;
}

LightFormat lightFormat(const std::filesystem::path& path, std::string_view name,
                        std::string_view location) {
  std::vector<std::string_view> names;
  for (const NamedFormat& format : kFormats) {
    if (name.empty() ? lowerExtension(path) == format.extension : name == format.name)
      return format.format;
    names.push_back(format.name);
  }
  if (name.empty())
    throwInput("{}: the name should end in .json, .gltf, .csv or .h", path.string());
  throwInput("{}: unknown format `{}`; {}", location, name, didYouMean(name, names));
}

void writeLights(const std::filesystem::path& path, const LightRig& rig, LightFormat format) {
  for (const DirectionalLight& light : rig.lights)
    if (!isFinite(light.irradiance) || !isFinite(light.direction) ||
        (light.angle > 0 && !isFinite(radianceOf(light))))
      throwRun("{}: a light of `{}` is not finite: the probe is too bright", path.string(),
               rig.method);
  const std::string contents = kFormats[size_t(format)].text(rig);
  writeFile(path, {reinterpret_cast<const uint8_t*>(contents.data()), contents.size()});
}

void writeLights(const std::filesystem::path& path, const LightRig& rig) {
  writeLights(path, rig, lightFormat(path, "", ""));
}

namespace {

// A file's name may hold what would end a comment.
std::string inComment(const std::string& name) {
  std::string text = printableName(name);
  for (char& c : text)
    if (c == '*' || c == '\\') c = '?';
  return text;
}

std::string row(const vec3& v, int last) {
  return fmt::format("{{{}, {}, {}, {}}}", v.x, v.y, v.z, last);
}

std::string array(const char* name, const Constellation& lights, int last,
                  vec3 (*of)(const DirectionalLight&)) {
  std::string text = fmt::format("static const float {}[][4] = {{\n", name);
  for (const DirectionalLight& light : lights) text += fmt::format("  {},\n", row(of(light), last));
  return text + "};\n";
}

constexpr const char* kHead =
    R"(/* {} directional lights{} in place of the probe
   {}
   by {}, for OpenGL's fixed-function lighting (Madsen et al. 2003, eq. 4).

   Radiances of a white surface, linear Rec. 709, not clipped: scale them by your exposure. The
   material's ambient and diffuse colours should be the same. Directions point to the lights, right-
   handed with +Y up: call setProbeLights() while the modelview matrix is the view. GL_MAX_LIGHTS is
   8 or more. */
)";

constexpr const char* kLoop = R"(  static const float black[4] = {0, 0, 0, 1};
  int j;
  for (j = 0; j < kProbeLights; ++j) {
    glEnable(GL_LIGHT0 + j);
    glLightfv(GL_LIGHT0 + j, GL_POSITION, kProbeDirection[j]);
    glLightfv(GL_LIGHT0 + j, GL_DIFFUSE, kProbeDiffuse[j]);
    glLightfv(GL_LIGHT0 + j, GL_AMBIENT, black);
    glLightfv(GL_LIGHT0 + j, GL_SPECULAR, black);
  }
)";

}  // namespace

// C has no empty arrays, so without lights only the ambient light is written.
std::string formatOpenGl(const LightRig& rig) {
  std::string text =
      fmt::format(kHead, rig.lights.size(), rig.ambient ? " and the ambient light" : "",
                  inComment(rig.probe), inComment(rig.method));
  text += fmt::format("enum {{ kProbeLights = {} }};\n", rig.lights.size());
  text += fmt::format("static const float kProbeAmbient[4] = {};\n",
                      row(rig.ambient.value_or(Rgb(0)), 1));
  if (!rig.lights.empty()) {
    text += array("kProbeDirection", rig.lights, 0,
                  [](const DirectionalLight& light) { return light.direction; });
    text += array("kProbeDiffuse", rig.lights, 1,
                  [](const DirectionalLight& light) { return light.irradiance * kInvPi; });
  }
  text += "\nstatic void setProbeLights(void) {\n";
  if (!rig.lights.empty()) text += kLoop;
  return text + "  glLightModelfv(GL_LIGHT_MODEL_AMBIENT, kProbeAmbient);\n}\n";
}

}  // namespace chromeball
