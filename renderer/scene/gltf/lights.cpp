// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/node_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/parallel.h"
#include "image/io/decode_image.h"
#include "image/size_limits.h"
#include "probe/convert.h"
#include "probe/edit.h"
#include "probe/mapping.h"
#include "scene/gltf/gltf_json.h"
#include "scene/texture.h"

namespace chromeball {
namespace {

using Kind = PunctualLight::Kind;
using tinygltf::Value;

constexpr const char* kLightsExtension = "KHR_lights_punctual";

// Element `index` of the file's list of lights of an extension; null if there is none.
const Value* listedLight(const GltfFile& file, const char* extension, int index) {
  const Value* root = findExtension(file.model.extensions, extension);
  if (index < 0 || !root || size_t(index) >= memberOf(*root, "lights").ArrayLen()) return nullptr;
  return &elementOf(memberOf(*root, "lights"), size_t(index));
}

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
  const std::string type = textMember(source, "type");
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
  light.outerCone = coneOf(outer);
  light.innerCone = coneOf(number(file, spot, "innerConeAngle", 0, 0, outer, at));
  return light;
}

}  // namespace

std::vector<PunctualLight> readLights(GltfFile& file, const NodeTree& tree, LightUnits units) {
  std::vector<PunctualLight> lights;
  for (int index : tree.visible) {
    const auto& extensions = file.model.nodes[size_t(index)].extensions;
    const Value* use = findExtension(extensions, kLightsExtension);
    if (!use || !memberOf(*use, "light").IsInt()) continue;
    const int id = intMember(*use, "light");
    const Value* source = listedLight(file, kLightsExtension, id);
    if (!source) file.fail("nodes[{}].{}: lights[{}] does not exist", index, kLightsExtension, id);
    PunctualLight light = readLight(file, *source, units, fmt::format("lights[{}]", id));

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

namespace {

constexpr const char* kEnvironmentExtension = "EXT_lights_image_based";
constexpr int kFaces = 6, kMaxFace = 2048;

// The light of the default scene; null if it has none. Sets `where` to its location in the file.
const Value* findLight(const GltfFile& file, std::string& where) {
  if (file.model.scenes.empty()) return nullptr;
  const int scene = std::max(file.model.defaultScene, 0);
  const Value* use = findExtension(file.at(file.model.scenes, scene, "scenes", "scene").extensions,
                                   kEnvironmentExtension);
  if (!use) return nullptr;
  const int index = intMember(*use, "light");
  where = fmt::format("{}.lights[{}]", kEnvironmentExtension, index);
  const Value* light = listedLight(file, kEnvironmentExtension, index);
  if (!light) file.fail("scenes[{}]: {} does not exist", scene, where);
  return light;
}

std::array<int, kFaces> facesOf(const GltfFile& file, const Value& light,
                                const std::string& where) {
  const Value& levels = memberOf(light, "specularImages");
  const Value& level = levels.IsArray() && levels.ArrayLen() > 0 ? elementOf(levels, 0) : levels;
  if (!level.IsArray() || level.ArrayLen() != size_t(kFaces))
    file.fail("{}.specularImages: must begin with the six faces of a cube", where);
  std::array<int, kFaces> faces{};
  for (int i = 0; i < kFaces; ++i) {
    const Value& image = elementOf(level, size_t(i));
    faces[size_t(i)] = image.IsInt() ? image.GetNumberAsInt() : -1;
    file.at(file.images, faces[size_t(i)], "images", where + ".specularImages");
  }
  return faces;
}

// Files with alpha are RGBD: sRGB-encoded RGB, to be divided by alpha.
Rgb radianceAt(const TexelGrid& grid, int x, int y) {
  const vec4 texel = linearTexel(grid, true, x, y);
  return Rgb(texel) / texel.w;
}

// The faces side by side, as in Mapping::HorizontalStrip. The extension stores rows along the
// second coordinate of cube maps, which points up, so the side faces have to be rotated by 180
// degrees, and the top and bottom faces not.
Image readStrip(const GltfFile& file, const std::array<int, kFaces>& faces) {
  std::array<TexelGrid, kFaces> grids;
  parallelFor(0, kFaces, [&](int i) {
    const int image = faces[size_t(i)];
    Bytes storage;
    const std::string name = file.describeImage(image);
    DecodedImage d = decodeImage(file.image(image, storage), name, [&](const SampleLayout& face) {
      if (face.width != face.height || face.width > kMaxFace)
        throwInput("{}: is {} x {}; the face of an environment must be square, at most {} x {}",
                   name, face.width, face.height, kMaxFace, kMaxFace);
      checkImageMemory(name, int64_t(kFaces) * face.width, face.height, 4);  // of all faces
    });
    grids[size_t(i)] = {d.width, d.height, std::move(d.texels8), std::move(d.texelsFloat)};
  });
  const int n = grids[0].width;
  Image strip(kFaces * n, n, 3);
  for (int i = 0; i < kFaces; ++i) {
    const TexelGrid& grid = grids[size_t(i)];
    if (grid.width != n)
      throwInput("{}: is {} x {}, but the first face is {} x {}",
                 file.describeImage(faces[size_t(i)]), grid.width, grid.width, n, n);
    const bool isSide = i / 2 != 1;
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        strip.setRgb(i * n + (isSide ? n - 1 - x : x), isSide ? n - 1 - y : y,
                     radianceAt(grid, x, y));
  }
  return strip;
}

glm::dmat3 rotationOf(GltfFile& file, const Value& light, const std::string& where) {
  const vec4 q = vectorMember<4>(file, light, "rotation", {0, 0, 0, 1}, -1e6, 1e6, where);
  if (!(glm::length(q) > 1e-6f)) file.fail("{}.rotation: the quaternion has length 0", where);
  return glm::mat3_cast(glm::normalize(glm::dquat(q.w, q.x, q.y, q.z)));
}

// Warns if the images and the irradiance coefficients disagree. The first coefficient is the mean
// irradiance over all normals, divided by Y00 = sqrt(1 / (4 pi)). That mean is also pi times the
// mean radiance of the images.
void compareWithCoefficients(GltfFile& file, const Value& light, const Image& latLong,
                             const std::string& where) {
  const Value& coefficients = memberOf(light, "irradianceCoefficients");
  if (!coefficients.IsArray() || !elementOf(coefficients, 0).IsArray()) return;
  double stated = 0;
  for (int i = 0; i < 3; ++i)
    if (const Value& x = elementOf(elementOf(coefficients, 0), size_t(i)); x.IsNumber())
      stated += x.GetNumberAsDouble() * std::sqrt(1 / (4 * kPiD)) / 3;
  const dvec3 mean = kPiD * meanRadiance(latLong);
  const double ofImages = (mean.x + mean.y + mean.z) / 3, ratio = ofImages / stated;
  if (stated > 0 && !(ratio > 0.9 && ratio < 1.1))
    file.warnOnce(
        fmt::format("{}: its images give {:.3g} times the light of its "
                    "irradianceCoefficients; the images are used",
                    where, ratio));
}

}  // namespace

std::optional<Image> readEnvironment(GltfFile& file) {
  std::string where;
  const Value* light = findLight(file, where);
  if (!light) return std::nullopt;
  const float intensity = member(file, *light, "intensity", 1, 0, 1e30, where);
  const glm::dmat3 rotation = rotationOf(file, *light, where);
  Image strip = readStrip(file, facesOf(file, *light, where));
  if (const RepairReport report = repair(strip, false); report.total() > 0)
    file.warnOnce(where + ": repaired " + describe(report));
  Image latLong = latLongOf(strip, Mapping::HorizontalStrip, rotation);
  compareWithCoefficients(file, *light, latLong, where);
  for (float& f : latLong.texels) f *= intensity;
  return latLong;
}

}  // namespace chromeball
