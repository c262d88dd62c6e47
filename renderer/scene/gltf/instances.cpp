// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/node_tree.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <map>

#include "base/text.h"
#include "scene/bounds.h"
#include "scene/builder/scene_builder.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/material_reader.h"
#include "scene/gltf/mesh.h"
#include "scene/mesh.h"
#include "scene/motion.h"

namespace chromeball {
namespace {

using glm::dmat4;

Transform roundToFloat(const dmat4& m) { return {glm::mat3(glm::dmat3(m)), vec3(m[3])}; }

// EXT_mesh_gpu_instancing: a node with several instances of its mesh.

constexpr const char* kInstancingExtension = "EXT_mesh_gpu_instancing";

// The transforms of the node's instances, relative to the node; one identity if it does not use the
// extension, or without transforms.
std::vector<dmat4> readInstanceTransforms(GltfFile& file, const tinygltf::Node& node,
                                          const std::string& where) {
  const auto found = node.extensions.find(kInstancingExtension);
  if (found == node.extensions.end()) return {dmat4(1)};
  const std::string at = where + "." + kInstancingExtension;
  const tinygltf::Value& attributes = memberOf(found->second, "attributes");
  std::map<std::string, int> accessors;
  for (const char* name : {"TRANSLATION", "ROTATION", "SCALE"})
    if (memberOf(attributes, name).IsInt()) accessors[name] = intMember(attributes, name);
  AttributeReader reader(file, accessors, "instances", at + ".");
  const auto translations = reader.read("TRANSLATION", readVectors<3>);
  const auto rotations = reader.read("ROTATION", readVectors<4>);
  const auto scales = reader.read("SCALE", readVectors<3>);
  if (translations.empty() && rotations.empty() && scales.empty()) return {dmat4(1)};

  const size_t count = reader.count();
  file.spend(count * sizeof(dmat4));
  std::vector<dmat4> transforms(count, dmat4(1));
  for (size_t i = 0; i < count; ++i) {
    dmat4& m = transforms[i];
    if (!translations.empty()) m = glm::translate(m, glm::dvec3(translations[i]));
    if (!rotations.empty()) {
      const glm::dvec4 r(rotations[i]);
      const double length = glm::length(r);
      if (!(length > 0))
        file.fail("{}.ROTATION: the quaternion of instance {} has length 0", at, i);
      m *= glm::mat4_cast(glm::dquat(r.w, r.x, r.y, r.z) / length);
    }
    if (!scales.empty()) m = glm::scale(m, glm::dvec3(scales[i]));
  }
  return transforms;
}

// Moves a mesh of several instances to its own origin if it is far away, as measured by its extent,
// so that the rounding errors of its places in the world are those of its size. Returns where its
// origin was.
glm::dvec3 moveFromAfar(Mesh& mesh) {
  constexpr double kFar = 16;
  Bounds box;
  for (const vec3& p : mesh.positions) box.add(p);
  const glm::dvec3 middle = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
  if (!(glm::length(middle) > kFar * glm::length(glm::dvec3(box.size())))) return glm::dvec3(0);
  transformMesh(mesh, glm::translate(dmat4(1), -middle));
  return middle;
}

class InstanceReader {
 public:
  InstanceReader(GltfFile& file, const NodeTree& tree, ModelCache* cache)
      : file_(file),
        tree_(tree),
        cache_(cache ? &cache->meshes : nullptr),
        materials_(file, cache ? &cache->texels : nullptr) {}

  Scene read() {
    scene_.nodeNames = tree_.names;
    scene_.nodeParents = tree_.parents;
    for (int node : tree_.visible) planNode(node);
    materials_.moveInto(scene_);
    for (const Plan& plan : plans_) addInstance(plan);
    if (cache_) cache_->forgetUnused();
    return std::move(scene_);
  }

 private:
  // Of each primitive of each node, in the budget of the file: plans, and recipes.
  static constexpr size_t kBytesPerPrimitive = 64, kBytesPerTarget = 64;

  struct Geometry {
    int users = 0;
    int mesh = -1;         // index in the scene, once read; used if there are several users
    glm::dvec3 origin{0};  // that is the mesh's own: far meshes are moved
  };

  // An instance to add: a primitive of a node, by one of the node's transforms.
  struct Plan {
    int node, mesh, primitive, material;
    Geometry* geometry;  // null: skinned, which transforms it to world space
    dmat4 toWorld;
  };

  void planNode(int index) {
    const tinygltf::Node& node = file_.model.nodes[size_t(index)];
    if (node.mesh == -1) return;
    const std::string where = fmt::format("nodes[{}]", index);
    const tinygltf::Mesh& mesh = file_.at(file_.model.meshes, node.mesh, "meshes", where + ".mesh");
    if (node.skin != -1) readJoints(node.skin, where + ".skin");
    const Pose pose = poseOf(index);
    const std::vector<dmat4> transforms = transformsOf(index, where);
    for (size_t i = 0; i < mesh.primitives.size(); ++i) {
      const tinygltf::Primitive& primitive = mesh.primitives[i];
      const bool skinned = isSkinned(primitive, pose);
      const std::string at = describe(node.mesh, i);
      file_.spend(kBytesPerPrimitive + kBytesPerTarget * primitive.targets.size());
      if (!hasTriangles(file_, primitive, at) || !(skinned || !transforms.empty())) continue;
      file_.spend((sizeof(Plan) + sizeof(Instance)) * std::max<size_t>(transforms.size(), 1));
      const int material = materials_.use(primitive.material, at + ".material");
      if (skinned) {
        file_.spend(sizeof(dmat4) * pose.joints.size());  // of its key (keyOf())
        plans_.push_back({index, node.mesh, int(i), material, nullptr, dmat4(1)});
        continue;
      }
      Geometry& geometry = geometries_[recipeOf(primitive, pose, materials_[material])];
      geometry.users += int(transforms.size());
      for (const dmat4& toWorld : transforms)
        plans_.push_back({index, node.mesh, int(i), material, &geometry, toWorld});
    }
  }

