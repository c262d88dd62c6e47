// SPDX-License-Identifier: Apache-2.0
#include "glb_objects.h"

#include <numeric>

#include "image/io/write_image.h"

namespace chromeball::demo {
namespace {

using Json = GltfDocument::Json;

int addMaterial(GltfDocument& document, const Object& object) {
  Json material = {{"name", object.name},
                   {"pbrMetallicRoughness",
                    {{"baseColorFactor", {object.color.x, object.color.y, object.color.z, 1}},
                     {"metallicFactor", object.metallic},
                     {"roughnessFactor", object.roughness}}}};
  const auto extend = [&](const char* extension, const Json& parameters) {
    material["extensions"][extension] = parameters;
    document.use(extension);
  };
  if (object.texture >= 0)
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", object.texture}};
  if (object.glass) {
    material["pbrMetallicRoughness"] = {{"metallicFactor", 0}, {"roughnessFactor", 0}};
    extend("KHR_materials_transmission", {{"transmissionFactor", 1}});
    Json volume = {{"thicknessFactor", 1}};
    if (object.color != Rgb(1)) {
      volume["attenuationColor"] = {object.color.x, object.color.y, object.color.z};
      volume["attenuationDistance"] = 0.2;
    }
    extend("KHR_materials_volume", volume);
  } else if (object.lambertian) {
    extend("KHR_materials_specular", {{"specularFactor", 0}});
  }
  if (object.glow > 0) {
    material["emissiveFactor"] = {1, 0.5, 0.18};
    extend("KHR_materials_emissive_strength", {{"emissiveStrength", object.glow}});
  }
  if (object.anisotropy > 0)  // stretches highlights across the scratches
    extend("KHR_materials_anisotropy",
           {{"anisotropyStrength", object.anisotropy}, {"anisotropyRotation", kPiD / 2}});
  if (object.clearcoat > 0)
    extend("KHR_materials_clearcoat", {{"clearcoatFactor", object.clearcoat}});
  return document.add("materials", material);
}

}  // namespace

int addMesh(GltfDocument& document, const Object& object) {
  const Surface& s = object.surface;
  const Json attributes = {{"POSITION", document.accessor(s.positions)},
                           {"NORMAL", document.accessor(s.normals)},
                           {"TEXCOORD_0", document.accessor(s.uvs)}};
  const Json primitive = {{"attributes", attributes},
                          {"indices", document.indices(s.triangles)},
                          {"material", addMaterial(document, object)}};
  return document.add("meshes", {{"primitives", Json::array({primitive})}});
}

void addNode(GltfDocument& document, const std::string& name, int mesh, const Placement& at) {
  Json node = {{"name", name}, {"mesh", mesh}};
  if (at.position != vec3(0)) node["translation"] = {at.position.x, at.position.y, at.position.z};
  if (at.turn != 0) node["rotation"] = {0, std::sin(0.5f * at.turn), 0, std::cos(0.5f * at.turn)};
  if (at.scale != vec3(1)) node["scale"] = {at.scale.x, at.scale.y, at.scale.z};
  document.add("nodes", node);
}

void addObject(GltfDocument& document, const Object& object) {
  addNode(document, object.name, addMesh(document, object), {});
}

int addTexture(GltfDocument& document, const Image& color) {
  const int image = document.addPng(encodePng(color, {}), "texture");
  return document.add("textures", {{"source", image}});
}

void writeScene(GltfDocument& document, const char* cameraName, const Camera& camera,
                const std::filesystem::path& path) {
  const glm::quat q = glm::quat_cast(mat3(camera.right, camera.up, camera.back));
  const int index =
      document.add("cameras", {{"name", cameraName},
                               {"type", "perspective"},
                               {"perspective", {{"yfov", camera.fov}, {"znear", 0.01}}}});
  document.add("nodes", {{"name", cameraName},
                         {"camera", index},
                         {"translation", {camera.position.x, camera.position.y, camera.position.z}},
                         {"rotation", {q.x, q.y, q.z, q.w}}});
  std::vector<int> nodes(document.root["nodes"].size());
  std::iota(nodes.begin(), nodes.end(), 0);
  document.add("scenes", {{"nodes", nodes}});
  document.root["scene"] = 0;
  document.write(path);
}

}  // namespace chromeball::demo
