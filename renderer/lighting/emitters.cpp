// SPDX-License-Identifier: Apache-2.0
#include "lighting/emitters.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "lighting/emission_map.h"
#include "math/warp.h"
#include "scene/placed_triangles.h"
#include "scene/surface.h"
#include "shading/bsdf.h"

namespace chromeball {
namespace {

// Mean of value(texel) over the texels of the slot's texture.
template <class Value>
double meanOfTexels(const Scene& scene, const TextureSlot& slot, const Value& value) {
  const Texture& texture = scene.textures[slot.texture];
  const TexelGrid& grid = *texture.grid;
  double sum = 0;
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) sum += value(linearTexel(grid, texture.srgb, x, y));
  return sum / (double(grid.width) * grid.height);
}

// Mean opacity of the material. At least kMin unless it is 0 everywhere: texture filtering and
// vertex colours can give opacities that no texel has.
double meanAlpha(const Scene& scene, const Material& m) {
  constexpr double kMin = 0.01;
  if (m.alphaMode == AlphaMode::Opaque) return 1;
  if (m.alphaMode == AlphaMode::Blend && m.baseColor.w == 0) return 0;
  const auto opacity = [&](const vec4& texel) {
    const float alpha = m.baseColor.w * texel.w;
    return m.alphaMode == AlphaMode::Mask ? (alpha >= m.alphaCutoff ? 1.0f : 0.0f) : alpha;
  };
  const double mean = m.baseColorTexture ? meanOfTexels(scene, m.baseColorTexture, opacity)
                                         : double(opacity(vec4(1)));
  return std::max(mean, kMin);
}

// Emitted luminance x mean alpha of the triangles of a material.
class Emission {
 public:
  Emission(const Scene& scene, const Material& material) {
    if (material.unlit || isBlack(material.emission)) return;
    alpha_ = meanAlpha(scene, material);
    luminance_ = double(luminance(material.emission));
    if (material.emissiveTexture) map_.emplace(scene, material);
  }

  bool isBlackEverywhere() const { return !(alpha_ * luminance_ > 0); }
  bool differs() const { return map_.has_value(); }  // between triangles
  double of(const Mesh& mesh, const Triangle& triangle) const {
    return alpha_ * (map_ ? map_->mean(mesh, triangle) : luminance_);
  }

 private:
  double alpha_ = 0, luminance_ = 0;
  std::optional<EmissionMap> map_;
};

// The end of a shadow ray from `origin` towards a point of the surface that faces it: off surfaces
// in its plane, and farther if the ray is long. The rounding errors of the ray grow with its
// length, and not with the surface's coordinates, which are 0 in a coordinate plane.
vec3 endOfRay(const Surface& surface, float planeOffset, const vec3& origin) {
  const vec3 extent = surface.position - origin;
  const float offset = rayOffset(absolute(extent), surface.geometricNormal);
  return surface.position + std::max(planeOffset, offset) * surface.geometricNormal;
}

}  // namespace

struct Emitters::Found {
  std::vector<EmissiveTriangle> triangles;
  std::vector<double> powers;  // of each
  std::vector<Densities> densities;
  std::vector<double> radiances{0};  // that densities refer to; the first: of what does not emit
};

std::unique_ptr<Emitters> Emitters::make(const Scene& scene) {
  std::vector<Emission> emissions;
  for (const Material& material : scene.materials) emissions.emplace_back(scene, material);

  Found found;
  size_t most = 0;
  for (const Instance& instance : scene.instances)
    if (!emissions[size_t(instance.material)].isBlackEverywhere())
      most += scene.meshes[size_t(instance.mesh)].triangles.size();
  found.triangles.reserve(most), found.powers.reserve(most);
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const Emission& emission = emissions[size_t(instance.material)];
    if (emission.isBlackEverywhere() || mesh.triangles.empty()) {
      found.densities.push_back({0, false});
      continue;
    }
    found.densities.push_back({found.radiances.size(), emission.differs()});
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& triangle = mesh.triangles[t];
      const double radiance = emission.of(mesh, triangle);
      if (t == 0 || emission.differs()) found.radiances.push_back(radiance);
      const vec3 p0 = instance.point(mesh.positions[triangle.x]);
      const vec3 p1 = instance.point(mesh.positions[triangle.y]);
      const vec3 p2 = instance.point(mesh.positions[triangle.z]);
      const double area = 0.5 * glm::length(glm::cross(glm::dvec3(p1) - glm::dvec3(p0),
                                                       glm::dvec3(p2) - glm::dvec3(p0)));
      if (!(radiance * area > 0)) continue;
      found.triangles.push_back({i, t, p0, p1, p2});
      found.powers.push_back(radiance * area);
    }
  }
  if (found.triangles.empty()) return nullptr;
  return std::unique_ptr<Emitters>(new Emitters(scene, std::move(found)));
}

