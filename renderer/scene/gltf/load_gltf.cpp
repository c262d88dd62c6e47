// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/load_gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "base/text.h"
#include "scene/gltf/animation.h"
#include "scene/gltf/gltf_file.h"
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/material_reader.h"
#include "scene/gltf/mesh.h"
#include "scene/gltf/model_cache.h"
#include "scene/gltf/node_tree.h"
#include "scene/motion.h"

namespace chromeball {
namespace {

using glm::dmat4;
using glm::dvec3;

// The camera takes the node's frame, orthonormalised, so that mirroring and scale do not change the
// view.
void placeCamera(const dmat4& toWorld, Camera& camera) {
  const dvec3 back = glm::normalize(dvec3(toWorld[2]));
  const dvec3 right = glm::normalize(glm::cross(dvec3(toWorld[1]), back));
  camera.position = vec3(toWorld[3]);
  camera.back = vec3(back);
  camera.right = vec3(right);
  camera.up = vec3(glm::cross(back, right));
}

void readCameras(GltfFile& file, const NodeTree& tree, Scene& scene) {
  for (int i : tree.inScene) {
    const tinygltf::Node& node = file.model.nodes[size_t(i)];
    if (node.camera == -1) continue;
    const tinygltf::Camera& source =
        file.at(file.model.cameras, node.camera, "cameras", fmt::format("nodes[{}].camera", i));
    const auto& lens = source.perspective;
    const auto& box = source.orthographic;
    Camera camera;
    camera.node = tree.names[size_t(i)];
    camera.name = source.name.empty() ? camera.node : source.name;
    camera.orthographic = source.type == "orthographic";
    camera.fov = float(lens.yfov);
    camera.halfHeight = float(std::fabs(box.ymag));
    camera.aspect = float(camera.orthographic ? std::fabs(box.xmag / box.ymag) : lens.aspectRatio);
    if (!(camera.aspect > 0) || !std::isfinite(camera.aspect)) camera.aspect = 0;
    const bool isValid = camera.orthographic
                             ? camera.halfHeight > 0 && std::isfinite(camera.halfHeight)
                             : lens.yfov > 0 && lens.yfov < kPiD;
    if (!isValid || !isInvertible(glm::dmat3(tree.toWorld[size_t(i)]))) {
      file.warnOnce("camera \"" + printableName(camera.name) +
                    "\" is ignored: it has no field of view, or its node a scale of 0");
      continue;
    }
    constexpr double kFarthest = 1e9;  // metres, as for meshes
    if (const dvec3 position(tree.toWorld[size_t(i)][3]);
        !(std::max({std::fabs(position.x), std::fabs(position.y), std::fabs(position.z)}) <=
          kFarthest))
      file.fail("nodes[{}]: its camera is more than 1e9 m from the origin", i);
    placeCamera(tree.toWorld[size_t(i)], camera);
    scene.cameras.push_back(camera);
  }
}

// Lengths that nodes do not scale (KHR_materials_volume, KHR_lights_punctual, cameras) do scale
// with the whole model, as with a change of its unit.
void scaleLengths(const Transform& placement, Scene& scene) {
  const float scale = std::cbrt(std::fabs(glm::determinant(placement.linear)));
  if (!(scale > 0)) return;
  for (Material& m : scene.materials)
    if (m.extended) m.extended->attenuation /= scale;
  for (PunctualLight& light : scene.lights) light.range *= scale;
  for (Camera& camera : scene.cameras) camera.halfHeight *= scale;
}

// If the file has meshes but no nodes, adds a node for each mesh.
void addMissingNodes(tinygltf::Model& model) {
  if (!model.nodes.empty() || !model.scenes.empty()) return;
  for (size_t i = 0; i < model.meshes.size(); ++i) model.nodes.emplace_back().mesh = int(i);
}

// KHR_materials_variants: alternative sets of materials for a model.

using tinygltf::Value;

// Warns if the element to which a mapping refers does not exist.
bool isThere(GltfFile& file, const char* array, int index, size_t count) {
  if (index >= 0 && size_t(index) < count) return true;
  file.warnOnce(fmt::format("a mapping refers to {}[{}], which does not exist ({} in the file)",
                            array, index, count));
  return false;
}

// Gives the primitive the material of a mapping if that is for the variant. Returns whether it is.
bool applyMapping(GltfFile& file, const Value& mapping, int variant, size_t variantCount,
                  tinygltf::Primitive& primitive) {
  if (!memberOf(mapping, "material").IsInt()) return false;
  const Value& variants = memberOf(mapping, "variants");
  bool isMeant = false;
  for (size_t i = 0; i < variants.ArrayLen(); ++i) {
    if (!elementOf(variants, i).IsInt()) continue;
    const int other = elementOf(variants, i).GetNumberAsInt();
    isThere(file, "variants", other, variantCount);
    isMeant |= other == variant;
  }
  const int material = intMember(mapping, "material");
  if (!isThere(file, "materials", material, file.model.materials.size()) || !isMeant) return false;
  primitive.material = material;
  return true;
}

// Gives each primitive its material in the variant.
void applyVariant(GltfFile& file, const VariantChoice& choice) {
  const std::vector<std::string> names = variantNames(file);
  const auto found = std::find(names.begin(), names.end(), choice.name);
  if (names.empty()) file.fail("has no variants ({})", choice.location);
  if (found == names.end())
    file.fail("has no variant `{}` ({}); {}", choice.name, choice.location,
              didYouMean(choice.name, {names.begin(), names.end()}));
  const int variant = int(found - names.begin());
  bool isUsed = false;
  for (tinygltf::Mesh& mesh : file.model.meshes)
    for (tinygltf::Primitive& primitive : mesh.primitives) {
      const Value* extension = findExtension(primitive.extensions, kVariantsExtension);
      if (!extension) continue;
      const Value& mappings = memberOf(*extension, "mappings");
      for (size_t i = 0; i < mappings.ArrayLen(); ++i)
        isUsed |= applyMapping(file, elementOf(mappings, i), variant, names.size(), primitive);
    }
  if (!isUsed)
    file.warnOnce(
        fmt::format("variant `{}` has no effect: no primitive has a material for it", choice.name));
}

// The file with its variant applied; from an earlier load if the cache keeps files.
std::shared_ptr<GltfFile> openedFile(const std::string& path, const GltfChoice& choice) {
  const std::string key =
      fmt::format("{}\n{}\n{}", path, choice.animation ? "=" + choice.animation->name : "",
                  choice.variant ? "=" + choice.variant->name : "");
  ModelCache* cache = choice.cache && choice.cache->keepsFiles ? choice.cache : nullptr;
  if (cache)
    if (const auto found = cache->files.find(key); found != cache->files.end())
      return found->second;
  auto file = std::make_shared<GltfFile>(path, choice.external);
  decodeMeshopt(*file);
  decodeDraco(*file);
  if (choice.variant) applyVariant(*file, *choice.variant);
  if (cache) cache->files[key] = file;
  return file;
}

bool isAnimatedBy(const GltfChoice& choice, const GltfFile& file) {
  return choice.animation && !(choice.animation->ifAny && file.model.animations.empty());
}

}  // namespace

bool beginsAsGltf(const std::string& path) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf", kBlank = " \t\r\n";
  std::string text(64, ' ');
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) std::ifstream(path).read(text.data(), 64);
  if (text.starts_with("glTF")) return true;
  if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
  const size_t first = text.find_first_not_of(kBlank);
  return first != std::string::npos && text[first] == '{';
}

