// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/mesh.h"

#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#include <fmt/format.h>

#include <cstring>
#include <new>

#include "scene/gltf/accessor.h"
#include "scene/gltf/gltf_json.h"

namespace chromeball {
namespace {

using tinygltf::Value;

constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

// More than any encoder can achieve; a file that claims more is damaged.
constexpr uint64_t kMaxTrianglesPerByte = 64;
constexpr uint64_t kBytesPerTriangle = 64;  // of working memory, a lower bound

draco::DecoderBuffer bufferOf(std::span<const uint8_t> bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return buffer;
}

// The number of triangles that the header claims, so that it can be checked before the library
// allocates memory (Draco bitstream specification 2.2, "Header" and "Connectivity decoder").
uint32_t claimedTriangles(const GltfFile& file, std::span<const uint8_t> bytes,
                          const std::string& where) {
  draco::DecoderBuffer buffer = bufferOf(bytes);
  draco::DracoHeader header;
  if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok())
    file.fail("{}: is not Draco data", where);
  if (header.version_major != 2 || header.version_minor != 2 ||
      header.encoder_type != draco::TRIANGULAR_MESH)
    file.fail("{}: is not a mesh of Draco bitstream 2.2, which the extension requires", where);
  buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(2, 2));

  bool read = true;
  if (header.flags & METADATA_FLAG_MASK) {
    draco::GeometryMetadata ignored;
    read = draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &ignored);
  }
  if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
    uint8_t traversal = 0;
    uint32_t vertices = 0;
    read = read && buffer.Decode(&traversal) && draco::DecodeVarint(&vertices, &buffer);
  }
  uint32_t triangles = 0;
  if (!read || !draco::DecodeVarint(&triangles, &buffer))
    file.fail("{}: damaged data: the header is truncated", where);
  return triangles;
}

std::unique_ptr<draco::Mesh> decodeMesh(const GltfFile& file, std::span<const uint8_t> bytes,
                                        const std::string& where) {
  draco::DecoderBuffer buffer = bufferOf(bytes);
  try {
    auto mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (mesh.ok() && mesh.value()->num_faces() > 0) return std::move(mesh).value();
    file.fail("{}: damaged data: {}", where,
              mesh.ok() ? "no triangles" : mesh.status().error_msg());
  } catch (const std::bad_alloc&) {
    file.fail("{}: damaged data: it needs more memory than there is", where);
  }
}

template <class T>
bool copyAttribute(const draco::Mesh& mesh, const draco::PointAttribute& attribute, int components,
                   Bytes& bytes) {
  bytes.resize(size_t(mesh.num_points()) * size_t(components) * sizeof(T));
  std::vector<T> element(static_cast<size_t>(components));
  for (uint32_t i = 0; i < mesh.num_points(); ++i) {
    const auto index = attribute.mapped_index(draco::PointIndex(i));
    if (index.value() >= attribute.size() ||
        !attribute.ConvertValue<T>(index, int8_t(components), element.data()))
      return false;
    std::memcpy(&bytes[i * element.size() * sizeof(T)], element.data(), element.size() * sizeof(T));
  }
  return true;
}

// The elements of the attribute, tightly packed, converted to the type of the accessor.
Bytes attributeBytes(const GltfFile& file, const draco::Mesh& mesh,
                     const draco::PointAttribute& attribute, const tinygltf::Accessor& accessor,
                     const std::string& where) {
  const int components = tinygltf::GetNumComponentsInType(uint32_t(accessor.type));
  if (components < 1 || components > 4)
    file.fail("{}: the type of its accessor is not allowed for vertex attributes", where);
  Bytes bytes;
  const bool fits = withComponentType(accessor.componentType, [&](auto zero) {
    return copyAttribute<decltype(zero)>(mesh, attribute, components, bytes);
  });
  if (!fits) file.fail("{}: damaged data: values do not fit the type of the accessor", where);
  return bytes;
}

// Three 32-bit indices for each triangle.
Bytes indexBytes(const draco::Mesh& mesh) {
  std::vector<uint32_t> indices;
  indices.reserve(size_t(mesh.num_faces()) * 3);
  for (uint32_t i = 0; i < mesh.num_faces(); ++i)
    for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(i)))
      indices.push_back(corner.value());
  Bytes bytes(indices.size() * sizeof(uint32_t));
  std::memcpy(bytes.data(), indices.data(), bytes.size());
  return bytes;
}

class DracoReader {
 public:
  explicit DracoReader(GltfFile& file) : file_(file) {}