Emitters::Emitters(const Scene& scene, Found found)
    : scene_(scene),
      triangles_(std::move(found.triangles)),
      densities_(std::move(found.densities)),
      choice_(1, int(triangles_.size()), std::max(CdfRows::kGuide, int(triangles_.size()))) {
  const double total = choice_.setRow(0, found.powers);
  constexpr float kLeast = std::numeric_limits<float>::min();
  for (double radiance : found.radiances)
    areaPdfs_.push_back(radiance > 0 ? std::max(float(radiance / total), kLeast) : 0.0f);
}

Emitters::Point Emitters::choose(double choice, float v) const {
  const EmissiveTriangle& t = triangles_[choice_.sample(0, choice)];
  const vec2 b = squareToTriangle({float(choice), v});
  return {t.instance, t.triangle, b, (1 - b.x - b.y) * t.p0 + b.x * t.p1 + b.y * t.p2};
}

vec3 Emitters::placeOf(const Point& point, const Instance& instance, float time) const {
  if (!instance.motion) return point.position;
  const Triangle& triangle = scene_.meshes[size_t(instance.mesh)].triangles[point.triangle];
  const auto corners = cornersAt(scene_, instance, triangle, time);
  const vec2& b = point.barycentric;
  return (1 - b.x - b.y) * corners[0] + b.x * corners[1] + b.y * corners[2];
}

float Emitters::areaRatio(const Surface& surface, const Instance& instance) const {
  if (!instance.motion) return 1;
  const auto areaAt = [&](float time) {
    const auto [p0, p1, p2] = cornersAt(scene_, instance, surface.triangle, time);
    return glm::length(glm::cross(p1 - p0, p2 - p0));
  };
  return areaAt(0) / areaAt(surface.time);
}

void Emitters::sample(const LightPoint& point, const PixelSampler& sampler,
                      std::vector<DirectionSample>& out) const {
  const Point emitter = choose(sampler.getFine1(dimension::kEmitter),  //
                               sampler.get1(dimension::kEmitter + 1));
  const Instance& instance = scene_.instances[emitter.instance];
  const vec3 to = placeOf(emitter, instance, point.time) - point.position;
  const float distance = glm::length(to);
  const vec3 wi = to / distance;
  // Plain BSDFs transmit no light: saves the surface of a sample that they would drop.
  const bool isLayered = point.bsdf && point.bsdf->isLayered();
  if (!(distance > 0) || !(glm::dot(wi, point.normal) > 0 || isLayered)) return;
  if (!scene_.materials[size_t(instance.material)].doubleSided &&
      isFromBehind(scene_, instance, emitter.triangle, wi, point.time))
    return;
  const Surface surface =
      surfaceAt(scene_, instance, emitter.triangle, emitter.barycentric, -wi, 0, point.time);
  const float cosine = glm::dot(surface.geometricNormal, -wi);
  const Rgb radiance = emittedRadiance(scene_, instance, surface, -wi) *
                       surfaceAlpha(scene_, instance, emitter.triangle, emitter.barycentric);
  if (isBlack(radiance) || !(cosine > 0)) return;
  const float density =
      pdf(emitter.instance, emitter.triangle, distance, cosine) * areaRatio(surface, instance);
  if (!(density > 0)) return;
  const float offset =
      planeOffset(scene_, instance, emitter.triangle, surface.geometricNormal, point.time);
  out.push_back({.wi = wi,
                 .irradiance = radiance / density,
                 .pdf = density,
                 .distance = distance,
                 .end = {emitter.instance, emitter.triangle, emitter.barycentric,
                         endOfRay(surface, offset, point.position)}});
}

float Emitters::pdfOfHit(const LightPoint& point, const Surface& surface, uint32_t instance,
                         uint32_t triangle) const {
  const vec3 to = surface.position - point.position;
  const float distance = glm::length(to);
  if (distance == 0) return 0;  // of surfaces at one place (transport/place.h), as sample()
  constexpr float kGrazing = 1e-12f;
  const float cosine = -glm::dot(surface.geometricNormal, to) / distance;
  return pdf(instance, triangle, distance, std::max(cosine, kGrazing)) *
         areaRatio(surface, scene_.instances[instance]);
}

}  // namespace chromeball
