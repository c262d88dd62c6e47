// SPDX-License-Identifier: Apache-2.0
#include "glb_objects.h"

#include <filesystem>
#include <numeric>
#include <set>

#include "image/io/write_image.h"

namespace chromeball::demo {
namespace {

// glTF's componentType.
constexpr int kUint16 = 5123, kFloat = 5126;

int addMesh(GlbWriter& glb, const Surface& s, int material) {
  const int positions = glb.accessor(s.positions, kFloat, "VEC3", s.positions.size());
  vec3 low = s.positions[0], high = low;
  for (const vec3& p : s.positions) low = glm::min(low, p), high = glm::max(high, p);
  glb.root["accessors"][positions]["min"] = {low.x, low.y, low.z};
  glb.root["accessors"][positions]["max"] = {high.x, high.y, high.z};
  const json attributes = {
      {"POSITION", positions},
      {"NORMAL", glb.accessor(s.normals, kFloat, "VEC3", s.normals.size())},
      {"TEXCOORD_0", glb.accessor(s.uvs, kFloat, "VEC2", s.uvs.size())},
  };
  const int triangles = glb.accessor(s.triangles, kUint16, "SCALAR", 3 * s.triangles.size());
  glb.root["meshes"].push_back(
      {{"primitives",
        {{{"attributes", attributes}, {"indices", triangles}, {"material", material}}}}});
  return int(glb.root["meshes"].size()) - 1;
}

int addMaterial(GlbWriter& glb, const Object& object) {
  json material = {{"name", object.name},
                   {"pbrMetallicRoughness",
                    {{"baseColorFactor", {object.color.x, object.color.y, object.color.z, 1}},
                     {"metallicFactor", object.metallic},
                     {"roughnessFactor", object.roughness}}}};
  if (object.texture >= 0)
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", object.texture}};
  if (object.glass) {
    material["pbrMetallicRoughness"] = {{"metallicFactor", 0}, {"roughnessFactor", 0}};
    material["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
    material["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 1}};
  } else if (object.lambertian) {
    material["extensions"]["KHR_materials_specular"] = {{"specularFactor", 0}};
  }
  if (object.glow > 0) {
    material["emissiveFactor"] = {1, 0.5, 0.18};
    material["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", object.glow}};
  }
  glb.root["materials"].push_back(material);
  return int(glb.root["materials"].size()) - 1;
}

}  // namespace

void addObject(GlbWriter& glb, const Object& object) {
  const int mesh = addMesh(glb, object.surface, addMaterial(glb, object));
  glb.root["nodes"].push_back({{"name", object.name}, {"mesh", mesh}});
}

int addTexture(GlbWriter& glb, const Image& color) {
  const auto file = std::filesystem::temp_directory_path() / "chromeball-demo-texture.png";
  writeImage(file, color);
  const int view = glb.view(readFile(file));
  std::filesystem::remove(file);
  glb.root["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
  glb.root["textures"].push_back({{"source", glb.root["images"].size() - 1}});
  return int(glb.root["textures"].size()) - 1;
}

void addCamera(GlbWriter& glb, const Camera& camera) {
  const glm::quat q = glm::quat_cast(mat3(camera.right, camera.up, camera.back));
  glb.root["cameras"].push_back({{"name", camera.name},
                                 {"type", "perspective"},
                                 {"perspective", {{"yfov", camera.fov}, {"znear", 0.01}}}});
  glb.root["nodes"].push_back(
      {{"name", camera.name},
       {"camera", glb.root["cameras"].size() - 1},
       {"translation", {camera.position.x, camera.position.y, camera.position.z}},
       {"rotation", {q.x, q.y, q.z, q.w}}});
}

void writeScene(GlbWriter& glb, const std::string& path) {
  std::vector<int> nodes(glb.root["nodes"].size());
  std::iota(nodes.begin(), nodes.end(), 0);
  glb.root["scenes"] = {{{"nodes", nodes}}};
  std::set<std::string> extensions;
  for (const json& material : glb.root["materials"])
    if (material.contains("extensions"))
      for (const auto& [name, extension] : material["extensions"].items()) extensions.insert(name);
  if (!extensions.empty()) glb.root["extensionsUsed"] = extensions;
  glb.write(path);
}

}  // namespace chromeball::demo
