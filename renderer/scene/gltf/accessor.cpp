// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <limits>

#include "base/memory.h"
#include "base/parallel.h"

namespace chromeball {
namespace {

// The elements of an accessor, `stride` bytes apart: in the file's buffer, or in a copy if some are
// substituted.
struct Elements {
  size_t count = 0;
  int components = 0, componentType = 0;
  bool normalized = false;
  const uint8_t* first = nullptr;
  size_t stride = 0;
  Bytes copy;

  bool areTight(size_t componentBytes) const {
    return stride == componentBytes * size_t(components);
  }
};

// An accessor without a buffer view is all zeros, so the length of the file does not limit its
// size.
constexpr size_t kMaxElementsWithoutView = size_t(1) << 24;

// 0 for types that glTF 2.0 does not have, of which tinygltf knows two.
size_t componentSize(int type) {
  if (type == TINYGLTF_COMPONENT_TYPE_INT || type == TINYGLTF_COMPONENT_TYPE_DOUBLE) return 0;
  return size_t(std::max(tinygltf::GetComponentSizeInBytes(uint32_t(type)), 0));
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
                      Elements& elements, const std::string& where) {
  const auto& sparse = a.sparse;
  if (sparse.count < 1 || size_t(sparse.count) > elements.count || sparse.indices.byteOffset < 0 ||
      sparse.values.byteOffset < 0 || !isUnsigned(sparse.indices.componentType))
    file.fail("{}: invalid sparse substitution", where);
  const size_t count = size_t(sparse.count);
  const size_t indexSize = componentSize(sparse.indices.componentType);
  const auto indices = file.view(sparse.indices.bufferView, where + ".sparse.indices");
  const auto values = file.view(sparse.values.bufferView, where + ".sparse.values");
  const size_t indexOffset = size_t(sparse.indices.byteOffset);
  const size_t elementOffset = size_t(sparse.values.byteOffset);
  checkFit(file, indices.size(), indexOffset, indexSize, indexSize, count,
           where + ".sparse.indices");
  checkFit(file, values.size(), elementOffset, elementSize, elementSize, count,
           where + ".sparse.values");
  for (size_t i = 0; i < count; ++i) {
    const size_t index =
        loadUnsigned(indices.data() + indexOffset + i * indexSize, sparse.indices.componentType);
    if (index >= elements.count)
      file.fail("{}.sparse: index {} out of range ({} elements)", where, index, elements.count);
    std::memcpy(elements.copy.data() + index * elementSize,
                values.data() + elementOffset + i * elementSize, elementSize);
  }
}

void copyElements(size_t elementSize, Elements& elements) {
  elements.copy.resize(elements.count * elementSize);
  if (elements.first)
    for (size_t i = 0; i < elements.count; ++i)
      std::memcpy(elements.copy.data() + i * elementSize, elements.first + i * elements.stride,
                  elementSize);
  elements.first = elements.copy.data();
  elements.stride = elementSize;
}

// Throws unless the elements have so many components.
Elements readElements(GltfFile& file, int accessor, int components, const std::string& user) {
  const tinygltf::Accessor& a = file.at(file.model.accessors, accessor, "accessors", user);
  const std::string where = fmt::format("{}: accessors[{}]", user, accessor);
  Elements elements;
  elements.count = a.count;
  elements.componentType = a.componentType;
  elements.normalized = a.normalized;
  elements.components = tinygltf::GetNumComponentsInType(uint32_t(a.type));
  const size_t size = componentSize(a.componentType);
  if (size == 0 || elements.components < 1)
    file.fail("{}: componentType {} is not a glTF 2.0 type", where, a.componentType);
  if (a.count < 1) file.fail("{}: has no elements", where);

  const size_t elementSize = size * size_t(elements.components);
  if (a.bufferView < 0) {
    if (a.count > kMaxElementsWithoutView)
      file.fail("{}: {} elements without a buffer view; the limit is {}", where, a.count,
                kMaxElementsWithoutView);
  } else {
    const std::span<const uint8_t> view = file.view(a.bufferView, where);
    const size_t byteStride = file.model.bufferViews[size_t(a.bufferView)].byteStride;
    elements.stride = byteStride ? byteStride : elementSize;
    if (elements.stride < elementSize)
      file.fail("{}: byteStride {} is less than the {} bytes of an element", where, elements.stride,
                elementSize);
    checkFit(file, view.size(), a.byteOffset, elements.stride, elementSize, a.count, where);
    elements.first = view.data() + a.byteOffset;
  }
  file.spend(a.count * elementSize);
  if (!elements.first || a.sparse.isSparse) copyElements(elementSize, elements);
  if (a.sparse.isSparse) substituteSparse(file, a, elementSize, elements, where);
  if (elements.components != components)
    file.fail("{} has {} components; it must have {}", where, elements.components, components);
  return elements;
}

// Signed normalised integers (glTF 2.0, 3.6.2.2): f = max(c / 127, -1), so two codes give -1.
template <class T>
void convert(const Elements& elements, float* out) {
  const float scale = elements.normalized && std::is_integral_v<T>
                          ? 1 / float(std::numeric_limits<T>::max())
                          : 1.0f;
  const size_t components = size_t(elements.components);
  forRanges(elements.count, [&](size_t begin, size_t end) {
    if (std::is_same_v<T, float> && elements.areTight(sizeof(T))) {
      std::memcpy(out + begin * components, elements.first + begin * elements.stride,
                  (end - begin) * elements.stride);
      return;
    }
    for (size_t i = begin; i < end; ++i)
      for (size_t k = 0; k < components; ++k) {
        const float x =
            float(load<T>(elements.first + i * elements.stride + k * sizeof(T))) * scale;
        const bool isBelow =
            elements.normalized && std::is_signed_v<T> && std::is_integral_v<T> && x < -1;
        out[i * components + k] = isBelow ? -1 : x;
      }
  });
}

void toFloats(const Elements& elements, float* out) {
  withComponentType(elements.componentType,
                    [&](auto zero) { convert<decltype(zero)>(elements, out); });
}

Elements readIndexElements(GltfFile& file, int accessor, const std::string& where) {
  Elements elements = readElements(file, accessor, 1, where);
  if (!isUnsigned(elements.componentType))
    file.fail("{}: accessors[{}] has componentType {}; indices must be unsigned integers", where,
              accessor, elements.componentType);
  return elements;
}

// Throws for the first invalid index; there must be one.
[[noreturn]] void failAtIndex(const GltfFile& file, std::span<const uint32_t> indices,
                              uint32_t restart, size_t vertexCount, const std::string& where) {
  const uint32_t index = *std::find_if(
      indices.begin(), indices.end(), [&](uint32_t i) { return i == restart || i >= vertexCount; });
  if (index == restart)
    file.fail("{}: index {} is the primitive-restart value, which glTF forbids", where, index);
  file.fail("{}: index {} out of range ({} vertices)", where, index, vertexCount);
}

void copyIndices(const GltfFile& file, const Elements& elements, size_t vertexCount,
                 const std::string& where, uint32_t* out) {
  const size_t size = componentSize(elements.componentType);
  const uint32_t restart = uint32_t((uint64_t(1) << (8 * size)) - 1);
  std::atomic<bool> isValid = true;
  forRanges(elements.count, [&](size_t begin, size_t end) {
    uint32_t max = 0;
    for (size_t i = begin; i < end; ++i) {
      out[i] = loadUnsigned(elements.first + i * elements.stride, elements.componentType);
      max = std::max(max, out[i]);
    }
    if (max >= vertexCount || max == restart) isValid = false;
  });
  if (!isValid) failAtIndex(file, {out, elements.count}, restart, vertexCount, where);
}

}  // namespace

template <int N>
std::vector<glm::vec<N, float>> readVectors(GltfFile& file, int accessor,
                                            const std::string& where) {
  const Elements elements = readElements(file, accessor, N, where);
  auto vectors = longArray<glm::vec<N, float>>(elements.count);
  toFloats(elements, &vectors[0][0]);
  return vectors;
}

template std::vector<glm::vec<1, float>> readVectors<1>(GltfFile&, int, const std::string&);
template std::vector<vec2> readVectors<2>(GltfFile&, int, const std::string&);
template std::vector<vec3> readVectors<3>(GltfFile&, int, const std::string&);
template std::vector<vec4> readVectors<4>(GltfFile&, int, const std::string&);

std::vector<uint32_t> readIndices(GltfFile& file, int accessor, size_t vertexCount,
                                  const std::string& where) {
  const Elements elements = readIndexElements(file, accessor, where);
  auto indices = longArray<uint32_t>(elements.count);
  copyIndices(file, elements, vertexCount, where, indices.data());
  return indices;
}

std::vector<Triangle> readTriangles(GltfFile& file, int accessor, size_t vertexCount,
                                    const std::string& where) {
  const Elements elements = readIndexElements(file, accessor, where);
  auto triangles = longArray<Triangle>((elements.count + 2) / 3);
  copyIndices(file, elements, vertexCount, where, &triangles[0].x);
  triangles.resize(elements.count / 3);
  return triangles;
}

std::vector<glm::dmat4> readMatrices(GltfFile& file, int accessor, const std::string& where) {
  const Elements elements = readElements(file, accessor, 16, where);
  std::vector<glm::mat4> floats(elements.count);
  toFloats(elements, &floats[0][0][0]);
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
