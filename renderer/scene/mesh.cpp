// SPDX-License-Identifier: Apache-2.0
#include "scene/mesh.h"

namespace chromeball {

Mesh::Mesh() = default;
Mesh::Mesh(const Mesh&) = default;
Mesh::Mesh(Mesh&&) noexcept = default;
Mesh& Mesh::operator=(const Mesh&) = default;
Mesh& Mesh::operator=(Mesh&&) noexcept = default;
Mesh::~Mesh() = default;
bool Mesh::operator==(const Mesh&) const = default;

Mesh& MeshList::edit(size_t i) {
  const auto own = std::make_shared<Mesh>(*meshes_.at(i));
  meshes_[i] = own;
  return *own;
}

void MeshList::push_back(Mesh mesh) {
  meshes_.push_back(std::make_shared<const Mesh>(std::move(mesh)));
}

void MeshList::append(MeshList other) {
  meshes_.insert(meshes_.end(), other.meshes_.begin(), other.meshes_.end());
}

}  // namespace chromeball
