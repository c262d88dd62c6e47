// SPDX-License-Identifier: Apache-2.0
#include "scene/surface.h"

#include <limits>

#include "scene/camera.h"
#include "scene/extended_surface.h"

namespace chromeball {
namespace {

template <class T>
[[gnu::always_inline]] inline T interpolate(const std::vector<T>& vertices, const Triangle& t,
                                            vec2 b) {
  return (1 - b.x - b.y) * vertices[t.x] + b.x * vertices[t.y] + b.y * vertices[t.z];
}

vec4 lookup(const Scene& scene, const TextureSlot& slot, const Mesh& mesh, const Triangle& t,
            vec2 b) {
  vec2 uv(0);
  if (slot.uvSet < int(mesh.uvs.size()) && !mesh.uvs[slot.uvSet].empty())
    uv = interpolate(mesh.uvs[slot.uvSet], t, b);
  return scene.textures[slot.texture].lookup(slot.transform(uv));
}

// The footprint of the beam is an ellipse. Textures are filtered isotropically over an equal area,
// so that at any angle the beams of a pixel together cover the same multiple of its footprint.
float footprintOf(float crossSection, float cosine, float doubleArea) {
  constexpr float kMinCosine = 1e-3f;
  const float area = crossSection / std::max(std::fabs(cosine), kMinCosine);
  return doubleArea > 0 ? area / doubleArea : 0;
}

// v / |v| for a squared length that is 0, too small or too large for a float: triangles of more
// than 1e9 m, and transforms by such factors. `none` if v is 0 or not finite.
[[gnu::noinline]] vec3 unitOfExtreme(const vec3& v, const vec3& none) {
  const vec3 unit(unitOrZero(glm::dvec3(v)));
  return glm::dot(unit, unit) > 0 ? unit : none;
}

// v / |v|, where `length2` is the square of |v|.
inline vec3 unitOr(const vec3& v, float length2, const vec3& none) {
  constexpr float kLeast = std::numeric_limits<float>::min(),
                  kMost = std::numeric_limits<float>::max();
  if (length2 >= kLeast && length2 <= kMost) [[likely]]
    return v * (1 / std::sqrt(length2));
  return unitOfExtreme(v, none);
}

float handednessOf(const std::optional<Transform>& toWorld) {
  return toWorld && glm::determinant(toWorld->linear) < 0 ? -1.0f : 1.0f;
}

// The interpolated vertex normal in world space, on the front side; not unit.
[[gnu::always_inline]] inline vec3 interpolatedNormal(const Mesh& mesh,
                                                      const std::optional<Transform>& toWorld,
                                                      const Triangle& triangle, vec2 barycentric,
                                                      float handedness) {
  const vec3 n = interpolate(mesh.normals, triangle, barycentric);
  if (!toWorld) return n;
  const mat3& m = toWorld->linear;  // normals are transformed by the cofactor matrix
  return handedness * (n.x * glm::cross(m[1], m[2]) + n.y * glm::cross(m[2], m[0]) +
                       n.z * glm::cross(m[0], m[1]));
}

// The same for an instance that moves. Between two keys it turns as their vertices do.
[[gnu::noinline]] vec3 movingNormal(const InstanceMotion& motion, const Triangle& triangle,
                                    vec2 barycentric, float time) {
  const KeySpan span = motion.at(time);
  const auto unitAt = [&](const InstanceMotion::Key& key) {
    const vec3 n = interpolatedNormal(*key.mesh, key.toWorld, triangle, barycentric,
                                      handednessOf(key.toWorld));
    return unitOr(n, glm::dot(n, n), vec3(0));
  };
  return glm::mix(unitAt(motion.keys[span.from]), unitAt(motion.keys[span.to]), span.fraction);
}

[[gnu::noinline]] std::array<vec3, 3> movingCorners(const InstanceMotion& motion,
                                                    const Triangle& triangle, float time) {
  const KeySpan span = motion.at(time);
  return {motion.point(triangle.x, span), motion.point(triangle.y, span),
          motion.point(triangle.z, span)};
}

// The tangent in world space, with the sign of the bitangent in w; not unit.
vec4 interpolatedTangent(const Surface& s, const Instance& instance) {
  const auto tangentOf = [&](const Mesh& mesh, const std::optional<Transform>& toWorld) {
    const vec4 tangent = interpolate(mesh.tangents, s.triangle, s.barycentric);
    return toWorld ? vec4(toWorld->linear * vec3(tangent), tangent.w) : tangent;
  };
  if (!instance.motion) return tangentOf(*s.mesh, instance.toWorld);
  const KeySpan span = instance.motion->at(s.time);
  const InstanceMotion::Key &from = instance.motion->keys[span.from],
                            &to = instance.motion->keys[span.to];
  return glm::mix(tangentOf(*from.mesh, from.toWorld), tangentOf(*to.mesh, to.toWorld),
                  span.fraction);
}

std::optional<TangentFrame> tangentFrame(const Surface& s, const Instance& instance,
                                         float handedness, const vec3& normal) {
  const vec4 tangent4 = interpolatedTangent(s, instance);
  vec3 tangent(tangent4);
  tangent -= normal * glm::dot(normal, tangent);
  tangent = unitOr(tangent, glm::dot(tangent, tangent), vec3(0));
  if (tangent == vec3(0)) return std::nullopt;
  return TangentFrame{
      tangent, handedness * (tangent4.w < 0 ? -1.0f : 1.0f) * glm::cross(normal, tangent), normal};
}

// Not inlined, because most materials have no normal map.
[[gnu::noinline]] vec3 mappedNormal(const Scene& scene, const Surface& s, const Instance& instance,
                                    float handedness, const vec3& normal) {
  const auto frame = tangentFrame(s, instance, handedness, normal);
  if (!frame) return normal;
  return mappedNormal(scene, s.material->normalTexture, s.material->normalScale, s, *frame);
}

}  // namespace

// Bounds the error, along the normal, of a point interpolated in a triangle and of the next
// ray-triangle intersection: a few rounding errors of the coordinates. Waechter and Binder (2019)
// use units in the last place of the point; here the vertices' coordinates are used, so that the
// bound also holds for a large triangle through the origin. kAcross adds a small fraction of the
// other directions, so that the offset is not 0 for a triangle in a coordinate plane. With Embree
// 3.13, 2 roundings suffice; with 4.4, 16 were too few for one ray in 10^5.
float rayOffset(const vec3& sizes, const vec3& normal) {
  constexpr float kRoundings = 32 * std::numeric_limits<float>::epsilon(), kAcross = 1.0f / 1024;
  return kRoundings * glm::dot(absolute(normal) + kAcross, sizes);
}

std::array<vec3, 3> cornersAt(const Scene& scene, const Instance& instance, const Triangle& t,
                              float time) {
  if (instance.motion) return movingCorners(*instance.motion, t, time);
  const std::vector<vec3>& positions = scene.meshes[instance.mesh].positions;
  return {instance.point(positions[t.x]), instance.point(positions[t.y]),
          instance.point(positions[t.z])};
}

namespace {

vec3 sizesOf(const vec3& p0, const vec3& p1, const vec3& p2) {
  return glm::max(absolute(p0), glm::max(absolute(p1), absolute(p2)));
}

// Rays are transformed to the mesh's space, and meet its coordinates there.
vec3 sizesOf(const Instance& instance, const Mesh& mesh, const Triangle& t, const vec3& ofCorners) {
  if (!instance.toWorld) return ofCorners;
  const vec3 own = sizesOf(mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]);
  return glm::max(ofCorners, instance.toWorld->reach(own));
}

}  // namespace

