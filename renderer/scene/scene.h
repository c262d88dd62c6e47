// SPDX-License-Identifier: Apache-2.0
// A scene ready to trace: meshes, their instances and materials, textures, cameras and lights.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/material.h"
#include "scene/mesh.h"
#include "scene/motion.h"

namespace chromeball {

// A mesh with a transform and a material. A mesh with a single instance is stored in world space
// and has no transform here. Instances of one mesh may differ in material if the materials need the
// same vertex arrays.
struct Instance {
  int mesh = 0;
  int material = 0;
  int node = 0;  // index into Scene::nodeNames
  std::optional<Transform> toWorld;
  glm::dvec3 translationRest{0};  // that float rounds off of toWorld's, until moveOrigin()
  bool moves = false;  // at other times of the animation it may have another place or shape
  // Its motion while the shutter is open, from this place and shape; null: it stands still.
  std::shared_ptr<const InstanceMotion> motion = nullptr;

  vec3 point(const vec3& p) const { return toWorld ? toWorld->point(p) : p; }
  bool mirrors() const { return toWorld && glm::determinant(toWorld->linear) < 0; }
  bool operator==(const Instance&) const = default;
};

// Made, copied and destroyed in scene.cpp: else each file with a scene would compile the same for
// all its parts, for a second or two.
struct Scene {
  Scene();
  Scene(const Scene&);
  Scene(Scene&&) noexcept;
  Scene& operator=(const Scene&);
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  MeshList meshes;
  std::vector<Instance> instances;
  std::vector<Material> materials;  // not empty if there is a mesh
  std::vector<Texture> textures;
  // Own the texels that textures point to. Copies of the scene share them.
  std::vector<std::shared_ptr<TexelGrid>> grids;
  std::shared_ptr<const TexelFile> texelFile;  // has the texels that are not in memory, or null
  std::vector<Camera> cameras;
  std::vector<PunctualLight> lights;
  std::vector<SunLamp> suns;         // in addition to a probe's
  std::vector<AmbientLamp> ambient;  // likewise, in addition to a probe
  std::optional<Image> environment;  // the model's own light probe: lat-long, already repaired
  std::vector<std::string> nodeNames;
  std::vector<std::string> notes;  // hints for the user: "FILE: ..."
  std::vector<int> nodeParents;    // by node, -1 for none; empty if no node has a parent
  std::vector<std::string> files;  // paths of all files read: models, their buffers and images
  bool isAnimated = false;         // shown at a time of an animation
  bool moves = false;              // while the shutter is open

  size_t triangleCount() const;       // instanced triangles count once per instance
  size_t byteCount() const;           // of geometry and texels, for the statistics
  size_t texelByteCount() const;      // of texels in memory
  size_t texelFileByteCount() const;  // of texels in `texelFile`

  // Throws RunError if texels could not be read from the file; those were taken as 0.
  void checkTexels() const;
};

// Adds the contents of `other` to `scene` (a scene file may have several models).
void append(Scene& scene, Scene&& other);

// Makes a point of the scene's coordinates their origin, in double precision.
void moveOrigin(Scene& scene, const glm::dvec3& origin);

}  // namespace chromeball
