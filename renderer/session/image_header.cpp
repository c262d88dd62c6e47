// SPDX-License-Identifier: Apache-2.0
#include "session/image_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <set>

#include "base/file.h"
#include "base/hash.h"
#include "base/json.h"
#include "base/parallel.h"
#include "description/describe.h"

namespace chromeball {
namespace {

using Json = nlohmann::ordered_json;

// Contents of files are compared instead.
constexpr std::array kPaths = {"scene", "probe", "camera-file", "files"};
constexpr std::array kLimits = {"samples-limit", "noise-limit", "time-limit"};
constexpr std::array kOfImage = {"camera",        "cameraPosition",
                                 "cameraFov",     "lensRadius",
                                 "focus",         "distortion",
                                 "worldToCamera", "worldToNDC",
                                 "size",          "crop",
                                 "shard",         "orbit",
                                 "seed",          "clamp",
                                 "transparent",   "denoise",
                                 "adaptive",      "ao-distance",
                                 "bent",          "aov",
                                 "scene-camera",  "lens",
                                 "optics",        "view",
                                 "look-at",       "fov",
                                 "zoom"};
constexpr std::array kVariedByComparisons = {"strategy", "adaptive", "guide"};

// The matrix for row vectors: each row is the transformed unit vector of an axis, the last row the
// transformed origin.
Json rows(const glm::dmat4& matrix) {
  Json numbers = Json::array();
  for (int column = 0; column < 4; ++column)  // glm's matrices are for column vectors
    for (int row = 0; row < 4; ++row) numbers.push_back(float(matrix[column][row]));
  return numbers;
}

glm::dmat4 worldToCamera(const Camera& camera, const glm::dvec3& position) {
  const glm::dmat4 toWorld(glm::dvec4(camera.right, 0), glm::dvec4(camera.up, 0),
                           glm::dvec4(-camera.back, 0), glm::dvec4(position, 1));
  return glm::inverse(toWorld);
}

// The point (x, y, z) of camera space has the image position u = p + x / (2 a h z),
// v = q - y / (2 h z), with h half the image's height at distance 1, a its aspect ratio and (p, q)
// the principal point. The third coordinate increases with z. The lens's distortion is not in it.
glm::dmat4 cameraToNdc(const Camera& camera, double aspect) {
  const double h = camera.orthographic ? camera.halfHeight : std::tan(0.5 * double(camera.fov));
  glm::dmat4 m(0);
  m[0][0] = 0.5 / (aspect * h);
  m[1][1] = -0.5 / h;
  if (camera.orthographic) {
    m[2][2] = 1;
    m[3] = glm::dvec4(0.5, 0.5, 0, 1);
  } else {
    m[2] = glm::dvec4(camera.principalPoint, 1, 1);
    m[3][2] = -1e-3;  // depth 1 - 0.001 / z
  }
  return m;
}

void describeCamera(const RenderSettings& settings, const LoadedScene& loaded, Json& d) {
  const Camera& camera = loaded.camera;
  const glm::dvec3 position = glm::dvec3(camera.position) + loaded.origin;
  const glm::dmat4 toCamera = worldToCamera(camera, position);
  d["cameraPosition"] = {position.x, position.y, position.z};
  d["cameraFov"] = camera.orthographic ? 0 : glm::degrees(camera.fov);
  if (camera.lensRadius > 0) {
    d["lensRadius"] = camera.lensRadius;
    d["focus"] = camera.focus;
  }
  if (camera.distortion) d["distortion"] = {camera.distortion.k1, camera.distortion.k2};
  d["worldToCamera"] = rows(toCamera);
  d["worldToNDC"] = rows(cameraToNdc(camera, double(settings.width) / settings.height) * toCamera);
}

// The files that count by their contents: all, or only the files that the description does not
// repeat, that is, neither the scene file nor a camera's.
enum class FileContents { All, Others };

// The description, with contents of files instead of their names, and without limits.
Json describeContents(const LoadedScene& loaded, FileContents which) {
  Json identity = describeLoaded(loaded);
  for (const char* name : kPaths) identity.erase(name);
  for (const char* name : kLimits) identity.erase(name);
  const bool all = which == FileContents::All;
  if (all && !loaded.description.path.empty())
    identity["contents of scene"] = fingerprint(loaded.description.path);
  for (const std::string& file : loaded.files) {
    if (!all && file == loaded.description.camera.file) continue;
    const std::string row = "contents of " + std::filesystem::path(file).filename().string();
    identity[row] = hash(identity.value(row, uint64_t(0)), fingerprint(file));
  }
  return identity;
}

uint64_t hashOf(const std::vector<PunctualLight>& lights) {
  uint64_t sum = 0;
  for (const PunctualLight& light : lights)
    for (const vec3& v : {light.position, light.direction, light.intensity})
      for (int i = 0; i < 3; ++i) sum = hash(sum, uint64_t(std::bit_cast<uint32_t>(v[i])));
  return sum;
}

// A float if it holds the number exactly.
Metadata::mapped_type numberAttribute(double number) {
  const float rounded = float(number);
  if (double(rounded) == number) return rounded;
  return number;
}

}  // namespace

Json describeLoaded(const LoadedScene& loaded) {
  Json d = describe(loaded.description);
  if (loaded.description.probe.file) d["probe-found"] = mappingName(loaded.loadedProbe.mapping);
  if (const auto& found = loaded.plateScale)
    d["probe-scale"] = fmt::format("{},{},{}", found->scale.x, found->scale.y, found->scale.z);
  if (!loaded.camera.name.empty()) d["camera"] = loaded.camera.name;
  d["files"] = loaded.files;
  describeCamera(loaded.description.settings, loaded, d);
  return d;
}

Metadata toMetadata(const Json& description) {
  Metadata metadata;
  for (const auto& [name, value] : description.items()) {
    if (value.is_string())
      metadata[name] = value.get<std::string>();
    else if (value.is_number_float())
      metadata[name] = numberAttribute(value.get<double>());
    else if (value.is_number() && value <= INT32_MAX && name != "seed")  // a seed has 64 bits
      metadata[name] = value.get<int>();
    else if (value.is_array() && value.size() == std::tuple_size_v<Matrix44>)
      metadata[name] = value.get<Matrix44>();
    else
      metadata[name] = jsonText(value);
  }
  return metadata;
}

std::string identityOf(const LoadedScene& loaded) {
  Json identity = describeContents(loaded, FileContents::All);
  for (const char* name : kVariedByComparisons) identity.erase(name);
  identity["threads"] = threadCount();
  return jsonText(identity);
}

std::string renderIdentity(const LoadedScene& loaded) {
  Json identity = describeContents(loaded, FileContents::All);
  identity["layers"] = layerNames(loaded.description);
  if (loaded.description.settings.shard.count >
      1)  // which samples are a shard's depends on the number of all
    identity["samples"] = loaded.description.settings.samplesOfAll();
  return jsonText(identity);
}

std::string lightIdentity(const LoadedScene& loaded) {
  Json identity = describeContents(loaded, FileContents::Others);
  for (const char* name : kOfImage) identity.erase(name);
  if (std::ranges::none_of(loaded.scene.instances, &Instance::moves))
    for (const char* name : {"animation", "animation-time"}) identity.erase(name);
  identity["lamps"] = hashOf(loaded.scene.lights);  // which may move
  return jsonText(identity);
}

std::string withoutParts(const std::string& identity) {
  Json whole = readOrderedJson(identity);
  if (!whole.is_object()) return identity;
  for (const char* name : {"shard", "crop", "samples"}) whole.erase(name);
  return jsonText(whole);
}

std::string differenceOf(const std::string& stored, const std::string& own) {
  const Json was = readOrderedJson(stored), is = readOrderedJson(own);
  if (!was.is_object() || !is.is_object()) return "it was made by another version";
  Json names = was;
  names.update(is);
  for (const auto& [name, ignored] : names.items()) {
    if (was.value(name, Json()) == is.value(name, Json())) continue;
    constexpr std::string_view kContents = "contents of ";
    if (name.starts_with(kContents))
      return was.contains(name) && is.contains(name)
                 ? fmt::format("the {} changed", name)
                 : fmt::format("only one of them reads {}", name.substr(kContents.size()));
    const auto text = [&name = name](const Json& identity) {
      if (!identity.contains(name)) return std::string("not given");
      const Json& value = identity.at(name);
      return value.is_string() ? value.get<std::string>() : jsonText(value);
    };
    return fmt::format("`{}` was {} and is {}", name, text(was), text(is));
  }
  return "it is the same";
}

namespace {

using nlohmann::ordered_json;

constexpr size_t kMaxBytes = 1 << 20, kLongestName = 256;

std::string dumped(const ordered_json& json) {
  return json.dump(-1, ' ', true,
                   ordered_json::error_handler_t::replace);  // names may hold any byte
}

// `name(id - 1)`: the name of the number `id`.
template <class Name>
std::string manifestOf(const Image& ids, const Name& name) {
  const std::set<float> present(ids.texels.begin(), ids.texels.end());
  ordered_json names = ordered_json::object();
  size_t bytes = 0, omitted = 0;
  for (const float id : present) {
    if (!(id >= 1)) continue;  // 0: nothing was hit
    const ordered_json text = name(size_t(id) - 1).substr(0, kLongestName);
    bytes += dumped(text).size() + 16;
    if (bytes > kMaxBytes)
      ++omitted;
    else
      names[std::to_string(size_t(id))] = text;
  }
  if (omitted) names["omitted"] = omitted;
  return dumped(names);
}

}  // namespace

Metadata idManifests(const OutputImage& output, const Scene& scene) {
  Metadata manifests;
  for (const Layer& layer : output.layers) {
    if (layer.name == "node")
      manifests["manifest/node"] =
          manifestOf(layer.image, [&](size_t node) { return scene.nodeNames.at(node); });
    if (layer.name == "material")
      manifests["manifest/material"] = manifestOf(
          layer.image, [&](size_t material) { return scene.materials.at(material).name; });
  }
  return manifests;
}

std::map<int, std::string> readManifest(const Metadata& metadata, const std::string& layer) {
  std::map<int, std::string> names;
  const auto found = metadata.find("manifest/" + layer);
  if (found == metadata.end() || !std::holds_alternative<std::string>(found->second)) return names;
  const auto json = readJson(std::get<std::string>(found->second));
  if (!json.is_object()) return names;
  for (const auto& [id, name] : json.items())
    if (name.is_string() && !id.empty() && id.size() < 9 &&
        id.find_first_not_of("0123456789") == std::string::npos)
      names[std::stoi(id)] = name.get<std::string>();
  return names;
}

}  // namespace chromeball