PlacedTriangle placedTriangle(const Scene& scene, const Instance& instance, uint32_t triangle,
                              float time) {
  const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
  const Triangle& t = mesh.triangles[triangle];
  const std::array<vec3, 3> corners = cornersAt(scene, instance, t, time);
  return {corners, sizesOf(instance, mesh, t, sizesOf(corners[0], corners[1], corners[2]))};
}

Surface surfaceAt(const Scene& scene, const Instance& instance, uint32_t triangle, vec2 barycentric,
                  const vec3& wo, float crossSection, float time) {
  Surface s;
  s.mesh = &scene.meshes[instance.mesh];
  s.material = &scene.materials[instance.material];
  s.triangle = s.mesh->triangles[triangle];
  s.barycentric = barycentric;
  s.time = time;

  vec3 p0 = s.mesh->positions[s.triangle.x];
  vec3 p1 = s.mesh->positions[s.triangle.y];
  vec3 p2 = s.mesh->positions[s.triangle.z];
  float handedness = 1;
  if (const auto& toWorld = instance.toWorld) {
    p0 = toWorld->point(p0);
    p1 = toWorld->point(p1);
    p2 = toWorld->point(p2);
    handedness = handednessOf(toWorld);
  }
  if (instance.motion) [[unlikely]] {
    const auto corners = movingCorners(*instance.motion, s.triangle, time);
    p0 = corners[0], p1 = corners[1], p2 = corners[2];
  }

  s.position = (1 - barycentric.x - barycentric.y) * p0 + barycentric.x * p1 + barycentric.y * p2;
  vec3 front = handedness * glm::cross(p1 - p0, p2 - p0);
  const float doubleArea2 = glm::dot(front, front);
  front = unitOr(front, doubleArea2, wo);
  s.frontFace = glm::dot(front, wo) >= 0;
  s.footprint = 0;
  if (crossSection > 0)
    s.footprint = footprintOf(crossSection, glm::dot(front, wo), std::sqrt(doubleArea2));
  s.geometricNormal = s.frontFace ? front : -front;
  s.rayOffset = rayOffset(sizesOf(instance, *s.mesh, s.triangle, sizesOf(p0, p1, p2)), front);

  s.normal = s.geometricNormal;
  if (!s.mesh->normals.empty()) {
    vec3 n = interpolatedNormal(*s.mesh, instance.toWorld, s.triangle, barycentric, handedness);
    if (instance.motion) [[unlikely]]
      n = movingNormal(*instance.motion, s.triangle, barycentric, time);
    n = unitOr(n, glm::dot(n, n), vec3(0));
    if (n != vec3(0)) {
      if (s.material->normalTexture && !s.mesh->tangents.empty())
        n = mappedNormal(scene, s, instance, handedness, n);
      if (!s.frontFace) n = -n;
      if (glm::dot(n, s.geometricNormal) > 0) s.normal = n;
    }
  }
  return s;
}

