// SPDX-License-Identifier: Apache-2.0
// Ray intersection: watertightness, instances compared with baked meshes, alpha, ray masks.
#include "trace/accel.h"
#include "hypothesis.h"
#include "scene/bounds.h"

#include <gtest/gtest.h>

#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "math/vec.h"
#include "scene/mesh.h"
#include "scene/surface.h"
#include "test_scene.h"

namespace chromeball::accel_test {
namespace {

// Deterministic random numbers in [0, 1).
class Random {
 public:
  float next() { return toUnit(uint32_t(hash(++count_))); }
  vec2 next2() { return {next(), next()}; }

 private:
  uint64_t count_ = 0;
};

// Six inward-facing quads, one mesh each.
Scene boxScene(float side, vec3 centre) {
  Scene scene;
  const int material = addMaterial(scene, lambert(Rgb(0.5f)));
  for (int axis = 0; axis < 3; ++axis) {
    vec3 a(0), b(0), n(0);
    a[(axis + 1) % 3] = b[(axis + 2) % 3] = n[axis] = side;
    const vec3 corner = centre - vec3(side / 2);
    addQuad(scene, material, corner, a, b);
    addQuad(scene, material, corner + n, b, a);
  }
  return scene;
}

Scene sphereScene(float radius, vec3 centre) {
  Scene scene;
  addSphere(scene, addMaterial(scene, lambert(Rgb(0.5f))), centre, -radius, 45, false);
  return scene;
}

struct Leaks {
  int escaped = 0;  // rays that hit nothing
  int stuck = 0;    // rays that hit the flat face they started from
  float largestOffset = 0;
};

// Follows a path inside a closed scene: every ray must hit another face. A leaking path restarts.
// A mesh of two triangles counts as one flat face; in larger meshes each triangle is a face.
Leaks bounceAround(const Scene& scene, int rays) {
  const Accel accel(scene);
  const Bounds box = bounds(scene);
  const vec3 centre = 0.5f * (box.min + box.max);
  const bool flatMeshes = scene.meshes[0].triangles.size() == 2;
  Random random;
  Leaks leaks;
  const auto start = [&] {
    const uint32_t instance = uint32_t(random.next() * float(scene.instances.size()));
    const size_t triangles = scene.meshes[scene.instances[instance].mesh].triangles.size();
    return Hit{instance, uint32_t(random.next() * float(triangles)),
               squareToTriangle(random.next2())};
  };
  Hit hit = start();
  for (int i = 0; i < rays; ++i) {
    const Instance& instance = scene.instances[hit.instance];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const vec3 corner = instance.point(mesh.positions[mesh.triangles[hit.triangle].x]);
    const Surface surface =
        surfaceAt(scene, instance, hit.triangle, hit.barycentric, glm::normalize(centre - corner));
    leaks.largestOffset = std::max(leaks.largestOffset, surface.rayOffset);
    const vec3 direction =
        Frame(surface.geometricNormal).toWorld(squareToUniformHemisphere(random.next2()));
    Hit next;
    const bool escaped = !accel.intersect({surface.rayOrigin(direction), direction}, 0, next);
    const bool stuck =
        !escaped && next.instance == hit.instance && (flatMeshes || next.triangle == hit.triangle);
    leaks.escaped += escaped;
    leaks.stuck += stuck;
    hit = escaped || stuck ? start() : next;
  }
  return leaks;
}

// Transforms every instance, so that Accel traces them as instances instead of flattening them.
void setTransforms(Scene& scene, const Transform& transform) {
  for (Instance& instance : scene.instances) instance.toWorld = transform;
}

// No leaks up to a distance of 10 sizes from the origin. Beyond, the spacing of floats (2^-24 of
// the distance) matters: of a million rays in a box, 1 leaks at 100 to 1,000 sizes, 5 at 10,000. At
// a million sizes only a dozen floats span a shape. Of 60 million rays from all these distances,
// one (1e-4 above the face's plane, at a size) met its own face again.
TEST(Accel, ClosedShapesDoNotLeak) {
  constexpr int kRays = 100000;
  for (const float size : {1e-4f, 1.0f, 1e7f})
    for (const auto& [away, allowed] :
         {std::pair{0.0f, 0}, {1.0f, 0}, {10.0f, 0}, {1e3f, 2}, {1e4f, 5}}) {
      const vec3 centre = size * away * vec3(1, -0.7f, 0.4f);
      for (const Scene& scene : std::array{boxScene(size, centre), sphereScene(size / 2, centre)}) {
        const Leaks leaks = bounceAround(scene, kRays);
        EXPECT_LE(leaks.escaped, allowed) << size << " m, " << away << " sizes away";
        EXPECT_LE(leaks.stuck, away > 0 ? 1 : 0) << size << " m, " << away << " sizes away";
        if (away <= 10) {
          EXPECT_LT(leaks.largestOffset, 1e-4f * size);
        }
      }
    }
}

TEST(Accel, ClosedInstancesDoNotLeak) {
  const auto turned = [](float scale) {
    return glm::mat3(glm::scale(glm::rotate(glm::mat4(1), 0.7f, glm::normalize(vec3(1, 2, 3))),
                                scale * vec3(1, -0.5f, 2)));
  };
  for (const float scale : {1e-4f, 1.0f, 1e4f}) {
    std::array shapes{boxScene(1, vec3(0)), sphereScene(0.5f, vec3(2))};
    for (Scene& scene : shapes) {
      setTransforms(scene, {turned(scale), 3 * scale * vec3(1, -2, 0.5f)});
      const Leaks leaks = bounceAround(scene, 50000);
      EXPECT_EQ(leaks.escaped, 0) << scale;
      EXPECT_EQ(leaks.stuck, 0) << scale;
      EXPECT_LT(leaks.largestOffset, 1e-4f * scale);
    }
  }
}

struct Aimed {
  int hits = 0, entered = 0;  // `entered`: hits on a back face
};

// Traces rays at the edges of a scene's only body, from a ball of `radius` around it, as single
// rays and in packets.
Aimed aimAtEdges(const Scene& scene, float radius, int rayCount) {
  const Accel accel(scene);
  const Bounds box = bounds(scene);
  const vec3 centre = 0.5f * (box.min + box.max);
  const Instance& body = scene.instances[0];
  const Mesh& mesh = scene.meshes[0];
  Random random;
  Aimed aimed;
  const auto count = [&](const Ray& ray, const Hit& hit) {
    ++aimed.hits;
    aimed.entered +=
        !surfaceAt(scene, body, hit.triangle, hit.barycentric, -ray.direction).frontFace;
  };
  constexpr int kPacket = 8;
  std::array<Ray, kPacket> rays;
  const std::array<uint32_t, kPacket> keys{};
  std::array<std::optional<Hit>, kPacket> packet;
  for (int i = 0; i < rayCount; i += kPacket) {
    for (Ray& ray : rays) {
      const Triangle t = mesh.triangles[size_t(random.next() * float(mesh.triangles.size()))];
      const vec3 a = body.point(mesh.positions[t.x]), b = body.point(mesh.positions[t.y]);
      ray.origin = centre + radius * squareToUniformSphere(random.next2());
      ray.direction = glm::normalize(glm::mix(a, b, random.next()) - ray.origin);
    }
    accel.intersect(rays, keys, Accel::Coherence::None, packet);
    for (size_t k = 0; k < rays.size(); ++k) {
      if (packet[k]) count(rays[k], *packet[k]);
      if (Hit hit; accel.intersect(rays[k], 0, hit)) count(rays[k], hit);
    }
  }
  return aimed;
}

// Two entries of a scene may share a mesh, as two entries of one file with two variants do.
TEST(Accel, EntriesOfOneMeshHaveTheirOwnFilters) {
  Scene scene;
  scene.nodeNames = {"node"};
  Material veil = lambert(Rgb(0.5f));
  veil.alphaMode = AlphaMode::Blend;
  veil.baseColor.w = 0.25f;
  const int solid = addMaterial(scene, lambert(Rgb(0.5f))), thin = addMaterial(scene, veil);
  addQuad(scene, solid, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  scene.instances.clear();
  scene.meshes.push_back(scene.meshes.shared(0));
  for (const int mesh : {0, 1})
    for (const float x : {0.0f, 2.0f}) {
      const vec3 at(x + 4 * float(mesh), 0, 0);
      scene.instances.push_back({mesh, mesh == 0 ? solid : thin, 0, Transform{glm::mat3(1), at}});
    }
  const Accel accel(scene);
  for (const float x : {0.5f, 2.5f}) {
    EXPECT_EQ(accel.transmittance(Ray{{x, 0.3f, 5}, {0, 0, -1}}), Rgb(0));
    EXPECT_NEAR(accel.transmittance(Ray{{x + 4, 0.3f, 5}, {0, 0, -1}}).x, 0.75f, 1e-6);
  }
}

// From outside, a ray cannot hit a back face of a closed body, even if every ray is aimed at an
// edge. The exception is triangles seen exactly edge-on: one ray in a million. Without trace/ray.h
// it is one in 300.
TEST(Accel, RaysAtEdgesDoNotEnterClosedBodies) {
  constexpr int kRays = 200000;
  const Transform turned{2.0f * glm::mat3_cast(glm::angleAxis(0.7f, glm::normalize(vec3(1, 2, 3)))),
                         vec3(3, -2, 1)};
  for (const float size : {1e-4f, 1.0f, 1e7f}) {
    Scene ball, instance;
    addSphere(ball, addMaterial(ball, lambert(Rgb(0.5f))), vec3(0.3f, 0.2f, 0.1f) * size, size, 12);
    addSphere(instance, addMaterial(instance, lambert(Rgb(0.5f))), vec3(0), size, 12);
    setTransforms(instance, {turned.linear, size * turned.translation});
    for (const Scene* scene : {&ball, &instance}) {
      const Aimed aimed = aimAtEdges(*scene, 5 * size, kRays);
      EXPECT_GT(aimed.hits, kRays);
      EXPECT_LE(aimed.entered, 4) << size;
    }
  }
}

// A normal map of one tilted texel, so that the shading normal depends on the tangents.
int addNormalMappedMaterial(Scene& scene) {
  scene.grids.push_back(std::make_unique<TexelGrid>());
  *scene.grids.back() = {1, 1, {{180, 90, 220, 255}}, {}};
  scene.textures.push_back({scene.grids.back().get()});
  Material material = lambert(Rgb(0.5f));
  material.normalTexture.texture = 0;
  return addMaterial(scene, material);
}

// A smooth sphere with tangents along its parallels.
Mesh tangentSphere() {
  Scene scene;
  addSphere(scene, addMaterial(scene, lambert(Rgb(0))), vec3(0.2f, 0, 0), 1, 24);
  Mesh mesh = scene.meshes[0];
  for (const vec3& n : mesh.normals) mesh.tangents.emplace_back(n.z, 0, -n.x, 1);
  mesh.uvs.assign(1, std::vector<vec2>(mesh.positions.size(), vec2(0.5f)));
  repairTangents(mesh);
  return mesh;
}

TEST(Accel, InstancesMatchBakedMeshes) {
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(0.3, 1, -0.2));
  const glm::dmat4 transforms[] = {glm::translate(glm::dmat4(1), glm::dvec3(-3, 0, 0)) * turn,
                                   glm::translate(glm::dmat4(1), glm::dvec3(0, 0.5, 0)) *
                                       glm::scale(turn, glm::dvec3(0.3, 1.2, 0.8)),
                                   glm::translate(glm::dmat4(1), glm::dvec3(3, 0, 1)) *
                                       glm::scale(turn, glm::dvec3(-1, 0.7, 1.1))};
  Scene shared, baked;
  const int material = addNormalMappedMaterial(shared);
  addNormalMappedMaterial(baked);
  shared.nodeNames = {"node"};
  shared.meshes.push_back(tangentSphere());
  for (const glm::dmat4& t : transforms) {
    shared.instances.push_back({0, material, 0, Transform{glm::mat3(glm::dmat3(t)), vec3(t[3])}});
    Mesh mesh = tangentSphere();
    transformMesh(mesh, t);
    addMesh(baked, material, std::move(mesh));
  }
  const Accel sharedAccel(shared), bakedAccel(baked);

  Random random;
  constexpr int kRays = 20000;
  int hits = 0, differing = 0, fronts = 0, mapped = 0;
  for (int i = 0; i < kRays; ++i) {
    // A ray from outside the scene towards a sphere, or from inside a sphere in any direction.
    const vec3 centre(transforms[i % 3][3]);
    const vec3 jitter = vec3(random.next(), random.next(), random.next()) - 0.5f;
    const vec3 origin = i % 2 ? centre + 0.5f * jitter : 10.0f * jitter;
    const vec3 anywhere = squareToUniformSphere(random.next2());
    const vec3 direction = i % 2 ? anywhere : glm::normalize(centre + anywhere - origin);
    Hit a, b;
    const bool hitsShared = sharedAccel.intersect({origin, direction}, 0, a);
    const bool hitsBaked = bakedAccel.intersect({origin, direction}, 0, b);
    if (hitsShared != hitsBaked || (hitsShared && a.instance != b.instance)) {
      ++differing;  // beside a silhouette
      continue;
    }
    if (!hitsShared) continue;
    ++hits;
    const Surface s =
        surfaceAt(shared, shared.instances[a.instance], a.triangle, a.barycentric, -direction);
    const Surface t =
        surfaceAt(baked, baked.instances[b.instance], b.triangle, b.barycentric, -direction);
    const bool grazes = std::fabs(glm::dot(t.geometricNormal, direction)) < 1e-3f;
    if (a.triangle != b.triangle || grazes) {
      ++differing;  // on an edge, where both triangles are valid hits
      continue;
    }
    fronts += s.frontFace;
    ASSERT_EQ(s.frontFace, t.frontFace);
    ASSERT_NEAR(glm::distance(s.position, t.position), 0, 1e-4f);
    ASSERT_NEAR(glm::distance(s.geometricNormal, t.geometricNormal), 0, 1e-4f);
    // Interpolation before and after the transform differs most at the poles, where tangents vary.
    differing += glm::distance(s.normal, t.normal) > 0.02f;
    mapped += glm::distance(s.normal, s.geometricNormal) > 0.2f;
  }
  EXPECT_GT(hits, kRays / 4);
  EXPECT_GT(fronts, hits / 10);
  EXPECT_LT(fronts, hits * 9 / 10);
  EXPECT_GT(mapped, hits / 2);
  EXPECT_LT(differing, kRays / 100);
}

Material layer(AlphaMode mode, float alpha) {
  Material m = lambert(Rgb(0.5f));
  m.alphaMode = mode;
  m.baseColor.w = alpha;
  return m;
}

// Quads perpendicular to the Z axis at z = 1, 2, ..., one for each material, in one mesh or in one
// instance each.
Scene layerScene(const std::vector<Material>& materials, bool instanced) {
  Scene scene;
  for (const Material& material : materials) {
    const float z = float(scene.materials.size() + 1);
    const int index = addMaterial(scene, material);
    if (!instanced || scene.meshes.empty())
      addQuad(scene, index, {-1, -1, instanced ? 0 : z}, {2, 0, 0}, {0, 2, 0});
    else
      scene.instances.push_back({0, index, 0, {}});
    if (instanced) scene.instances.back().toWorld = Transform{glm::mat3(1), {0, 0, z}};
  }
  return scene;
}

const Ray kThroughLayers{{0.3f, 0.1f, 0}, {0, 0, 1}};

TEST(Accel, TransmittanceIsTheProductOverLayers) {
  const float alphas[] = {0.1f, 0.3f, 0.5f, 0.7f, 0.25f};
  std::vector<Material> blended, mixed;
  for (float alpha : alphas) blended.push_back(layer(AlphaMode::Blend, alpha));
  mixed = {layer(AlphaMode::Blend, 0.5f), layer(AlphaMode::Mask, 0.4f),
           layer(AlphaMode::Blend, 0.2f), layer(AlphaMode::Mask, 0.6f),
           layer(AlphaMode::Opaque, 0.1f)};
  for (bool instanced : {false, true}) {
    const Scene blendScene = layerScene(blended, instanced),
                mixedScene = layerScene(mixed, instanced);
    const Accel blend(blendScene), mix(mixedScene);
    const auto upTo = [](const Accel& accel, float tMax) {
      return accel.transmittance({kThroughLayers.origin, kThroughLayers.direction, tMax}).x;
    };
    float expected = 1;
    EXPECT_EQ(upTo(blend, 0.5f), 1);
    for (int i = 0; i < 5; ++i) {
      expected *= 1 - alphas[i];
      EXPECT_NEAR(upTo(blend, float(i) + 1.5f), expected, 1e-6f) << instanced;
    }
    EXPECT_NEAR(blend.transmittance(kThroughLayers).y, expected, 1e-6f);
    EXPECT_NEAR(upTo(mix, 2.5f), 0.5f, 1e-6f) << instanced;  // a mask below its cutoff is a hole
    EXPECT_NEAR(upTo(mix, 3.5f), 0.4f, 1e-6f) << instanced;
    EXPECT_EQ(upTo(mix, 4.5f), 0) << instanced;
    EXPECT_EQ(mix.transmittance(kThroughLayers), Rgb(0));
  }
}

TEST(Accel, BlendedLayersAreHitWithProbabilityAlpha) {
  const std::vector<Material> layers{layer(AlphaMode::Blend, 0.3f), layer(AlphaMode::Blend, 0.6f),
                                     layer(AlphaMode::Mask, 0.2f)};
  for (bool instanced : {false, true}) {
    const Scene scene = layerScene(layers, instanced);
    const Accel accel(scene);
    const auto hitLayer = [&](uint32_t key) {
      Hit hit;
      return accel.intersect(kThroughLayers, key, hit) ? hit.instance : 2;
    };
    constexpr uint32_t kKeys = 1 << 16;
    std::vector<double> counts(3);
    for (uint32_t key = 0; key < kKeys; ++key) {
      const uint32_t first = hitLayer(key);
      ++counts[first];
      ASSERT_EQ(hitLayer(key), first);  // the result depends only on the key
    }
    const std::vector<double> expected{0.3 * kKeys, 0.7 * 0.6 * kKeys, 0.7 * 0.4 * kKeys};
    EXPECT_GT(chiSquareTest(counts, expected).pValue, sidak(1e-3, 2)) << instanced;
  }
}

TEST(Accel, EmptyScenesAndInvalidRaysHaveNoHit) {
  const Scene empty, box = boxScene(1, vec3(0));
  const Accel nothing(empty), something(box);
  Hit hit;
  EXPECT_FALSE(nothing.intersect({{0, 0, 0}, {0, 0, 1}}, 0, hit));
  EXPECT_EQ(nothing.transmittance({{0, 0, 0}, {0, 0, 1}}), Rgb(1));
  const float nan = std::nanf("");
  for (const Ray& ray :
       {Ray{vec3(nan), {0, 0, 1}}, Ray{{0, 0, 0}, vec3(nan)}, Ray{{0, 0, 0}, {0, 0, 1}, nan},
        Ray{vec3(INFINITY), {0, 0, 1}}, Ray{{0, 0, 0}, {0, 0, 0}}}) {
    EXPECT_FALSE(something.intersect(ray, 0, hit));
    EXPECT_EQ(something.transmittance(ray), Rgb(1));
  }
}

// Holds also for numbers of rays that are no multiple of a packet.
TEST(Accel, PacketsMatchSingleRays) {
  constexpr size_t kMost = 20;
  const Scene spheres = sphereScene(1, vec3(0));
  const Scene veils = layerScene(std::vector(3, layer(AlphaMode::Blend, 0.4f)), true);
  Random random;
  for (const Scene* scene : {&spheres, &veils})
    for (const auto coherence : {Accel::Coherence::None, Accel::Coherence::High}) {
      const Accel accel(*scene);
      int found = 0, differing = 0, shadowsDiffering = 0;
      for (uint32_t set = 0; set < 1000; ++set) {
        const size_t count = 1 + set % kMost;
        std::vector<Ray> rays(count);
        std::vector<uint32_t> keys(count);
        for (size_t i = 0; i < count; ++i) {
          const vec3 aim = 2.0f * vec3(random.next(), random.next(), 0.5f) - 1.0f;
          rays[i] = {{0, 0, -3}, glm::normalize(aim + vec3(0, 0, 3))};
          keys[i] = set * kMost + uint32_t(i);
        }
        if (set % 5 == 0) rays[0].origin.x = NAN;
        if (set % 7 == 0) rays.back().tMax = 1;
        std::vector<std::optional<Hit>> hits(count);
        std::vector<Rgb> transmittances(count);
        accel.intersect(rays, keys, coherence, hits);
        accel.transmittance(rays, transmittances);
        for (size_t i = 0; i < count; ++i) {
          Hit hit;
          const bool meets = accel.intersect(rays[i], keys[i], hit);
          found += meets;
          // On an edge both triangles are valid hits; at a silhouette a hit and a miss are valid.
          differing +=
              meets != hits[i].has_value() ||
              (meets && (hit.instance != hits[i]->instance || hit.triangle != hits[i]->triangle ||
                         glm::distance(hit.barycentric, hits[i]->barycentric) > 1e-3f));
          shadowsDiffering += accel.transmittance(rays[i]) != transmittances[i];
        }
      }
      EXPECT_GT(found, 3000);
      EXPECT_LT(differing, 5);
      EXPECT_LT(shadowsDiffering, 5);
    }
}

// A ray ignores instances outside its mask; the indices of the others do not change.
TEST(Accel, MasksHideInstances) {
  Scene scene;
  for (float height : {3.0f, 2.0f, 1.0f})
    addQuad(scene, addMaterial(scene, lambert(Rgb(1))), {-1, height, 1}, {2, 0, 0}, {0, 0, -2});
  const Ray down{{0.2f, 4, 0.1f}, {0, -1, 0}};
  scene.instances[2].toWorld = Transform{};  // makes it a separate Embree instance
  const Accel accel(scene, {1, 2, 4});
  const Ray up{{0.2f, 2.5f, 0.1f}, {0, 1, 0}}, farther{{0.2f, 2.5f, 0.1f}, {0, -1, 0}};
  for (uint32_t i = 0; i < 3; ++i) {
    const RayMask mask = 1u << i;
    EXPECT_EQ(accel.mask(i), mask);
    Hit hit;
    ASSERT_TRUE(accel.intersect(down, 0, hit, mask));
    EXPECT_EQ(hit.instance, i);
    const std::array both{down, down};
    std::array<std::optional<Hit>, 2> packet;
    accel.intersect(both, std::array{0u, 0u}, Accel::Coherence::High, packet, mask);
    for (const auto& found : packet) {
      ASSERT_TRUE(found);
      EXPECT_EQ(found->instance, i);
    }
    EXPECT_EQ(accel.transmittance(up, mask), Rgb(i == 0 ? 0 : 1));
    EXPECT_EQ(accel.transmittance(farther, mask), Rgb(i == 0 ? 1 : 0));
    std::array<Rgb, 2> passed;
    accel.transmittance(std::array{up, farther}, passed, mask);
    EXPECT_EQ(passed[0], Rgb(i == 0 ? 0 : 1));
    EXPECT_EQ(passed[1], Rgb(i == 0 ? 1 : 0));
  }
  Hit hit;
  EXPECT_FALSE(accel.intersect(down, 0, hit, 8));
  EXPECT_TRUE(accel.intersect(down, 0, hit, 6));
  EXPECT_EQ(hit.instance, 1u);
}

// Two grids in one plane, whose meshes have a placement of any scale: each point of one finds the
// triangles of both that it lies in, and all that come near are found at any time of a motion.
TEST(Accel, WhatIsNearIsFoundInInstancesOfAnyScale) {
  constexpr uint32_t kSide = 6;
  for (const float scale : {1e-6f, 1e-4f, 1e-3f, 2e-3f, 0.1f, 1.0f, 30.0f, 1e4f})
    for (const bool isMoving : {false, true}) {
      Scene scene;
      const int material = addMaterial(scene, lambert(Rgb(1)));
      const vec3 unequal = isMoving ? vec3(1) : vec3(1, 1.5f, 0.7f);
      for (int k = 0; k < 2; ++k) {
        Mesh grid;
        for (uint32_t j = 0; j <= kSide; ++j)
          for (uint32_t i = 0; i <= kSide; ++i)
            grid.positions.push_back(vec3(float(i) - 3, float(j) - 3, 3) / scale);
        for (uint32_t j = 0; j < kSide; ++j)
          for (uint32_t i = 0; i < kSide; ++i) {
            const uint32_t a = j * (kSide + 1) + i;
            grid.triangles.push_back({a, a + 1, a + kSide + 2});
            grid.triangles.push_back({a, a + kSide + 2, a + kSide + 1});
          }
        addMesh(scene, material, grid);
        Instance& instance = scene.instances.back();
        const Transform first{
            glm::mat3(scale) * glm::mat3(unequal.x, 0, 0, 0, unequal.y, 0, 0, 0, unequal.z),
            vec3(0.25f, 0, 1)};
        instance.toWorld = first;
        if (!isMoving) continue;
        Transform last = first;
        last.linear *= 2, last.translation += vec3(0, 5, 0);
        const auto mesh = scene.meshes.shared(size_t(instance.mesh));
        InstanceMotion motion;
        motion.keys = {{mesh, first}, {mesh, last}};
        instance.motion = std::make_shared<const InstanceMotion>(motion);
        instance.moves = scene.moves = true;
      }
      const Accel accel(scene);
      for (const float time : {0.0f, 0.4f, 1.0f}) {
        if (!isMoving && time > 0) continue;
        for (uint32_t t = 0; t < 2 * kSide * kSide; ++t) {
          const Surface surface =
              surfaceAt(scene, scene.instances[0], t, {0.3f, 0.25f}, {0, 0, 1}, 0, time);
          std::set<std::pair<uint32_t, uint32_t>> found;
          accel.forEachNear(surface.position, 4 * surface.rayOffset, time,
                            [&](uint32_t instance, uint32_t triangle) {
                              found.emplace(instance, triangle);
                              return true;
                            });
          for (const uint32_t instance : {0u, 1u})
            EXPECT_TRUE(found.contains({instance, t})) << scale << " " << time << " " << t;
          EXPECT_LE(found.size(), 40u);
          int visited = 0;
          accel.forEachNear(surface.position, 4 * surface.rayOffset, time,
                            [&](uint32_t, uint32_t) { return ++visited < 1; });
          EXPECT_EQ(visited, 1) << "the search ends when it is told to";
        }
      }
    }
}

}  // namespace
}  // namespace chromeball::accel_test
