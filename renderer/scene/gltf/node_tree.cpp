// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/node_tree.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <iterator>

#include "scene/gltf/gltf_json.h"

namespace chromeball {
namespace {

using glm::dmat4;

void checkNumbers(const GltfFile& file, const std::vector<double>& numbers, size_t count,
                  const std::string& where) {
  if (numbers.size() != count)
    file.fail("{}: has {} numbers; it must have {}", where, numbers.size(), count);
  for (double x : numbers)
    if (!std::isfinite(x)) file.fail("{}: a number is not finite", where);
}

dmat4 localMatrix(const GltfFile& file, const tinygltf::Node& node, const std::string& where) {
  if (!node.matrix.empty()) {
    checkNumbers(file, node.matrix, 16, where + ".matrix");
    const dmat4 m = glm::make_mat4(node.matrix.data());
    if (m[0].w != 0 || m[1].w != 0 || m[2].w != 0 || m[3].w != 1)
      file.fail("{}.matrix: is not affine; its last row must be 0 0 0 1", where);
    return m;
  }
  dmat4 m(1);
  if (const auto& t = node.translation; !t.empty()) {
    checkNumbers(file, t, 3, where + ".translation");
    m = glm::translate(m, {t[0], t[1], t[2]});
  }
  if (const auto& r = node.rotation; !r.empty()) {
    checkNumbers(file, r, 4, where + ".rotation");
    const double length = std::hypot(std::hypot(r[0], r[1]), std::hypot(r[2], r[3]));
    if (!(length > 0)) file.fail("{}.rotation: the quaternion has length 0", where);
    glm::dquat q;
    q.x = r[0] / length, q.y = r[1] / length, q.z = r[2] / length, q.w = r[3] / length;
    m *= glm::mat4_cast(q);
  }
  if (const auto& s = node.scale; !s.empty()) {
    checkNumbers(file, s, 3, where + ".scale");
    m = glm::scale(m, {s[0], s[1], s[2]});
  }
  return m;
}

std::vector<int> parentsOf(const GltfFile& file) {
  const auto& nodes = file.model.nodes;
  std::vector<int> parents(nodes.size(), -1);
  for (size_t i = 0; i < nodes.size(); ++i)
    for (int child : nodes[i].children) {
      const std::string where = fmt::format("nodes[{}].children", i);
      file.at(nodes, child, "nodes", where);
      if (parents[size_t(child)] != -1)
        file.fail("{}: nodes[{}] is also a child of nodes[{}]; nodes must form trees", where, child,
                  parents[size_t(child)]);
      parents[size_t(child)] = int(i);
    }
  return parents;
}

// The given nodes and all their descendants, each once, parents first.
std::vector<int> descend(const GltfFile& file, const std::vector<int>& roots) {
  std::vector<bool> seen(file.model.nodes.size(), false);
  std::vector<int> order, stack(roots.rbegin(), roots.rend());
  while (!stack.empty()) {
    const int node = stack.back();
    stack.pop_back();
    if (seen[size_t(node)]) continue;
    seen[size_t(node)] = true;
    order.push_back(node);
    const auto& children = file.model.nodes[size_t(node)].children;
    stack.insert(stack.end(), children.rbegin(), children.rend());
  }
  return order;
}

std::vector<int> sceneRoots(const GltfFile& file, const std::vector<int>& treeRoots) {
  const tinygltf::Model& model = file.model;
  if (model.scenes.empty()) return treeRoots;
  const int index = std::max(model.defaultScene, 0);
  const std::vector<int>& roots = file.at(model.scenes, index, "scenes", "scene").nodes;
  for (int root : roots)
    file.at(model.nodes, root, "nodes", fmt::format("scenes[{}].nodes", index));
  return roots;
}

bool isMarkedHidden(const tinygltf::Node& node) {
  const tinygltf::Value* e = findExtension(node.extensions, "KHR_node_visibility");
  if (!e) return false;
  const tinygltf::Value& visible = memberOf(*e, "visible");
  return visible.IsBool() && !visible.Get<bool>();
}

// The nodes that neither are hidden nor have a hidden ancestor. `order`: parents before children.
std::vector<int> visibleNodes(const GltfFile& file, const std::vector<int>& parents,
                              const std::vector<int>& order, const std::vector<int>& inScene) {
  std::vector<bool> hidden(parents.size());
  for (const int i : order) {
    const int parent = parents[size_t(i)];
    hidden[size_t(i)] =
        isMarkedHidden(file.model.nodes[size_t(i)]) || (parent != -1 && hidden[size_t(parent)]);
  }
  std::vector<int> visible;
  std::ranges::copy_if(inScene, std::back_inserter(visible),
                       [&](int node) { return !hidden[size_t(node)]; });
  return visible;
}

std::string nameOf(const tinygltf::Model& model, size_t i) {
  const tinygltf::Node& node = model.nodes[i];
  if (!node.name.empty()) return node.name;
  const bool hasMesh = node.mesh >= 0 && size_t(node.mesh) < model.meshes.size();
  if (hasMesh && !model.meshes[size_t(node.mesh)].name.empty())
    return model.meshes[size_t(node.mesh)].name;
  return fmt::format("nodes[{}]", i);
}

}  // namespace

NodeTree readNodes(const GltfFile& file, const Transform& placement, const glm::dvec3& origin) {
  const auto& nodes = file.model.nodes;
  const std::vector<int> parents = parentsOf(file);
  std::vector<int> treeRoots;
  for (size_t i = 0; i < nodes.size(); ++i)
    if (parents[i] == -1) treeRoots.push_back(int(i));
  const std::vector<int> order = descend(file, treeRoots);

  NodeTree tree;
  dmat4 rootTransform{glm::dmat3(placement.linear)};
  rootTransform[3] = glm::dvec4(glm::dvec3(placement.translation) - origin, 1);
  tree.toWorld.assign(nodes.size(), dmat4(0));
  tree.moves = file.animated;
  tree.moves.resize(nodes.size());
  for (int i : order) {
    const int parent = parents[size_t(i)];
    if (parent != -1 && tree.moves[size_t(parent)]) tree.moves[size_t(i)] = true;
    tree.toWorld[size_t(i)] = (parent == -1 ? rootTransform : tree.toWorld[size_t(parent)]) *
                              localMatrix(file, nodes[size_t(i)], fmt::format("nodes[{}]", i));
  }
  // Each node has at most one parent, so nodes that no root reaches lie on or below a cycle.
  if (order.size() < nodes.size()) {
    std::vector<bool> reached(nodes.size(), false);
    for (int i : order) reached[size_t(i)] = true;
    const auto first = std::find(reached.begin(), reached.end(), false) - reached.begin();
    file.fail("nodes[{}]: is its own ancestor; nodes must form trees", first);
  }
  tree.inScene = descend(file, sceneRoots(file, treeRoots));
  tree.visible = visibleNodes(file, parents, order, tree.inScene);
  for (size_t i = 0; i < nodes.size(); ++i) tree.names.push_back(nameOf(file.model, i));
  tree.parents = parents;
  return tree;
}

}  // namespace chromeball
