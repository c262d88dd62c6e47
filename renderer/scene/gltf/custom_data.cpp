// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/load_gltf.h"

#include <fmt/format.h>

#include "scene/gltf/accessor.h"
#include "scene/gltf/gltf_file.h"
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/mesh.h"
#include "scene/gltf/node_tree.h"

namespace chromeball {
namespace {

using tinygltf::Value;

std::vector<vec3> readFinite(GltfFile& file, int accessor, const std::string& where) {
  std::vector<vec3> vectors = readVectors<3>(file, accessor, where);
  for (size_t i = 0; i < vectors.size(); ++i)
    if (!isFinite(vectors[i])) file.fail("{}: element {} is not finite", where, i);
  return vectors;
}

void readExtras(GltfFile& file, CustomData& data) {
  if (!file.model.extras.IsObject()) return;
  const Value& extras = memberOf(file.model.extras, "chromeball");
  if (!extras.IsObject()) return;
  for (const std::string& key : extras.Keys())
    if (const Value& value = memberOf(extras, key); value.IsString())
      data.texts[key] = value.Get<std::string>();
  if (extras.Has("origin")) {
    const Value& origin = memberOf(extras, "origin");
    for (int i = 0; i < 3; ++i) {
      const Value& number = elementOf(origin, size_t(i));
      if (origin.ArrayLen() != 3 || !number.IsNumber())
        file.fail("extras.chromeball.origin: must be three numbers");
      data.origin[i] = number.GetNumberAsDouble();
    }
  }
  const Value& tables = memberOf(extras, "tables");
  if (!tables.IsObject()) return;
  for (const std::string& name : tables.Keys())
    data.tables[name] =
        readFinite(file, intMember(tables, name), "extras.chromeball.tables." + name);
}

// Whether the transform is a positive scale and a translation.
bool keepsDirections(const glm::dmat4& m) {
  constexpr double kTolerance = 1e-4;
  const double scale = (m[0][0] + m[1][1] + m[2][2]) / 3;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (!(std::abs(m[c][r] - (c == r ? scale : 0)) <= kTolerance * scale)) return false;
  return true;
}

}  // namespace

CustomData readCustomData(const std::string& path, const std::string& prefix,
                          ExternalFiles external) {
  GltfFile file(path, external);
  decodeMeshopt(file);
  decodeDraco(file);
  CustomData data;
  readExtras(file, data);
  const NodeTree tree = readNodes(file, {}, glm::dvec3(0));
  for (size_t i = 0; i < file.model.nodes.size(); ++i) {
    const int index = file.model.nodes[i].mesh;
    if (index == -1) continue;
    const tinygltf::Mesh& mesh =
        file.at(file.model.meshes, index, "meshes", fmt::format("nodes[{}].mesh", i));
    if (mesh.primitives.size() != 1) continue;
    if (!keepsDirections(tree.toWorld[i])) data.turned.insert(int(i));
    for (const auto& [name, accessor] : mesh.primitives[0].attributes)
      if (name.starts_with(prefix))
        data.attributes[int(i)][name] = readFinite(
            file, accessor, fmt::format("meshes[{}].primitives[0].attributes.{}", index, name));
  }
  return data;
}

}  // namespace chromeball
