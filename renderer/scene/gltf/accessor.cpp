// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/accessor.h"

#include <cstring>
#include <limits>

namespace chromeball {
namespace {

// The elements of an accessor, tightly packed, after sparse substitution.
struct Packed {
  size_t count = 0;
  int components = 0, componentType = 0;
  bool normalized = false;
  Bytes bytes;
};

// An accessor without a buffer view is all zeros, so the length of the file does not limit its
// size.
constexpr size_t kMaxElementsWithoutView = size_t(1) << 24;

size_t componentSize(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

// Throws unless `count` elements of `size` bytes, `stride` bytes apart, fit into the buffer view
// from `offset` on.
void checkFit(const GltfFile& file, size_t viewBytes, size_t offset, size_t stride, size_t size,
              size_t count, const std::string& where) {
  const bool fits = offset <= viewBytes && size <= viewBytes - offset &&
                    count - 1 <= (viewBytes - offset - size) / stride;
  if (!fits)
    file.fail(
        "{}: {} elements of {} bytes, {} apart, from byte {} on do not fit into the {} bytes of "
        "the buffer view",
        where, count, size, stride, offset, viewBytes);
}

template <class T>
T load(const uint8_t* at) {
  T component;
  std::memcpy(&component, at, sizeof(T));
  return component;
}

uint32_t loadUnsigned(const uint8_t* at, int type) {
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return *at;
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return load<uint16_t>(at);
  return load<uint32_t>(at);
}

bool isUnsigned(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

void substituteSparse(const GltfFile& file, const tinygltf::Accessor& a, size_t elementSize,
                      Packed& packed, const std::string& where) {
  const auto& sparse = a.sparse;
  if (sparse.count < 1 || size_t(sparse.count) > packed.count || sparse.indices.byteOffset < 0 ||
      sparse.values.byteOffset < 0 || !isUnsigned(sparse.indices.componentType))
    file.fail("{}: invalid sparse substitution", where);
  const size_t count = size_t(sparse.count);
  const size_t indexSize = componentSize(sparse.indices.componentType);
  const auto indices = file.view(sparse.indices.bufferView, where + ".sparse.indices");
  const auto elements = file.view(sparse.values.bufferView, where + ".sparse.values");
  const size_t indexOffset = size_t(sparse.indices.byteOffset);
  const size_t elementOffset = size_t(sparse.values.byteOffset);
  checkFit(file, indices.size(), indexOffset, indexSize, indexSize, count,
           where + ".sparse.indices");
  checkFit(file, elements.size(), elementOffset, elementSize, elementSize, count,
           where + ".sparse.values");
  for (size_t i = 0; i < count; ++i) {
    const size_t index =
        loadUnsigned(indices.data() + indexOffset + i * indexSize, sparse.indices.componentType);
    if (index >= packed.count)
      file.fail("{}.sparse: index {} out of range ({} elements)", where, index, packed.count);
    std::memcpy(packed.bytes.data() + index * elementSize,
                elements.data() + elementOffset + i * elementSize, elementSize);
  }
}

Packed readPacked(GltfFile& file, int accessor, const std::string& user) {
  const tinygltf::Accessor& a = file.at(file.model.accessors, accessor, "accessors", user);
  const std::string where = fmt::format("{}: accessors[{}]", user, accessor);
  Packed packed;
  packed.count = a.count;
  packed.componentType = a.componentType;
  packed.normalized = a.normalized;
  packed.components = tinygltf::GetNumComponentsInType(uint32_t(a.type));
  const size_t size = componentSize(a.componentType);
  if (size == 0 || packed.components < 1)
    file.fail("{}: componentType {} is not a glTF 2.0 type", where, a.componentType);
  if (a.count < 1) file.fail("{}: has no elements", where);

  const size_t elementSize = size * size_t(packed.components);
  if (a.bufferView < 0) {
    if (a.count > kMaxElementsWithoutView)
      file.fail("{}: {} elements without a buffer view; the limit is {}", where, a.count,
                kMaxElementsWithoutView);
    file.spend(a.count * elementSize);
    packed.bytes.assign(a.count * elementSize, 0);
  } else {
    const std::span<const uint8_t> view = file.view(a.bufferView, where);
    const size_t byteStride = file.model.bufferViews[size_t(a.bufferView)].byteStride;
    const size_t stride = byteStride ? byteStride : elementSize;
    if (stride < elementSize)
      file.fail("{}: byteStride {} is less than the {} bytes of an element", where, stride,
                elementSize);
    checkFit(file, view.size(), a.byteOffset, stride, elementSize, a.count, where);
    file.spend(a.count * elementSize);
    packed.bytes.resize(a.count * elementSize);
    const uint8_t* from = view.data() + a.byteOffset;
    if (stride == elementSize)
      std::memcpy(packed.bytes.data(), from, packed.bytes.size());
    else
      for (size_t i = 0; i < a.count; ++i)
        std::memcpy(packed.bytes.data() + i * elementSize, from + i * stride, elementSize);
  }
  if (a.sparse.isSparse) substituteSparse(file, a, elementSize, packed, where);
  return packed;
}

// Signed normalised integers (glTF 2.0, 3.6.2.2): f = max(c / 127, -1), so two codes give -1.
template <class T>
void convert(const Packed& packed, float* out) {
  const float scale =
      packed.normalized && std::is_integral_v<T> ? 1 / float(std::numeric_limits<T>::max()) : 1.0f;
  const size_t n = packed.count * size_t(packed.components);
  for (size_t i = 0; i < n; ++i) {
    const float x = float(load<T>(packed.bytes.data() + i * sizeof(T))) * scale;
    out[i] = packed.normalized && std::is_signed_v<T> && std::is_integral_v<T> && x < -1 ? -1 : x;
  }
}

void toFloats(const Packed& packed, float* out) {
  switch (packed.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return convert<int8_t>(packed, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return convert<uint8_t>(packed, out);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return convert<int16_t>(packed, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return convert<uint16_t>(packed, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return convert<uint32_t>(packed, out);
    default:
      return convert<float>(packed, out);
  }
}

void checkComponents(const GltfFile& file, const Packed& packed, int expected, int accessor,
                     const std::string& where) {
  if (packed.components != expected)
    file.fail("{}: accessors[{}] has {} components; it must have {}", where, accessor,
              packed.components, expected);
}

}  // namespace

template <int N>
std::vector<glm::vec<N, float>> readVectors(GltfFile& file, int accessor,
                                            const std::string& where) {
  const Packed packed = readPacked(file, accessor, where);
  checkComponents(file, packed, N, accessor, where);
  std::vector<glm::vec<N, float>> vectors(packed.count);
  toFloats(packed, &vectors[0][0]);
  return vectors;
}

template std::vector<glm::vec<1, float>> readVectors<1>(GltfFile&, int, const std::string&);
template std::vector<vec2> readVectors<2>(GltfFile&, int, const std::string&);
template std::vector<vec3> readVectors<3>(GltfFile&, int, const std::string&);
template std::vector<vec4> readVectors<4>(GltfFile&, int, const std::string&);

std::vector<uint32_t> readIndices(GltfFile& file, int accessor, size_t vertexCount,
                                  const std::string& where) {
  const Packed packed = readPacked(file, accessor, where);
  checkComponents(file, packed, 1, accessor, where);
  if (!isUnsigned(packed.componentType))
    file.fail("{}: accessors[{}] has componentType {}; indices must be unsigned integers", where,
              accessor, packed.componentType);
  const size_t size = componentSize(packed.componentType);
  const uint32_t restart = uint32_t((uint64_t(1) << (8 * size)) - 1);
  std::vector<uint32_t> indices(packed.count);
  for (size_t i = 0; i < indices.size(); ++i) {
    const uint32_t index = loadUnsigned(packed.bytes.data() + i * size, packed.componentType);
    if (index == restart)
      file.fail("{}: index {} is the primitive-restart value, which glTF forbids", where, index);
    if (index >= vertexCount)
      file.fail("{}: index {} out of range ({} vertices)", where, index, vertexCount);
    indices[i] = index;
  }
  return indices;
}

std::vector<glm::dmat4> readMatrices(GltfFile& file, int accessor, const std::string& where) {
  const Packed packed = readPacked(file, accessor, where);
  checkComponents(file, packed, 16, accessor, where);
  std::vector<glm::mat4> floats(packed.count);
  toFloats(packed, &floats[0][0][0]);
  return {floats.begin(), floats.end()};
}

std::vector<vec4> readColors(GltfFile& file, int accessor, const std::string& where) {
  const tinygltf::Accessor& a = file.at(file.model.accessors, accessor, "accessors", where);
  if (a.type != TINYGLTF_TYPE_VEC3) return readVectors<4>(file, accessor, where);
  const std::vector<vec3> rgb = readVectors<3>(file, accessor, where);
  std::vector<vec4> rgba(rgb.size());
  for (size_t i = 0; i < rgb.size(); ++i) rgba[i] = vec4(rgb[i], 1);
  return rgba;
}

}  // namespace chromeball
