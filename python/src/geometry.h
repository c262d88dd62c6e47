// SPDX-License-Identifier: Apache-2.0
// The part of a scene that was made of arrays.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arrays.h"
#include "scene/builder/scene_builder.h"
#include "values.h"

namespace chromeball::python {

// A scene that grows. Renders share it: it is copied, without its meshes, before it grows further.
class Geometry {
 public:
  int addMaterial(const Dict& keywords);
  int addMesh(const ArrayIn<float>& positions, const std::optional<ArrayIn<uint32_t>>& triangles,
              const std::optional<ArrayIn<float>>& normals,
              const std::optional<ArrayIn<float>>& uvs, const std::optional<ArrayIn<float>>& colors,
              int material);
  // `toWorld`: [4,4], of column vectors; nullopt: the mesh is in world space.
  void addInstance(int mesh, int material, const std::optional<ArrayIn<double>>& toWorld,
                   const std::string& name);

  // Null if nothing was added. It does not change any more.
  std::shared_ptr<const Scene> share() const { return scene_; }

 private:
  SceneBuilder& builder();

  std::shared_ptr<Scene> scene_;
  std::optional<SceneBuilder> builder_;
};

}  // namespace chromeball::python
