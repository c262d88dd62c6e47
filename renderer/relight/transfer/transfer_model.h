// SPDX-License-Identifier: Apache-2.0
// A model that carries its transfer, to be lit by any probe and seen from any side (HDRI book,
// section 9.9.2, figure 9.46).
#pragma once

#include <string>

#include "bake/bake.h"
#include "bake/placed_mesh.h"
#include "relight/transfer/vertex_transfer.h"
#include "scene/gltf/custom_data.h"

namespace chromeball {

// A model file that carries transfer in attributes of its vertices.

class TransferFile {
 public:
  static constexpr const char* kPrefix = "_PRT_";
  static std::string nameOf(size_t index) { return kPrefix + std::to_string(index); }

  // Reads the scene, extras.chromeball.basis and the attributes that start with kPrefix, as many as
  // the mesh has vertices. Throws InputError.
  TransferFile(const std::string& path, ExternalFiles external, const Warn& warn);

  const std::string& path() const { return path_; }
  const CustomData& data() const { return data_; }
  const LightBasis& basis() const { return basis_; }
  const Scene& scene() const { return scene_; }

  // By vertex of the instance's mesh. The second throws InputError where the first has null.
  const std::vector<vec3>* find(size_t instance, const std::string& name) const;
  const std::vector<vec3>& attribute(size_t instance, const std::string& name) const;

 private:
  const std::string& nodeName(size_t instance) const {
    return scene_.nodeNames[size_t(scene_.instances[instance].node)];
  }

  std::string path_;
  CustomData data_;
  LightBasis basis_;
  Scene scene_;
};

// By instance, in the order of vertexPoints(), with the attributes _PRT_0, _PRT_1, ... (values of
// estimateTransfer(): irradiance / pi per function of the basis, RGB) and _PRT_OWN (light of the
// scene's own lamps), if there is any. Vertices inside of bodies take the mean of their neighbours.
std::vector<BakedGeometry> transferGeometry(const std::vector<PlacedMesh>& meshes,
                                            const std::vector<BakePoint>& points,
                                            const VertexTransfer& transfer);

struct TransferLight {
  BakeResult light;
  size_t negative = 0;  // points where a channel was below 0, which is raised to 0
};

// Irradiance, W/m^2, at points of the file's vertices under light with these coefficients
// (LightBasis::project()): pi times the sum of l_k _PRT_k, and _PRT_OWN. It does not depend on the
// viewer. Throws InputError if the file has not all of them.
TransferLight lightOf(const TransferFile& file, const std::vector<BakePoint>& points,
                      std::span<const Rgb> light);

// Adds a point of this light.
void addPoint(TransferLight& all, const dvec3& light);

}  // namespace chromeball
