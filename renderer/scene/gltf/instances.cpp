// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/instances.h"

#include <algorithm>
#include <map>

#include "scene/gltf/accessor.h"
#include "scene/gltf/gpu_instancing.h"
#include "scene/gltf/material_reader.h"
#include "scene/gltf/mesh.h"
#include "scene/mesh_attributes.h"

namespace chromeball {
namespace {

using glm::dmat4;

Transform roundToFloat(const dmat4& m) { return {glm::mat3(glm::dmat3(m)), vec3(m[3])}; }

class InstanceReader {
 public:
  InstanceReader(GltfFile& file, const NodeTree& tree)
      : file_(file), tree_(tree), materials_(file) {}

  Scene read() {
    for (int node : tree_.inScene) planNode(node);
    for (const Plan& plan : plans_) location(plan);
    materials_.moveInto(scene_);
    return std::move(scene_);
  }

 private:
  struct Geometry {
    int users = 0;
    int mesh = -1;  // in the scene, once it has been read for several users
  };

  // A primitive that a node shows, at one of its places.
  struct Plan {
    int node, mesh, primitive, material;
    Geometry* geometry;  // null: skinned, which puts it into world space
    dmat4 toWorld;
  };

  void planNode(int index) {
    const tinygltf::Node& node = file_.model.nodes[size_t(index)];
    if (node.mesh == -1) return;
    const std::string where = fmt::format("nodes[{}]", index);
    const tinygltf::Mesh& mesh = file_.at(file_.model.meshes, node.mesh, "meshes", where + ".mesh");
    if (node.skin != -1) readJoints(node.skin, where + ".skin");
    const Pose pose = poseOf(index);
    const std::vector<dmat4> places = placesOf(index, where);
    for (size_t i = 0; i < mesh.primitives.size(); ++i) {
      const tinygltf::Primitive& primitive = mesh.primitives[i];
      const bool skinned = isSkinned(primitive, pose);
      const std::string at = describe(node.mesh, i);
      if (!hasTriangles(file_, primitive, at) || !(skinned || !places.empty())) continue;
      file_.spend((sizeof(Plan) + sizeof(Instance)) * std::max<size_t>(places.size(), 1));
      const int material = materials_.use(primitive.material, at + ".material");
      if (skinned) {
        plans_.push_back({index, node.mesh, int(i), material, nullptr, dmat4(1)});
        continue;
      }
      Geometry& geometry = geometries_[recipeOf(primitive, pose, materials_[material])];
      geometry.users += int(places.size());
      for (const dmat4& toWorld : places)
        plans_.push_back({index, node.mesh, int(i), material, &geometry, toWorld});
    }
  }

  void location(const Plan& plan) {
    const bool shared = plan.geometry && plan.geometry->users > 1;
    int mesh = shared ? plan.geometry->mesh : -1;
    if (mesh == -1) mesh = readMesh(plan, shared || !plan.geometry ? nullptr : &plan.toWorld);
    if (mesh == -1) return;
    if (shared) plan.geometry->mesh = mesh;
    scene_.instances.push_back({mesh, plan.material, plan.node,
                                shared ? std::optional(roundToFloat(plan.toWorld)) : std::nullopt});
  }

  // Adds a mesh to the scene, moved by `transform` where there is one; -1 where it has no
  // triangles.
  int readMesh(const Plan& plan, const dmat4* transform) {
    const auto& primitive =
        file_.model.meshes[size_t(plan.mesh)].primitives[size_t(plan.primitive)];
    const std::string where = describe(plan.mesh, size_t(plan.primitive));
    std::optional<Mesh> mesh =
        readPrimitive(file_, primitive, poseOf(plan.node), where, materials_[plan.material]);
    if (!mesh) return -1;
    if (transform) transformMesh(*mesh, *transform);
    if (!std::all_of(mesh->positions.begin(), mesh->positions.end(), isFinite))
      file_.fail("{}: its node moves it out of the range of float", where);
    scene_.meshes.push_back(std::move(*mesh));
    return int(scene_.meshes.size()) - 1;
  }

  static std::string describe(int mesh, size_t primitive) {
    return fmt::format("meshes[{}].primitives[{}]", mesh, primitive);
  }

  // The invertible ones of the node's transforms; several where it is instanced.
  std::vector<dmat4> placesOf(int index, const std::string& where) {
    std::vector<dmat4> places =
        readInstanceTransforms(file_, file_.model.nodes[size_t(index)], where);
    for (dmat4& location : places) location = tree_.toWorld[size_t(index)] * location;
    const size_t all = places.size();
    std::erase_if(places, [](const dmat4& location) { return !isInvertible(location); });
    if (places.size() < all)
      file_.warnOnce("nodes without an invertible transform (\"" + tree_.names[size_t(index)] +
                     "\", say) are left out");
    return places;
  }

  Pose poseOf(int index) const {
    const tinygltf::Node& node = file_.model.nodes[size_t(index)];
    const tinygltf::Mesh& mesh = file_.model.meshes[size_t(node.mesh)];
    return {node.weights.empty() ? mesh.weights : node.weights,
            node.skin == -1 ? std::span<const dmat4>() : jointsOf_.at(node.skin)};
  }

  // Joint matrices of a skin: each joint's world matrix times its inverse bind matrix.
  void readJoints(int index, const std::string& where) {
    const tinygltf::Skin& skin = file_.at(file_.model.skins, index, "skins", where);
    const auto [found, isNew] = jointsOf_.try_emplace(index);
    if (!isNew) return;
    const std::string at = fmt::format("skins[{}]", index);
    if (skin.joints.empty()) file_.fail("{}: has no joints", at);
    std::vector<dmat4> inverseBind(skin.joints.size(), dmat4(1));
    if (skin.inverseBindMatrices != -1)
      inverseBind = readMatrices(file_, skin.inverseBindMatrices, at + ".inverseBindMatrices");
    if (inverseBind.size() < skin.joints.size())
      file_.fail("{}: {} inverse bind matrices for {} joints", at, inverseBind.size(),
                 skin.joints.size());
    for (size_t i = 0; i < skin.joints.size(); ++i)
      found->second.push_back(file_.at(tree_.toWorld, skin.joints[i], "nodes", at + ".joints") *
                              inverseBind[i]);
  }

  GltfFile& file_;
  const NodeTree& tree_;
  MaterialReader materials_;
  Scene scene_;
  std::vector<Plan> plans_;
  std::map<MeshRecipe, Geometry> geometries_;
  std::map<int, std::vector<dmat4>> jointsOf_;  // by skin
};

}  // namespace

Scene readInstances(GltfFile& file, const NodeTree& tree) {
  return InstanceReader(file, tree).read();
}

}  // namespace chromeball