std::vector<double> animationChanges(const std::string& path, const GltfChoice& choice,
                                     double seconds) {
  if (!choice.animation) return {};
  const std::shared_ptr<GltfFile> file = openedFile(path, choice);
  file->beginLoad();
  if (!isAnimatedBy(choice, *file)) return {};
  return changesAfter(*file, *choice.animation, seconds);
}

Scene loadGltf(const std::string& path, const Transform& placement, const Warn& warn,
               const GltfChoice& choice) {
  const std::shared_ptr<GltfFile> opened = openedFile(path, choice);
  GltfFile& file = *opened;
  file.beginLoad();
  const bool isAnimated = isAnimatedBy(choice, file);
  if (isAnimated) applyAnimation(file, *choice.animation);
  addMissingNodes(file.model);
  const NodeTree tree = readNodes(file, placement, choice.origin);
  Scene scene = readInstances(file, tree, choice.cache);
  readCameras(file, tree, scene);
  scene.lights = readLights(file, tree, choice.lightUnits);
  scaleLengths(placement, scene);
  if (choice.environment) scene.environment = readEnvironment(file);
  scene.files = file.files();
  scene.isAnimated = isAnimated;
  if (!choice.animation && !file.model.animations.empty())
    scene.notes.push_back(fmt::format(
        "{}: shown in its rest pose; a name and a time select one of its animations: {}", path,
        animationNames(file)));
  if (warn) std::ranges::for_each(file.warnings(), warn);
  return scene;
}

}  // namespace chromeball