  void decode(tinygltf::Primitive& primitive, const Value& extension, const std::string& where) {
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES)
      file_.fail("{}: mode {} is not supported; only triangles (4) are", where, primitive.mode);
    const Value& attributes = memberOf(extension, "attributes");
    if (!memberOf(extension, "bufferView").IsInt() || !attributes.IsObject())
      file_.fail("{}: has no bufferView or no attributes", where);
    const int view = intMember(extension, "bufferView");
    const draco::Mesh& mesh = meshOf(view, ownCount(primitive.indices, where + ".indices"), where);
    if (tinygltf::Accessor* indices =
            toFill(primitive.indices, {view, kIndices}, where + ".indices")) {
      indices->componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
      setData(*indices, size_t(mesh.num_faces()) * 3, indexBytes(mesh));
    }
    for (const std::string& name : attributes.Keys()) {
      const auto user = primitive.attributes.find(name);
      if (user == primitive.attributes.end()) continue;
      const std::string at = where + ".attributes." + name;
      const int id = intMember(attributes, name);
      tinygltf::Accessor* target = toFill(user->second, {view, id}, at);
      if (!target) continue;
      const draco::PointAttribute* attribute =
          id >= 0 ? mesh.GetAttributeByUniqueId(uint32_t(id)) : nullptr;
      if (!attribute) file_.fail("{}: the compressed mesh has no such attribute", at);
      file_.spend(uint64_t(mesh.num_points()) * 16);
      setData(*target, mesh.num_points(), attributeBytes(file_, mesh, *attribute, *target, at));
    }
  }

  // Whether the file has the vertices in compressed form only.
  bool isNeededFor(const tinygltf::Primitive& primitive) const {
    const auto positions = primitive.attributes.find("POSITION");
    return positions != primitive.attributes.end() && positions->second >= 0 &&
           size_t(positions->second) < file_.model.accessors.size() &&
           (filled_.contains(positions->second) ||
            file_.model.accessors[size_t(positions->second)].bufferView < 0);
  }

 private:
  static constexpr int kIndices = -2;
  struct Source {
    int view, attribute;  // the attribute's id; kIndices: the indices
    bool operator==(const Source&) const = default;
  };
  struct Filled {
    Source source;
    size_t count;  // that the file states
  };

  tinygltf::Accessor& accessor(int index, const std::string& where) {
    return file_.at(file_.model.accessors, index, "accessors", where);
  }

  size_t ownCount(int index, const std::string& where) {
    const auto filled = filled_.find(index);
    return filled != filled_.end() ? filled->second.count : accessor(index, where).count;
  }

  // The accessor that takes data from `source`: the one of the index, or a copy of it, with a new
  // index, if that has data of another primitive's mesh. Null if nothing is to be decoded.
  tinygltf::Accessor* toFill(int& index, const Source& source, const std::string& where) {
    tinygltf::Accessor* found = &accessor(index, where);
    const auto earlier = filled_.find(index);
    if (earlier == filled_.end()) {
      if (found->bufferView >= 0) return nullptr;
    } else {
      if (earlier->second.source == source) return nullptr;
      tinygltf::Accessor copy = *found;
      copy.count = earlier->second.count;
      file_.model.accessors.push_back(std::move(copy));
      index = int(file_.model.accessors.size() - 1);
      found = &file_.model.accessors.back();
    }
    filled_[index] = {source, found->count};
    return found;
  }

  void setData(tinygltf::Accessor& target, size_t count, Bytes bytes) {
    target.bufferView = file_.addView(std::move(bytes));
    target.byteOffset = 0;
    target.count = count;
  }

  // The decoded mesh of a buffer view. Throws if it has more than `indexCount` indices.
  const draco::Mesh& meshOf(int bufferView, size_t indexCount, const std::string& where) {
    std::unique_ptr<draco::Mesh>& mesh = meshes_[bufferView];
    if (mesh) return *mesh;
    const std::span<const uint8_t> bytes = file_.view(bufferView, where);
    const uint64_t triangles = claimedTriangles(file_, bytes, where);
    if (3 * triangles > indexCount || triangles > kMaxTrianglesPerByte * bytes.size())
      file_.fail("{}: damaged data: claims {} triangles in {} bytes; the accessor has {} indices",
                 where, triangles, bytes.size(), indexCount);
    file_.spend(triangles * kBytesPerTriangle);
    mesh = decodeMesh(file_, bytes, where);
    return *mesh;
  }

  GltfFile& file_;
  std::map<int, std::unique_ptr<draco::Mesh>> meshes_;  // by buffer view
  std::map<int, Filled> filled_;                        // by accessor
};

}  // namespace

void decodeDraco(GltfFile& file) {
  DracoReader reader(file);
  for (size_t m = 0; m < file.model.meshes.size(); ++m) {
    auto& primitives = file.model.meshes[m].primitives;
    for (size_t p = 0; p < primitives.size(); ++p) {
      const auto found = primitives[p].extensions.find(kDracoExtension);
      if (found == primitives[p].extensions.end() || !reader.isNeededFor(primitives[p])) continue;
      reader.decode(primitives[p], found->second,
                    fmt::format("meshes[{}].primitives[{}].{}", m, p, kDracoExtension));
    }
  }
}

}  // namespace chromeball
