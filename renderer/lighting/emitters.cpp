#include "lighting/emitters.h"

#include <numeric>

#include "math/warp.h"

namespace chromeball {
namespace {

// Mean luminance a material emits, over its texture's texels; positive wherever it emits at all.
double meanEmission(const Scene& scene, const Material& material) {
  if (material.unlit || isBlack(material.emission)) return 0;
  if (!material.emissiveTexture) return luminance(material.emission);
  const Texture& texture = scene.textures[material.emissiveTexture.texture];
  const TexelGrid& grid = *texture.grid;
  double sum = 0;
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x)
      sum += luminance(material.emission * Rgb(linearTexel(grid, texture.srgb, x, y)));
  return sum / (double(grid.width) * grid.height);
}

}  // namespace

std::unique_ptr<Emitters> Emitters::make(const Scene& scene) {
  std::vector<double> radiances;
  for (const Material& material : scene.materials)
    radiances.push_back(meanEmission(scene, material));

  std::vector<EmissiveTriangle> triangles;
  std::vector<double> powers;
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const double radiance = radiances[instance.material];
    if (!(radiance > 0)) continue;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const vec3 p0 = instance.point(mesh.positions[mesh.triangles[t].x]);
      const vec3 p1 = instance.point(mesh.positions[mesh.triangles[t].y]);
      const vec3 p2 = instance.point(mesh.positions[mesh.triangles[t].z]);
      const double area = 0.5 * glm::length(glm::cross(glm::dvec3(p1) - glm::dvec3(p0),
                                                       glm::dvec3(p2) - glm::dvec3(p0)));
      if (!(area > 0)) continue;
      triangles.push_back({i, t, p0, p1, p2});
      powers.push_back(radiance * area);
    }
  }
  if (triangles.empty()) return nullptr;
  return std::unique_ptr<Emitters>(new Emitters(std::move(triangles), powers, radiances));
}

Emitters::Emitters(std::vector<EmissiveTriangle> triangles, const std::vector<double>& powers,
                   const std::vector<double>& radiances)
    : triangles_(std::move(triangles)), choice_(1, int(triangles_.size())) {
  const double total = choice_.setRow(0, powers);
  for (double radiance : radiances) areaDensity_.push_back(float(radiance / total));
}

Emitters::Point Emitters::sample(vec2 u) const {
  double choice = u.x;
  const EmissiveTriangle& t = triangles_[choice_.sample(0, choice)];
  const vec2 b = squareToTriangle({float(choice), u.y});
  return {t.instance, t.triangle, b, (1 - b.x - b.y) * t.p0 + b.x * t.p1 + b.y * t.p2};
}

}  // namespace chromeball
