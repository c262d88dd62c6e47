// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/pose.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/gltf/accessor.h"
#include "scene/transform.h"

namespace chromeball {
namespace {

// Adds the target's displacements to the first three components of `array`.
template <class Vector>
void addDisplacements(GltfFile& file, const std::map<std::string, int>& target, const char* name,
                      double weight, const std::string& where, std::vector<Vector>& array) {
  const auto found = target.find(name);
  if (found == target.end() || array.empty()) return;
  const std::string at = where + "." + name;
  const std::vector<vec3> displacements = readVectors<3>(file, found->second, at);
  if (displacements.size() != array.size())
    file.fail("{}: {} elements for {} vertices", at, displacements.size(), array.size());
  for (size_t i = 0; i < array.size(); ++i)
    for (int k = 0; k < 3; ++k) array[i][k] += float(weight) * displacements[i][k];
}

// The blended joint matrix of every vertex.
std::vector<glm::dmat4> blendJoints(GltfFile& file, const tinygltf::Primitive& primitive,
                                    std::span<const glm::dmat4> joints, const std::string& where,
                                    size_t vertexCount) {
  std::vector<glm::dmat4> blended(vertexCount, glm::dmat4(0));
  std::vector<double> sum(vertexCount, 0);
  for (int set = 0;; ++set) {
    const auto jointSet = primitive.attributes.find(fmt::format("JOINTS_{}", set));
    const auto weightSet = primitive.attributes.find(fmt::format("WEIGHTS_{}", set));
    if (jointSet == primitive.attributes.end() || weightSet == primitive.attributes.end()) break;
    const std::string jointsAt = fmt::format("{}.attributes.{}", where, jointSet->first);
    const std::vector<vec4> indices = readVectors<4>(file, jointSet->second, jointsAt);
    const std::vector<vec4> weights = readVectors<4>(
        file, weightSet->second, fmt::format("{}.attributes.{}", where, weightSet->first));
    if (indices.size() != vertexCount || weights.size() != vertexCount)
      file.fail("{}: {} joints and {} weights for {} vertices", jointsAt, indices.size(),
                weights.size(), vertexCount);
    for (size_t i = 0; i < vertexCount; ++i)
      for (int k = 0; k < 4; ++k) {
        const double weight = weights[i][k];
        if (!std::isfinite(weight))
          file.fail("{}: vertex {} has a weight that is not finite", jointsAt, i);
        if (weight == 0) continue;
        if (!(indices[i][k] >= 0 && indices[i][k] < float(joints.size())))
          file.fail("{}: joint {} out of range ({} joints)", jointsAt, indices[i][k],
                    joints.size());
        blended[i] += weight * joints[size_t(indices[i][k])];
        sum[i] += weight;
      }
  }
  // Normalise the weights, since quantised ones may not add up to 1. Vertices without weights
  // follow the first joint.
  for (size_t i = 0; i < vertexCount; ++i)
    blended[i] = std::fabs(sum[i]) > 1e-6 ? blended[i] / sum[i] : joints[0];
  return blended;
}

}  // namespace

void applyMorphTargets(GltfFile& file, const tinygltf::Primitive& primitive,
                       std::span<const double> weights, const std::string& where, Mesh& mesh) {
  for (size_t i = 0; i < std::min(primitive.targets.size(), weights.size()); ++i) {
    if (weights[i] == 0) continue;
    if (!std::isfinite(weights[i])) file.fail("{}: morph weight {} is not finite", where, i);
    const std::string target = fmt::format("{}.targets[{}]", where, i);
    addDisplacements(file, primitive.targets[i], "POSITION", weights[i], target, mesh.positions);
    addDisplacements(file, primitive.targets[i], "NORMAL", weights[i], target, mesh.normals);
    addDisplacements(file, primitive.targets[i], "TANGENT", weights[i], target, mesh.tangents);
  }
}

void applySkin(GltfFile& file, const tinygltf::Primitive& primitive,
               std::span<const glm::dmat4> joints, const std::string& where, Mesh& mesh) {
  const std::vector<glm::dmat4> blended =
      blendJoints(file, primitive, joints, where, mesh.positions.size());
  size_t mirrored = 0;
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::dmat4& m = blended[i];
    const glm::dmat3 linear(m);
    const bool isMirrored = mirrors(linear);
    mirrored += isMirrored;
    mesh.positions[i] = vec3(m * glm::dvec4(glm::dvec3(mesh.positions[i]), 1));
    if (!mesh.normals.empty())
      mesh.normals[i] = vec3(normalMatrix(linear) * glm::dvec3(mesh.normals[i]));
    if (!mesh.tangents.empty()) {
      const vec4 t = mesh.tangents[i];
      mesh.tangents[i] = vec4(vec3(linear * glm::dvec3(t)), isMirrored ? -t.w : t.w);
    }
  }
  if (2 * mirrored > mesh.positions.size())
    for (Triangle& t : mesh.triangles) std::swap(t.y, t.z);
}

}  // namespace chromeball
