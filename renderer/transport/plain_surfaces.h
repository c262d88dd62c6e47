// SPDX-License-Identifier: Apache-2.0
// The surfaces over which paths are shaded in lanes (wide_paths.h).
#pragma once

#include <cstdint>
#include <vector>

#include "scene/surface.h"

namespace chromeball {

// Which instances of a scene are plain: they stand still and scatter light as Lambert's or the
// metallic-roughness BSDF, and may emit, but do nothing else.
class PlainSurfaces {
 public:
  enum class Kind : uint8_t {
    Other,
    Uniform,  // the material is the same at all points, and the mesh is in world space
    Varying   // by textures or vertex colours, with a transform, or it emits
  };

  // What shading reads of an instance.
  struct Part {
    Kind kind;
    bool hidesBack;  // Material::hidesBack()
    bool emits;
    int32_t material;  // index
    const Triangle* triangles;
    const vec3 *positions, *normals;  // normals: null if the mesh has none
  };

  // The scene must outlive this.
  explicit PlainSurfaces(const Scene& scene);

  const Part& part(size_t instance) const { return parts_[instance]; }
  // Of parts that are uniform.
  const MaterialPoint& at(int material) const { return points_[size_t(material)]; }
  bool any() const { return any_; }
  bool anyEmits() const { return anyEmits_; }

 private:
  std::vector<Part> parts_;            // by instance
  std::vector<MaterialPoint> points_;  // by material
  bool any_ = false, anyEmits_ = false;
};

}  // namespace chromeball
