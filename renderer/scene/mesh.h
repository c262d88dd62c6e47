// SPDX-License-Identifier: Apache-2.0
// Indexed triangles, and lists of them that scenes share.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "math/vec.h"

namespace chromeball {

using Triangle = glm::uvec3;  // vertex indices, counter-clockwise from the front

// The geometry of a glTF primitive.
// Vertex arrays are empty or as long as `positions`. Normals are unit; tangents carry the sign of
// the bitangent in w (bitangent = w * cross(normal, tangent)). Made, copied and destroyed in
// mesh.cpp, to be compiled once.
struct Mesh {
  Mesh();
  Mesh(const Mesh&);
  Mesh(Mesh&&) noexcept;
  Mesh& operator=(const Mesh&);
  Mesh& operator=(Mesh&&) noexcept;
  ~Mesh();

  std::vector<Triangle> triangles;
  std::vector<vec3> positions;
  std::vector<vec3> normals;           // empty: flat, the triangle's own normal
  std::vector<vec4> tangents;          // filled only where a material has a normal map
  std::vector<vec4> colors;            // linear RGBA; empty: white
  std::vector<std::vector<vec2>> uvs;  // by UV set; filled only for sets that the material uses

  bool operator==(const Mesh&) const;
};

// Copies of a list share its meshes.
class MeshList {
 public:
  using Shared = std::shared_ptr<const Mesh>;

  MeshList() = default;
  explicit MeshList(Mesh mesh) { push_back(std::move(mesh)); }

  size_t size() const { return meshes_.size(); }
  bool empty() const { return meshes_.empty(); }
  const Mesh& operator[](size_t i) const { return *meshes_[i]; }
  const Mesh& at(size_t i) const { return *meshes_.at(i); }
  const Mesh& back() const { return *meshes_.back(); }
  const Shared& shared(size_t i) const { return meshes_[i]; }

  // The mesh, to be changed; another list that shares it keeps it as it was.
  Mesh& edit(size_t i);

  void share(size_t i, const Shared& mesh) { meshes_[i] = mesh; }

  void push_back(Mesh mesh);
  void push_back(Shared mesh) { meshes_.push_back(std::move(mesh)); }
  void pop_back() { meshes_.pop_back(); }
  void append(MeshList other);

  class Iterator {
   public:
    explicit Iterator(const Shared* at) : at_(at) {}
    const Mesh& operator*() const { return **at_; }
    Iterator& operator++() { return ++at_, *this; }
    bool operator==(const Iterator&) const = default;

   private:
    const Shared* at_;
  };
  Iterator begin() const { return Iterator(meshes_.data()); }
  Iterator end() const { return Iterator(meshes_.data() + meshes_.size()); }

  bool operator==(const MeshList& other) const {
    return std::ranges::equal(meshes_, other.meshes_,
                              [](const Shared& a, const Shared& b) { return a == b || *a == *b; });
  }

 private:
  std::vector<Shared> meshes_;
};

// Repairs and completes the vertex arrays of a mesh.

bool areFinite(const std::vector<vec3>& points);

// Drops the vertices that no triangle uses.
void dropUnusedVertices(Mesh& mesh);

// Gives every triangle its own three vertices, with the triangle's normal.
void makeFlat(Mesh& mesh);

// Normalises the normals. One that is zero or not finite becomes the area-weighted mean of the
// normals of the triangles around its vertex. Does nothing if the mesh has no normals.
void repairNormals(Mesh& mesh);

// Normalises the tangents and makes w a sign. One that is zero or not finite becomes an arbitrary
// direction perpendicular to the normal. Precondition: the mesh has normals.
void repairTangents(Mesh& mesh);

// Computes tangents from the UV coordinates of the normal map, one for each vertex. Splits vertices
// whose triangles turn opposite ways in UV space; all poses of a mesh are split alike.
// Precondition: the mesh has normals.
void computeTangents(Mesh& mesh, const std::vector<vec2>& uv);

// Applies an affine transform, which may flatten the mesh. Normals are transformed by
// normalMatrix() (motion.h). If the transform mirrors, the winding of the triangles and the
// sign of the tangents are inverted, so that front faces stay front faces.
void transformMesh(Mesh& mesh, const glm::dmat4& transform);

}  // namespace chromeball
