// SPDX-License-Identifier: Apache-2.0
// A model that carries its transfer, to be lit by any probe and seen from any side (HDRI book,
// section 9.9.2, figure 9.46).
#pragma once

#include <string>

#include "bake/bake.h"
#include "bake/bake_points.h"
#include "bake/placed_mesh.h"
#include "base/progress.h"
#include "film/film.h"
#include "relight/stage/light_stage.h"
#include "relight/stage/relit_stage.h"
#include "scene/gltf/load_gltf.h"
#include "transport/world.h"

namespace chromeball {

// Precomputed radiance transfer of diffuse surfaces: the light at points of a scene under each
// function of a basis of light (Sloan, Kautz and Snyder 2002, section 5; HDRI book, section 9.9.2).

// The functions on the sphere whose weighted sum is the light of transfer: spherical harmonics, or
// Haar wavelets on the faces of a cube (HDRI book, section 9.9.2).

// The result of light with coefficients l is the sum of l_k t_k, where t_k, the transfer, is the
// result of function k alone (Sloan, Kautz and Snyder 2002; Ng, Ramamoorthi and Hanrahan 2003).
//
// sh:ORDER  the real spherical harmonics up to this order; l_k is the integral of radiance x Y_k.
// haar:N    Haar wavelets of a cube map of N x N cells on each face, face by face. l is the
//           orthonormal transform (transforms.h) of the cells' mean radiances. The transform keeps
//           scalar products, so t is the transform of each cell's result with radiance 1.
class LightBasis {
 public:
  static constexpr int kMaxOrder = 6, kMaxCells = 32;

  // Throws InputError, begun by `location`.
  LightBasis(const std::string& name, const std::string& location);

  const std::string& name() const { return name_; }
  bool isHaar() const { return domain_ == RelightDomain::Haar; }
  size_t size() const { return size_t(directions_.size()); }  // the number of functions

  // Transfer is summed up in two steps: a sample that finds the light of `direction` (unit) with
  // `weight`, then, for the sum of all samples, its coefficients in place.
  void add(const vec3& direction, const dvec3& weight, std::span<dvec3> sums) const {
    directions_.forValues(direction,
                          [&](int k, float value) { sums[size_t(k)] += double(value) * weight; });
  }
  void transform(std::span<Rgb> sums) const { chromeball::transform(sums, directions_, domain_); }

  // The coefficients l of a probe that is turned by `rotation`.
  std::vector<Rgb> project(const Image& latLong, const Rotation& rotation) const;

  // The share of a face that a wavelet covers; 1 for harmonics.
  double support(size_t function) const;

 private:
  std::string name_;
  DirectionBasis directions_;
  RelightDomain domain_;
};

// Sets all but the `keep` most important coefficients to 0. The importance of a coefficient is
// the length of its RGB times its support: Ng et al. 2003 (section 4.2) call this the
// area-weighted choice.
void keepMostImportant(const LightBasis& basis, size_t keep, std::span<Rgb> light);

struct TransferSettings {
  uint32_t samples = 1024;  // paths of each point
  uint64_t seed = 0;
  int maxDepth = 8;  // as PathSettings, from 1: direct light with shadows alone
};

struct VertexTransfer {
  size_t count = 0;         // values of each point
  std::vector<Rgb> values;  // point by point
  // The light of the scene's own lamps and emitting surfaces; empty if it has none.
  std::vector<Rgb> own;
  std::vector<uint8_t> isBuried;  // inside a body (PointLight::isBuried): values are 0
  InvalidSamples invalid;         // at the points' x and y

  std::span<const Rgb> of(size_t point) const {
    return std::span(values).subspan(point * count, count);
  }
};

// Values are irradiance / pi per unit of each function: the radiance of a white Lambertian surface,
// due to light that shines on it, with shadows and light that other surfaces reflect to it. For
// harmonics and an open point with normal n, value k is A_l / pi Y_k(n), with the A_l of
// shIrradiance(), continued to higher bands (Ramamoorthi and Hanrahan 2001, eq. 8). `meshes`: all
// instances'. The result depends on points, samples and seed only.
VertexTransfer estimateTransfer(const World& world, const std::vector<PlacedMesh>& meshes,
                                const std::vector<BakePoint>& points, const LightBasis& basis,
                                const TransferSettings& settings, const Progress& progress);

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

  // The attribute by vertex of the instance's mesh. The second function throws InputError where the
  // first returns null.
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

// The geometry of each instance, in the order of vertexPoints(), with the attributes _PRT_0,
// _PRT_1, ... (values of estimateTransfer(): irradiance / pi per function of the basis, RGB) and
// _PRT_OWN (light of the scene's own lamps), if there is any. Vertices inside of bodies take the
// mean of their neighbours.
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