bool isFromBehind(const Scene& scene, const Instance& instance, uint32_t triangle,
                  const vec3& direction, float time) {
  const Triangle& t = scene.meshes[instance.mesh].triangles[triangle];
  const auto [p0, p1, p2] = cornersAt(scene, instance, t, time);
  return handednessOf(instance.toWorld) * glm::dot(glm::cross(p1 - p0, p2 - p0), direction) > 0;
}

std::optional<TangentFrame> tangentFrameAt(const Surface& s, const Instance& instance) {
  if (s.mesh->tangents.empty()) return std::nullopt;
  const float handedness = handednessOf(instance.toWorld);
  const vec3 n = instance.motion ? movingNormal(*instance.motion, s.triangle, s.barycentric, s.time)
                                 : interpolatedNormal(*s.mesh, instance.toWorld, s.triangle,
                                                      s.barycentric, handedness);
  const vec3 unit = unitOr(n, glm::dot(n, n), vec3(0));
  if (unit == vec3(0)) return std::nullopt;
  return tangentFrame(s, instance, handedness, unit);
}

// Tangent-space normal mapping (glTF 2.0, 3.9.3).
vec3 mappedNormal(const Scene& scene, const TextureSlot& map, float scale, const Surface& surface,
                  const TangentFrame& frame) {
  vec3 n = vec3(lookup(scene, map, surface)) * 2.0f - 1.0f;
  n.x *= scale;
  n.y *= scale;
  const vec3 mapped = n.x * frame.tangent + n.y * frame.bitangent + n.z * frame.normal;
  const float mapped2 = glm::dot(mapped, mapped);
  return mapped2 > 0 ? mapped * (1 / std::sqrt(mapped2)) : frame.normal;
}

