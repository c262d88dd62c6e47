// SPDX-License-Identifier: Apache-2.0
// Reads glTF accessors: every component type, interleaved, normalised, sparse. Each byte offset,
// stride and count is checked before any byte is read. Errors throw InputError and name the user of
// the accessor (`where`).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "math/vec.h"
#include "scene/gltf/gltf_file.h"

namespace chromeball {

// Calls visit(T()), with T the C++ type of an accessor's components.
template <class Visit>
auto withComponentType(int componentType, const Visit& visit) {
  if (componentType == TINYGLTF_COMPONENT_TYPE_BYTE) return visit(int8_t());
  if (componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return visit(uint8_t());
  if (componentType == TINYGLTF_COMPONENT_TYPE_SHORT) return visit(int16_t());
  if (componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return visit(uint16_t());
  if (componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) return visit(uint32_t());
  return visit(float());
}

// Elements of N components (1 to 4) as floats; integers are normalised if the accessor is.
// Throws if the accessor's type does not have N components.
template <int N>
std::vector<glm::vec<N, float>> readVectors(GltfFile& file, int accessor, const std::string& where);

// Vertex indices. Throws if one is the primitive-restart value or not below `vertexCount`.
std::vector<uint32_t> readIndices(GltfFile& file, int accessor, size_t vertexCount,
                                  const std::string& where);

// The same in groups of three; one or two left over are dropped.
std::vector<Triangle> readTriangles(GltfFile& file, int accessor, size_t vertexCount,
                                    const std::string& where);

std::vector<glm::dmat4> readMatrices(GltfFile& file, int accessor, const std::string& where);

// RGB (then alpha is 1) or RGBA.
std::vector<vec4> readColors(GltfFile& file, int accessor, const std::string& where);

// Reads named attributes of vertices or instances. Throws if their lengths differ.
class AttributeReader {
 public:
  // `accessors`: by name. `elements`: what they are, for messages. `where` is followed by the name.
  AttributeReader(GltfFile& file, const std::map<std::string, int>& accessors, const char* elements,
                  std::string where)
      : file_(file), accessors_(accessors), elements_(elements), where_(std::move(where)) {}

  size_t count() const { return count_; }

  // Reads the attribute by one of the functions above; empty if there is none.
  template <class T>
  std::vector<T> read(const std::string& name,
                      std::vector<T> (*readArray)(GltfFile&, int, const std::string&)) {
    const auto found = accessors_.find(name);
    if (found == accessors_.end()) return {};
    std::vector<T> array = readArray(file_, found->second, where_ + name);
    if (count_ == 0) count_ = array.size();
    if (array.size() != count_)
      file_.fail("{}: {} elements for {} {}", where_ + name, array.size(), count_, elements_);
    return array;
  }

 private:
  GltfFile& file_;
  const std::map<std::string, int>& accessors_;
  const char* elements_;
  std::string where_;
  size_t count_ = 0;
};

}  // namespace chromeball
