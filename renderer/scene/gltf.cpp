#include "scene/gltf.h"

#include <algorithm>
#include <map>

#include "scene/gltf_accessor.h"
#include "scene/gltf_file.h"
#include "scene/gltf_material.h"
#include "scene/gltf_mesh.h"
#include "scene/gltf_node.h"
#include "scene/mesh_attributes.h"

namespace chromeball {
namespace {

using glm::dmat3;
using glm::dmat4;
using glm::dvec3;

Transform roundToFloat(const dmat4& m) { return {glm::mat3(dmat3(m)), vec3(m[3])}; }

// False where the matrix flattens space, or does once it is rounded to float.
bool isInvertible(const dmat4& m) {
  const dmat3 linear(glm::mat3{dmat3(m)});
  const double volume = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  return std::isfinite(volume) && std::fabs(glm::determinant(linear)) > 1e-9 * volume;
}

// Joint matrices of a skin: each joint's world matrix times its inverse bind matrix.
std::vector<dmat4> readJoints(GltfFile& file, int skin, const NodeTree& tree,
                              const std::string& where) {
  const tinygltf::Skin& s = file.at(file.model.skins, skin, "skins", where);
  const std::string at = fmt::format("skins[{}]", skin);
  if (s.joints.empty()) file.fail("{}: has no joints", at);
  std::vector<dmat4> inverseBind(s.joints.size(), dmat4(1));
  if (s.inverseBindMatrices != -1)
    inverseBind = readMatrices(file, s.inverseBindMatrices, at + ".inverseBindMatrices");
  if (inverseBind.size() < s.joints.size())
    file.fail("{}: {} inverse bind matrices for {} joints", at, inverseBind.size(),
              s.joints.size());
  std::vector<dmat4> joints;
  for (size_t i = 0; i < s.joints.size(); ++i)
    joints.push_back(file.at(tree.toWorld, s.joints[i], "nodes", at + ".joints") * inverseBind[i]);
  return joints;
}

// Puts the meshes of the scene's nodes into the scene.
class SceneBuilder {
 public:
  SceneBuilder(GltfFile& file, const NodeTree& tree) : file_(file), tree_(tree), materials_(file) {}

  Scene build() {
    for (int node : tree_.inScene)
      if (isShared(node)) ++users_[file_.model.nodes[size_t(node)].mesh];
    for (int node : tree_.inScene)
      if (file_.model.nodes[size_t(node)].mesh != -1) addNode(node);
    materials_.moveInto(scene_);
    return std::move(scene_);
  }

 private:
  // Whether the node shows its mesh in the mesh's own pose.
  bool isShared(int node) const {
    const tinygltf::Node& n = file_.model.nodes[size_t(node)];
    return n.mesh != -1 && n.skin == -1 && n.weights.empty();
  }

  void addNode(int index) {
    const tinygltf::Node& node = file_.model.nodes[size_t(index)];
    const std::string where = fmt::format("nodes[{}]", index);
    const tinygltf::Mesh& mesh = file_.at(file_.model.meshes, node.mesh, "meshes", where + ".mesh");
    Pose pose{node.weights.empty() ? mesh.weights : node.weights, {}};
    if (node.skin != -1) pose.joints = readJoints(file_, node.skin, tree_, where + ".skin");

    if (isShared(index) && users_[node.mesh] > 1) {
      if (!mayPlace(index)) return;
      const auto [found, isNew] = shared_.try_emplace(node.mesh);
      if (isNew) found->second = readMesh(node.mesh, pose, nullptr);
      for (int m : found->second)
        scene_.instances.push_back({m, index, roundToFloat(tree_.toWorld[size_t(index)])});
      return;
    }
    if (pose.joints.empty() && !mayPlace(index)) return;
    for (int m : readMesh(node.mesh, pose, &tree_.toWorld[size_t(index)]))
      scene_.instances.push_back({m, index, {}});
  }

  bool mayPlace(int node) {
    if (isInvertible(tree_.toWorld[size_t(node)])) return true;
    file_.warnOnce("nodes without an invertible transform (\"" + tree_.names[size_t(node)] +
                   "\", say) are left out");
    return false;
  }

  // Adds the primitives of a mesh, in world space where a transform is given; returns their
  // indices.
  std::vector<int> readMesh(int index, const Pose& pose, const dmat4* toWorld) {
    std::vector<int> added;
    const auto& primitives = file_.model.meshes[size_t(index)].primitives;
    for (size_t i = 0; i < primitives.size(); ++i) {
      const std::string where = fmt::format("meshes[{}].primitives[{}]", index, i);
      std::optional<Mesh> mesh = readPrimitive(file_, primitives[i], pose, where, materials_);
      if (!mesh) continue;
      if (toWorld && !isSkinned(primitives[i], pose)) transformMesh(*mesh, *toWorld);
      if (!std::all_of(mesh->positions.begin(), mesh->positions.end(), isFinite))
        file_.fail("{}: its node moves it out of the range of float", where);
      added.push_back(int(scene_.meshes.size()));
      scene_.meshes.push_back(std::move(*mesh));
    }
    return added;
  }

  GltfFile& file_;
  const NodeTree& tree_;
  MaterialReader materials_;
  Scene scene_;
  std::map<int, int> users_;                // of a glTF mesh, in its own pose
  std::map<int, std::vector<int>> shared_;  // glTF mesh to our meshes
};

// The camera's frame is the node's, made orthonormal; mirroring and scale do not reach the view.
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
    camera.name = source.name.empty() ? tree.names[size_t(i)] : source.name;
    camera.orthographic = source.type == "orthographic";
    camera.fov = float(lens.yfov);
    camera.halfHeight = float(std::fabs(box.ymag));
    camera.aspect = float(camera.orthographic ? std::fabs(box.xmag / box.ymag) : lens.aspectRatio);
    if (!(camera.aspect > 0) || !std::isfinite(camera.aspect)) camera.aspect = 0;
    const bool sees = camera.orthographic
                          ? camera.halfHeight > 0 && std::isfinite(camera.halfHeight)
                          : lens.yfov > 0 && lens.yfov < kPiD;
    if (!sees || !isInvertible(tree.toWorld[size_t(i)])) {
      file.warnOnce("camera \"" + camera.name + "\" has no view and is left out");
      continue;
    }
    placeCamera(tree.toWorld[size_t(i)], camera);
    scene.cameras.push_back(camera);
  }
}

bool movesAtAll(const GltfFile& file) {
  const auto hasTargets = [](const tinygltf::Mesh& mesh) {
    return std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                       [](const auto& primitive) { return !primitive.targets.empty(); });
  };
  return file.animated || !file.model.skins.empty() ||
         std::any_of(file.model.meshes.begin(), file.model.meshes.end(), hasTargets);
}

// A file of meshes without any node still shows them, each once.
void standMeshesUp(tinygltf::Model& model) {
  if (!model.nodes.empty() || !model.scenes.empty()) return;
  for (size_t i = 0; i < model.meshes.size(); ++i) model.nodes.emplace_back().mesh = int(i);
}

}  // namespace

Scene loadGltf(const std::string& path, const Transform& placement, const Warn& warn) {
  GltfFile file(path, warn);
  standMeshesUp(file.model);
  const NodeTree tree = readNodes(file, placement);
  Scene scene = SceneBuilder(file, tree).build();
  readCameras(file, tree, scene);
  scene.nodeNames = tree.names;
  if (movesAtAll(file))
    file.warnOnce("shown in its rest pose: animations, skins and morph targets do not move");
  return scene;
}

}  // namespace chromeball
