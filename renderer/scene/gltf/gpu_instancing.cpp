// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/gpu_instancing.h"

#include <glm/gtc/matrix_transform.hpp>

#include "scene/gltf/accessor.h"
#include "scene/gltf/extension_members.h"

namespace chromeball {
namespace {

constexpr const char* kInstancingExtension = "EXT_mesh_gpu_instancing";

// The attribute of each instance; empty if the node does not have it.
template <int N>
std::vector<glm::vec<N, float>> readAttribute(GltfFile& file, const tinygltf::Value& attributes,
                                              const char* name, size_t& count,
                                              const std::string& where) {
  const tinygltf::Value& accessor = memberOf(attributes, name);
  if (!accessor.IsInt()) return {};
  const std::string at = where + "." + name;
  auto elements = readVectors<N>(file, accessor.GetNumberAsInt(), at);
  if (count == 0) count = elements.size();
  if (elements.size() != count)
    file.fail("{}: {} elements for {} instances", at, elements.size(), count);
  return elements;
}

}  // namespace

std::vector<glm::dmat4> readInstanceTransforms(GltfFile& file, const tinygltf::Node& node,
                                               const std::string& where) {
  const auto found = node.extensions.find(kInstancingExtension);
  if (found == node.extensions.end()) return {glm::dmat4(1)};
  const std::string at = where + "." + kInstancingExtension;
  const tinygltf::Value& attributes = memberOf(found->second, "attributes");
  size_t count = 0;
  const auto translations = readAttribute<3>(file, attributes, "TRANSLATION", count, at);
  const auto rotations = readAttribute<4>(file, attributes, "ROTATION", count, at);
  const auto scales = readAttribute<3>(file, attributes, "SCALE", count, at);
  if (translations.empty() && rotations.empty() && scales.empty()) return {glm::dmat4(1)};

  file.spend(count * sizeof(glm::dmat4));
  std::vector<glm::dmat4> transforms(count, glm::dmat4(1));
  for (size_t i = 0; i < count; ++i) {
    glm::dmat4& m = transforms[i];
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

}  // namespace chromeball
