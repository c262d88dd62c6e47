// SPDX-License-Identifier: Apache-2.0
#include "gltf_writer.h"

#include <unistd.h>

#include <fstream>

#include "base/error.h"
#include "scene/gltf/load_gltf.h"

namespace chromeball {

const std::vector<uint8_t> kPng = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
    0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00, 0x00, 0x7b,
    0x40, 0xe8, 0xdd, 0x00, 0x00, 0x00, 0x0f, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0xf8,
    0xcf, 0xc0, 0xc0, 0xd0, 0xf0, 0x1f, 0x00, 0x08, 0x00, 0x02, 0x7f, 0x9c, 0x45, 0x40, 0x4e,
    0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

GltfWriter::GltfWriter() {
  static int count = 0;
  folder_ = std::filesystem::temp_directory_path() /
            ("chromeball-gltf-" + std::to_string(getpid()) + "-" + std::to_string(count++));
  std::filesystem::create_directories(folder_);
}

GltfWriter::~GltfWriter() { std::filesystem::remove_all(folder_); }

int GltfWriter::bytesView(const void* data, size_t size, int stride) {
  bytes_.resize((bytes_.size() + 3) / 4 * 4);
  const size_t offset = bytes_.size();
  const auto* from = static_cast<const uint8_t*>(data);
  bytes_.insert(bytes_.end(), from, from + size);
  nlohmann::json v = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}};
  if (stride) v["byteStride"] = stride;
  return add("bufferViews", v);
}

int GltfWriter::accessor(int view, ComponentType component, const std::string& type, size_t count,
                         size_t offset, bool normalized) {
  nlohmann::json a = {{"componentType", component}, {"type", type}, {"count", count}};
  if (view >= 0) a["bufferView"] = view;
  if (offset) a["byteOffset"] = offset;
  if (normalized) a["normalized"] = true;
  return add("accessors", a);
}

int GltfWriter::vec3s(const std::vector<float>& f) {
  return accessor(view(f), kFloat, "VEC3", f.size() / 3);
}

int GltfWriter::vec2s(const std::vector<float>& f) {
  return accessor(view(f), kFloat, "VEC2", f.size() / 2);
}

int GltfWriter::indices(const std::vector<uint16_t>& i) {
  return accessor(view(i), kUShort, "SCALAR", i.size());
}

int GltfWriter::add(const std::string& array, const nlohmann::json& element) {
  root[array].push_back(element);
  return int(root[array].size()) - 1;
}

int GltfWriter::mesh(const nlohmann::json& primitive) {
  return add("meshes", {{"primitives", nlohmann::json::array({primitive})}});
}

void GltfWriter::write(const std::string& name, const std::vector<uint8_t>& bytes) const {
  std::ofstream(folder_ / name, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

std::string GltfWriter::save() {
  if (!bytes_.empty()) {
    root["buffers"] = {{{"byteLength", bytes_.size()}, {"uri", "data.bin"}}};
    write("data.bin", bytes_);
  }
  std::ofstream(folder_ / "model.gltf") << root;
  return (folder_ / "model.gltf").string();
}

Scene GltfWriter::load(const Transform& placement) {
  warnings.clear();
  return loadGltf(save(), placement, [this](const std::string& w) { warnings.push_back(w); });
}

std::string GltfWriter::errorMessage() {
  const std::string path = save();
  try {
    loadGltf(path, {}, nullptr);
  } catch (const InputError& e) {
    const std::string message = e.what();
    return message.starts_with(path + ": ") ? message.substr(path.size() + 2) : message;
  }
  return "";
}

int addTriangle(GltfWriter& w, const nlohmann::json& primitive, const nlohmann::json& node) {
  nlohmann::json p = {{"attributes", {{"POSITION", w.vec3s({0, 0, 0, 1, 0, 0, 0, 1, 0})}}}};
  if (!primitive.is_null()) p.merge_patch(primitive);
  nlohmann::json n = {{"mesh", w.mesh(p)}};
  if (!node.is_null()) n.merge_patch(node);
  return w.add("nodes", n);
}

}  // namespace chromeball
