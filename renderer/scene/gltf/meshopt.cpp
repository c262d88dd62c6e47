// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/mesh.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>

#include "scene/gltf/gltf_json.h"

namespace chromeball {
namespace {

using tinygltf::Value;

// KHR_meshopt_compression is EXT_meshopt_compression with an additional version of the vertex
// stream and a filter, which are not supported.
constexpr std::array kExtensions = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

// The extension's description of a buffer view.
struct Compressed {
  std::span<const uint8_t> bytes;
  size_t count, stride;
  std::string mode, filter;
};

size_t sizeMember(const GltfFile& file, const Value& object, const char* key, bool required,
                  const std::string& where) {
  const Value& v = memberOf(object, key);
  if (!required && !v.IsNumber()) return 0;
  const double number = v.IsNumber() ? v.GetNumberAsDouble() : -1;
  if (!(number >= 0 && number < 4294967296.0) || number != std::floor(number))
    file.fail("{}.{}: is missing or not a whole number", where, key);
  return size_t(number);
}

Compressed readExtension(const GltfFile& file, const Value& extension, const std::string& where) {
  Compressed c;
  c.bytes = file.bytes(int(sizeMember(file, extension, "buffer", true, where)),
                       sizeMember(file, extension, "byteOffset", false, where),
                       sizeMember(file, extension, "byteLength", true, where), where);
  c.count = sizeMember(file, extension, "count", true, where);
  c.stride = sizeMember(file, extension, "byteStride", true, where);
  c.mode = textMember(extension, "mode");
  c.filter = textMember(extension, "filter", "NONE");
  return c;
}

// Checks the rules of the extension, which the decoder assumes to hold.
void check(const GltfFile& file, const Compressed& c, const std::string& where) {
  const bool isIndex = c.mode == "TRIANGLES" || c.mode == "INDICES";
  if (!isIndex && c.mode != "ATTRIBUTES")
    file.fail("{}.mode: \"{}\" is not ATTRIBUTES, TRIANGLES or INDICES", where, c.mode);
  const bool strideFits = isIndex ? c.stride == 2 || c.stride == 4
                                  : c.stride > 0 && c.stride <= 256 && c.stride % 4 == 0;
  if (!strideFits) file.fail("{}.byteStride: {} is invalid for {}", where, c.stride, c.mode);
  if (c.count == 0 || (c.mode == "TRIANGLES" && c.count % 3 != 0))
    file.fail("{}.count: {} is invalid for {}", where, c.count, c.mode);
  constexpr uint8_t kVertexStream = 0xa0;  // version 0
  if (c.mode == "ATTRIBUTES" && !c.bytes.empty() && (c.bytes[0] & 0xf0) == kVertexStream &&
      c.bytes[0] != kVertexStream)
    file.fail("{}: version {} of the vertex stream is not supported; compress the model with {}",
              where, c.bytes[0] & 0x0f, kExtensions[0]);
  if (c.filter == "COLOR")
    file.fail("{}.filter: COLOR is not supported; compress the model with {}", where,
              kExtensions[0]);
  const bool filterFits =
      c.filter == "NONE" ||
      (!isIndex && ((c.filter == "OCTAHEDRAL" && (c.stride == 4 || c.stride == 8)) ||
                    (c.filter == "QUATERNION" && c.stride == 8) || c.filter == "EXPONENTIAL"));
  if (!filterFits)
    file.fail("{}.filter: \"{}\" is invalid for {} with a stride of {} bytes", where, c.filter,
              c.mode, c.stride);
}

Bytes decode(const GltfFile& file, const Compressed& c, const std::string& where) {
  Bytes decoded(c.count * c.stride);
  using Decoder = int (*)(void*, size_t, size_t, const unsigned char*, size_t);
  const Decoder decoder = c.mode == "TRIANGLES" ? Decoder(meshopt_decodeIndexBuffer)
                          : c.mode == "INDICES" ? Decoder(meshopt_decodeIndexSequence)
                                                : Decoder(meshopt_decodeVertexBuffer);
  if (decoder(decoded.data(), c.count, c.stride, c.bytes.data(), c.bytes.size()) != 0)
    file.fail("{}: damaged data", where);
  if (c.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(decoded.data(), c.count, c.stride);
  if (c.filter == "QUATERNION") meshopt_decodeFilterQuat(decoded.data(), c.count, c.stride);
  if (c.filter == "EXPONENTIAL") meshopt_decodeFilterExp(decoded.data(), c.count, c.stride);
  return decoded;
}

}  // namespace

void decodeMeshopt(GltfFile& file) {
  const size_t viewCount = file.model.bufferViews.size();
  for (size_t i = 0; i < viewCount; ++i) {
    const auto& extensions = file.model.bufferViews[i].extensions;
    const auto name = std::ranges::find_if(
        kExtensions, [&](const char* extension) { return extensions.contains(extension); });
    if (name == kExtensions.end()) continue;
    const std::string where = fmt::format("bufferViews[{}].{}", i, *name);
    const Compressed compressed = readExtension(file, extensions.at(*name), where);
    check(file, compressed, where);
    file.spend(compressed.count * compressed.stride);
    const int decoded = file.addView(decode(file, compressed, where));
    tinygltf::BufferView& view = file.model.bufferViews[i];
    const size_t stride = view.byteStride;
    view = file.model.bufferViews[size_t(decoded)];
    view.byteStride = stride;
  }
}

}  // namespace chromeball