  void addInstance(const Plan& plan) {
    // Rays are not transformed back through a flattened or tiny instance: it has a mesh of its own.
    const bool shared =
        plan.geometry && plan.geometry->users > 1 && canPlaceInstance(glm::dmat3(plan.toWorld));
    if (!shared) {
      const ReadMesh read = readMesh(plan, plan.geometry ? &plan.toWorld : nullptr);
      if (read.mesh)
        builder_.addInstance(builder_.addMesh(read.mesh), plan.material, plan.node, {},
                             moves(plan));
      return;
    }
    Geometry& geometry = *plan.geometry;
    if (geometry.mesh == -1) {
      const ReadMesh read = readMesh(plan, nullptr);
      if (!read.mesh) return;
      geometry.mesh = builder_.addMesh(read.mesh);
      geometry.origin = read.origin;
    }
    builder_.addInstance(geometry.mesh, plan.material, plan.node,
                         roundToFloat(glm::translate(plan.toWorld, geometry.origin)), moves(plan));
  }

  const tinygltf::Primitive& primitiveOf(const Plan& plan) const {
    return file_.model.meshes[size_t(plan.mesh)].primitives[size_t(plan.primitive)];
  }

  bool moves(const Plan& plan) {
    const auto moves = [&](int node) { return bool(tree_.moves[size_t(node)]); };
    if (moves(plan.node)) return true;
    if (plan.geometry) return false;
    const int skin = file_.model.nodes[size_t(plan.node)].skin;
    const auto [found, isNew] = skinMoves_.try_emplace(skin);
    if (isNew) found->second = std::ranges::any_of(file_.model.skins[size_t(skin)].joints, moves);
    return found->second;
  }

  // A mesh, of an earlier load if there is one, transformed by `transform`; if that is null and it
  // is not skinned, moved to its origin if it is far away. Null if it has no triangles.
  ReadMesh readMesh(const Plan& plan, const dmat4* transform) {
    const tinygltf::Primitive& primitive = primitiveOf(plan);
    MeshKey key;
    if (cache_) {
      key = keyOf(plan, primitive, transform);
      if (ReadMesh known = cache_->find(key); known.mesh) return known;
    }
    const std::string where = describe(plan.mesh, size_t(plan.primitive));
    std::optional<Mesh> mesh =
        readPrimitive(file_, primitive, poseOf(plan.node), where, materialOf(plan));
    if (!mesh) return {};
    if (transform) transformMesh(*mesh, *transform);
    if (!areFinite(mesh->positions))
      file_.fail("{}: its node's transform exceeds the range of float", where);
    ReadMesh read;
    if (!transform && plan.geometry) read.origin = moveFromAfar(*mesh);
    read.mesh = std::make_shared<const Mesh>(std::move(*mesh));
    if (cache_) cache_->add(std::move(key), read);
    return read;
  }

  const Material& materialOf(const Plan& plan) const {
    return scene_.materials[size_t(plan.material)];
  }

  MeshKey keyOf(const Plan& plan, const tinygltf::Primitive& primitive,
                const dmat4* transform) const {
    const Pose pose = poseOf(plan.node);
    MeshKey key{
        file_.files().front(), recipeOf(primitive, pose, materialOf(plan)), !plan.geometry, {}};
    const auto append = [&](const dmat4& m) {
      key.placement.insert(key.placement.end(), &m[0][0], &m[0][0] + 16);
    };
    if (!plan.geometry) std::ranges::for_each(pose.joints, append);
    if (transform) append(*transform);
    return key;
  }

  static std::string describe(int mesh, size_t primitive) {
    return fmt::format("meshes[{}].primitives[{}]", mesh, primitive);
  }

  // The node's transforms to world space (several with EXT_mesh_gpu_instancing), without those that
  // leave no area of any surface.
  std::vector<dmat4> transformsOf(int index, const std::string& where) {
    std::vector<dmat4> transforms =
        readInstanceTransforms(file_, file_.model.nodes[size_t(index)], where);
    for (dmat4& transform : transforms) transform = tree_.toWorld[size_t(index)] * transform;
    const size_t count = transforms.size();
    std::erase_if(transforms,
                  [](const dmat4& transform) { return !leavesArea(glm::dmat3(transform)); });
    if (transforms.size() < count)
      file_.warnOnce(
          "ignored: nodes whose scale of 0 on two axes or three, or transform beyond the range of "
          "float, leaves no surface (such as \"" +
          printableName(tree_.names[size_t(index)]) + "\")");
    return transforms;
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
  MeshCache* cache_;  // null: none
  MaterialReader materials_;
  Scene scene_;
  SceneBuilder builder_{scene_};
  std::vector<Plan> plans_;
  std::map<MeshRecipe, Geometry> geometries_;
  std::map<int, std::vector<dmat4>> jointsOf_;  // by skin
  std::map<int, bool> skinMoves_;               // by skin
};

}  // namespace

Scene readInstances(GltfFile& file, const NodeTree& tree, ModelCache* cache) {
  return InstanceReader(file, tree, cache).read();
}

}  // namespace chromeball