vec4 lookup(const Scene& scene, const TextureSlot& slot, const Surface& s) {
  if (s.footprint == 0) return lookup(scene, slot, *s.mesh, s.triangle, s.barycentric);
  vec2 uv(0), edge1(0), edge2(0);
  if (slot.uvSet < int(s.mesh->uvs.size()) && !s.mesh->uvs[slot.uvSet].empty()) {
    const std::vector<vec2>& uvs = s.mesh->uvs[slot.uvSet];
    uv = interpolate(uvs, s.triangle, s.barycentric);
    edge1 = uvs[s.triangle.y] - uvs[s.triangle.x];
    edge2 = uvs[s.triangle.z] - uvs[s.triangle.x];
  }
  const Texture& texture = scene.textures[slot.texture];
  const float doubleArea = std::fabs(edge1.x * edge2.y - edge1.y * edge2.x) * slot.areaFactor();
  const float texels =
      s.footprint * doubleArea * float(texture.grid->width) * float(texture.grid->height);
  return texture.lookup(slot.transform(uv), texels);
}

namespace {

// Applies Material::specularGlossiness; `p` already has F0.
[[gnu::noinline]] void applySpecularGlossiness(const Scene& scene, const Surface& s,
                                               MaterialPoint& p) {
  p.baseColor *= 1 - maxComponent(p.dielectricF0);
  if (const TextureSlot& map = s.material->specularColorTexture)
    p.roughness = 1 - (1 - p.roughness) * lookup(scene, map, s).w;
}

}  // namespace

MaterialPoint materialAt(const Scene& scene, const Surface& s) {
  const Material& m = *s.material;
  MaterialPoint p;
  p.baseColor = Rgb(m.baseColor);
  p.metallic = m.metallic;
  p.roughness = m.roughness;
  if (m.baseColorTexture) p.baseColor *= Rgb(lookup(scene, m.baseColorTexture, s));
  if (!s.mesh->colors.empty())
    p.baseColor = glm::clamp(
        p.baseColor * Rgb(interpolate(s.mesh->colors, s.triangle, s.barycentric)), 0.0f, 1.0f);
  if (m.projection)
    if (const auto seen = m.projection->lookup(s.position)) p.baseColor = *seen;
  if (m.metallicRoughnessTexture) {
    const vec4 texel = lookup(scene, m.metallicRoughnessTexture, s);
    p.roughness *= texel.y;
    p.metallic *= texel.z;
  }

  p.dielectricF0 = Rgb(0);
  p.dielectricF90 = 0;
  if (m.specular == 0) return p;
  float specular = m.specular;
  Rgb specularColor = m.specularColor;
  if (m.specularTexture) specular *= lookup(scene, m.specularTexture, s).w;
  if (m.specularColorTexture) specularColor *= Rgb(lookup(scene, m.specularColorTexture, s));
  // KHR_materials_specular and _ior: F0 = min(((ior-1)/(ior+1))^2 color, 1) specular.
  const float r = m.ior == 0 ? 1 : (m.ior - 1) / (m.ior + 1);
  p.dielectricF0 = glm::min(r * r * specularColor, Rgb(1)) * specular;
  p.dielectricF90 = specular;
  if (m.specularGlossiness) [[unlikely]]
    applySpecularGlossiness(scene, s, p);
  return p;
}

Rgb emittedRadiance(const Scene& scene, const Instance& instance, const Surface& s,
                    const vec3& wo) {
  const Material& m = *s.material;
  if (m.unlit) return materialAt(scene, s).baseColor;
  if (isBlack(m.emission) || !(s.frontFace || m.doubleSided)) return Rgb(0);
  Rgb radiance = m.emission;
  if (m.emissiveTexture) radiance *= Rgb(lookup(scene, m.emissiveTexture, s));
  if (m.extended) radiance *= coatTransmittance(scene, instance, s, wo);
  return radiance;
}

float surfaceAlpha(const Scene& scene, const Instance& instance, uint32_t triangle,
                   vec2 barycentric) {
  const Material& material = scene.materials[instance.material];
  if (material.alphaMode == AlphaMode::Opaque) return 1;
  const Mesh& mesh = scene.meshes[instance.mesh];
  const Triangle& t = mesh.triangles[triangle];
  float alpha = material.baseColor.w;
  if (material.baseColorTexture)
    alpha *= lookup(scene, material.baseColorTexture, mesh, t, barycentric).w;
  if (!mesh.colors.empty()) alpha *= interpolate(mesh.colors, t, barycentric).w;
  if (material.alphaMode == AlphaMode::Mask) return alpha >= material.alphaCutoff ? 1.0f : 0.0f;
  return glm::clamp(alpha, 0.0f, 1.0f);
}

}  // namespace chromeball
