// SPDX-License-Identifier: Apache-2.0
// A model that carries its transfer, to be lit by any probe and seen from any side (HDRI book,
// section 9.9.2, figure 9.46).
#pragma once

#include <string>

#include "bake/bake.h"
#include "bake/baked_geometry.h"
#include "relight/vertex_transfer.h"
#include "scene/gltf/custom_data.h"

namespace chromeball {

// By instance, in the order of vertexPoints(), with the attributes _PRT_0, _PRT_1, ... (values of
// estimateTransfer(): irradiance / pi per function of the basis, RGB) and _PRT_OWN (light of the
// scene's own lamps), if there is any. Vertices inside of bodies take the mean of their neighbours.
std::vector<BakedGeometry> transferGeometry(const std::vector<PlacedMesh>& meshes,
                                            const std::vector<BakePoint>& points,
                                            const VertexTransfer& transfer);

class TransferModel {
 public:
  // Reads a file with these attributes and extras.chromeball.basis. Throws InputError.
  TransferModel(const std::string& path, ExternalFiles external, const Warn& warn);

  const Scene& scene() const { return scene_; }
  const glm::dvec3& origin() const { return data_.origin; }
  const LightBasis& basis() const { return basis_; }

  struct Lit {
    BakeResult light;     // irradiance, W/m^2
    size_t negative = 0;  // points where a channel was below 0, which is raised to 0
  };
  // Of points of the scene's vertices under light with these coefficients (LightBasis::project()):
  // pi times the sum of l_k _PRT_k, and _PRT_OWN. It does not depend on the viewer.
  Lit lit(const std::vector<BakePoint>& points, std::span<const Rgb> light) const;

 private:
  void checkAttributes() const;
  const CustomData::Arrays& arraysOf(size_t instance) const;

  std::string path_;
  CustomData data_;
  LightBasis basis_;
  Scene scene_;
};

}  // namespace chromeball
