// SPDX-License-Identifier: Apache-2.0
// The scene as the tracer wants it: meshes, where they stand, what they are made of.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/material.h"

namespace chromeball {

using Triangle = glm::uvec3;  // vertex indices, counter-clockwise from the front

// The geometry of a glTF primitive: an indexed triangle soup.
// Vertex arrays are empty or as long as `positions`. Normals are unit; tangents carry the sign of
// the bitangent in w (bitangent = w * cross(normal, tangent)).
struct Mesh {
  std::vector<Triangle> triangles;
  std::vector<vec3> positions;
  std::vector<vec3> normals;           // empty: flat, the triangle's own normal
  std::vector<vec4> tangents;          // filled only where a material has a normal map
  std::vector<vec4> colors;            // linear RGBA; empty: white
  std::vector<std::vector<vec2>> uvs;  // by UV set; only those a material reads are kept
};

// Affine: row r of the matrix is (linear[0][r], linear[1][r], linear[2][r], translation[r]).
struct Transform {
  glm::mat3 linear{1};
  vec3 translation{0};

  vec3 point(const vec3& p) const { return linear * p + translation; }
};

// A mesh standing somewhere, made of something. A mesh with one instance is stored in world space
// and has no transform here; one with several serves materials that need the same of its vertices.
struct Instance {
  int mesh = 0;
  int material = 0;
  int node = 0;  // index into Scene::nodeNames
  std::optional<Transform> toWorld;

  vec3 point(const vec3& p) const { return toWorld ? toWorld->point(p) : p; }
};

struct Scene {
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<Material> materials;  // never empty where there is a mesh
  std::vector<Texture> textures;
  std::vector<std::unique_ptr<TexelGrid>> grids;  // owns the texels that textures point to
  std::vector<Camera> cameras;
  std::vector<PunctualLight> lights;
  std::optional<Image> environment;  // the model's own light probe: lat-long, fit to render with
  std::vector<std::string> nodeNames;
  std::vector<std::string> notes;  // "FILE: ...": what a viewer may like to know
  std::vector<int> nodeParents;    // by node, -1 for none; or empty, where no node has one
  std::vector<std::string> files;  // that it comes from: models, their buffers and images

  size_t triangleCount() const;  // instanced triangles count once per instance
  size_t byteCount() const;      // of geometry and texels, for the statistics
  size_t texelByteCount() const;
};

struct Bounds {
  vec3 min{INFINITY}, max{-INFINITY};
  bool empty() const { return !(min.x <= max.x); }
};
Bounds bounds(const Scene& scene);

// Puts `other` into `scene` (a scene file may name several models).
void append(Scene& scene, Scene&& other);

}  // namespace chromeball
