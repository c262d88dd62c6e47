// SPDX-License-Identifier: Apache-2.0
// Shading in lanes gives in each lane what the code for one point gives.
#include <gtest/gtest.h>

#include "all_tables.h"
#include "lighting/strategy.h"
#include "math/warp.h"
#include "probe/synth.h"
#include "shading/bsdf.h"
#include "shading/bsdf_lanes.h"
#include "small_scenes.h"
#include "test_scene.h"
#include "transport/camera_samples.h"
#include "transport/vertex_arrays.h"
#include "transport/wide_paths.h"

namespace chromeball::lanes_test {
namespace {

constexpr size_t kLanes = 8;

float number(uint64_t i, uint64_t purpose) { return toUnit(uint32_t(hash(i, purpose))); }
vec3 directionOf(uint64_t i, uint64_t purpose) {
  return squareToUniformSphere({number(i, purpose), number(i, purpose + 1)});
}

// A point with random normals, viewer, light and material: by `i`, every fourth is Lambertian, and
// others are metals, dielectrics and smooth mirrors.
struct RandomPoint {
  MaterialPoint material;
  Surface surface{};
  vec3 wo, wi;
  vec2 u;
  float lobe;

  explicit RandomPoint(uint64_t i) {
    material.baseColor = Rgb(number(i, 1), number(i, 2), number(i, 3));
    material.metallic = i % 4 == 0 ? 0 : i % 4 == 1 ? 1 : number(i, 4);
    material.roughness = i % 7 == 0 ? 0 : number(i, 5);
    material.dielectricF0 = i % 4 == 0 ? Rgb(0) : Rgb(number(i, 6), 0.04f, 0.1f);
    material.dielectricF90 = i % 4 == 0 ? 0 : 1;
    surface.geometricNormal = directionOf(i, 7);
    surface.normal = glm::normalize(surface.geometricNormal + 0.7f * directionOf(i, 9));
    wo = glm::normalize(surface.geometricNormal + 0.99f * directionOf(i, 11));
    wi = directionOf(i, 13);
    u = {number(i, 15), number(i, 16)};
    lobe = number(i, 17);
  }
  Bsdf bsdf() const { return {material, surface, wo, allTables()}; }
};

Lanes3<Float8> lanesOf(const std::array<vec3, kLanes>& vectors) {
  Lanes3<Float8> lanes{};
  for (size_t k = 0; k < kLanes; ++k)
    lanes.x[k] = vectors[k].x, lanes.y[k] = vectors[k].y, lanes.z[k] = vectors[k].z;
  return lanes;
}
vec3 at(const Lanes3<Float8>& lanes, size_t k) { return {lanes.x[k], lanes.y[k], lanes.z[k]}; }

// Points in lanes, and the results of their BSDF.
struct Shaded {
  BsdfLanesValue value;
  BsdfLanesSample sample;

  explicit Shaded(const std::array<uint64_t, kLanes>& numbers) {
    std::array<vec3, kLanes> color, f0, normal, geometric, wo, wi;
    MaterialLanes material{};
    Float8 u{}, v{}, lobe{};
    for (size_t k = 0; k < kLanes; ++k) {
      const RandomPoint p(numbers[k]);
      color[k] = p.material.baseColor, f0[k] = p.material.dielectricF0;
      material.metallic[k] = p.material.metallic, material.roughness[k] = p.material.roughness;
      material.dielectricF90[k] = p.material.dielectricF90;
      normal[k] = p.surface.normal, geometric[k] = p.surface.geometricNormal;
      wo[k] = p.wo, wi[k] = p.wi;
      u[k] = p.u.x, v[k] = p.u.y, lobe[k] = p.lobe;
    }
    material.baseColor = lanesOf(color), material.dielectricF0 = lanesOf(f0);
    const PlainBsdfLanes bsdf(material, lanesOf(normal), lanesOf(geometric), lanesOf(wo),
                              allTables().energy.get());
    value = bsdf.evaluate(lanesOf(wi));
    sample = bsdf.sample(u, v, lobe);
  }
};

void expectClose(const vec3& a, const vec3& b, float scale) {
  EXPECT_LE(maxComponent(absolute(a - b)), 2e-4f * scale);
}

TEST(Lanes, BsdfsAreThoseOfSinglePoints) {
  int valid = 0, mirrors = 0, lit = 0;
  for (uint64_t first = 0; first < 8 * 2000; first += kLanes) {
    std::array<uint64_t, kLanes> numbers;
    for (size_t k = 0; k < kLanes; ++k) numbers[k] = first + k;
    const Shaded shaded(numbers);
    for (size_t k = 0; k < kLanes; ++k) {
      SCOPED_TRACE(first + k);
      const RandomPoint p(first + k);
      // At the horizon of either normal rounding decides.
      const auto isAtHorizon = [&](const vec3& wi) {
        return std::fabs(glm::dot(wi, p.surface.geometricNormal)) < 1e-4f ||
               std::fabs(glm::dot(wi, p.bsdf().normal())) < 1e-4f;
      };
      if (!isAtHorizon(p.wi)) {
        const BsdfValue value = p.bsdf().evaluate(p.wi);
        lit += value.pdf > 0;
        EXPECT_NEAR(shaded.value.pdf[k], value.pdf, 1e-3f * (value.pdf + 1e-3f));
        expectClose(at(shaded.value.fCos, k), value.fCos, 5 * (1e-3f + maxComponent(value.fCos)));
      }
      BsdfSample sample;
      const bool isValid = p.bsdf().sample(p.u, p.lobe, sample);
      if (isAtHorizon(at(shaded.sample.wi, k))) continue;
      ASSERT_EQ(shaded.sample.isValid[k] != 0, isValid);
      if (!isValid) continue;
      ++valid, mirrors += sample.isDelta;
      EXPECT_EQ(shaded.sample.pdf[k] == 0, sample.isDelta);
      expectClose(at(shaded.sample.wi, k), sample.wi, 1);
      EXPECT_NEAR(shaded.sample.pdf[k], sample.pdf, 2e-3f * sample.pdf);
      expectClose(at(shaded.sample.weight, k), sample.weight,
                  5 * (1e-3f + maxComponent(sample.weight)));
    }
  }
  EXPECT_GT(valid, 10'000);
  EXPECT_GT(mirrors, 500);
  EXPECT_GT(lit, 5'000);
}

// The same bits whatever the other lanes hold: Lambertian points among metals, or alone.
TEST(Lanes, BsdfsDoNotDependOnOtherLanes) {
  for (uint64_t first = 0; first < 8 * 500; first += kLanes) {
    std::array<uint64_t, kLanes> numbers, reversed;
    for (size_t k = 0; k < kLanes; ++k) numbers[k] = reversed[kLanes - 1 - k] = first + k;
    const Shaded mixed(numbers), turned(reversed);
    for (size_t k = 0; k < kLanes; ++k) {
      std::array<uint64_t, kLanes> same;
      same.fill(first + k);
      const Shaded alone(same);
      const auto expectSame = [&](const Shaded& a, size_t i, const Shaded& b) {
        EXPECT_EQ(at(a.value.fCos, i), at(b.value.fCos, k));
        EXPECT_EQ(a.value.pdf[i], b.value.pdf[k]);
        EXPECT_EQ(a.sample.isValid[i], b.sample.isValid[k]);
        if (!a.sample.isValid[i]) return;
        EXPECT_EQ(at(a.sample.wi, i), at(b.sample.wi, k));
        EXPECT_EQ(at(a.sample.weight, i), at(b.sample.weight, k));
        EXPECT_EQ(a.sample.pdf[i], b.sample.pdf[k]);
      };
      expectSame(mixed, k, alone);
      expectSame(turned, kLanes - 1 - k, alone);
    }
  }
}

// Triangles of all sizes, also those whose area exceeds the range of a float, with and without
// normals, from both sides.
TEST(Lanes, SurfacesAreThoseOfSinglePoints) {
  Scene scene;
  scene.materials.resize(1);
  constexpr size_t kMeshes = kMostInArrays;
  for (size_t i = 0; i < kMeshes; ++i) {
    const float size = std::pow(10.0f, float(int(i % 32)) - 16);
    Mesh mesh;
    for (uint64_t k = 0; k < 3; ++k) {
      mesh.positions.push_back(size * directionOf(3 * i + k, 20));
      if (i % 2) mesh.normals.push_back(directionOf(i, 22));
    }
    mesh.triangles = {{0, 1, 2}};
    scene.meshes.push_back(std::move(mesh));
    Instance instance{.mesh = int(i)};
    if (i % 5 == 0) instance.toWorld = Transform{glm::mat3(2.0f), vec3(1)};
    scene.instances.push_back(instance);
  }
  RayArrays rays;
  HitArrays hits;
  for (size_t i = 0; i < kMeshes; ++i) {
    rays.direction.set(i, directionOf(i, 24));
    hits.set(i, {uint32_t(i), 0, squareToTriangle({number(i, 26), number(i, 27)}), 1});
  }
  const PlainSurfaces plain(scene);
  EXPECT_EQ(plain.part(0).kind, PlainSurfaces::Kind::Varying);
  EXPECT_EQ(plain.part(1).kind, PlainSurfaces::Kind::Uniform);
  VertexArrays vertices;
  vertices.fill(scene, plain, rays, hits, std::array<float, kMeshes>());
  for (size_t i = 0; i < kMeshes; ++i) {
    SCOPED_TRACE(i);
    const Surface surface =
        surfaceAt(scene, scene.instances[i], 0, hits.at(i)->barycentric, -rays.direction.at(i));
    expectClose(vertices.normal.at(i), surface.normal, 1);
    expectClose(vertices.geometricNormal.at(i), surface.geometricNormal, 1);
    expectClose(vertices.position.at(i), surface.position, glm::length(surface.position));
    EXPECT_NEAR(vertices.rayOffset[i], surface.rayOffset, 1e-4f * surface.rayOffset);
    EXPECT_EQ(vertices.isHidden[i] != 0, !surface.frontFace);
    EXPECT_EQ(vertices.baseColor.at(i), Rgb(1));
  }
}

// Paths of plain scenes end in lanes; those that meet glass or a lamp leave them.
TEST(Lanes, PathsLeaveAtOtherSurfaces) {
  const auto leftOf = [](const Scene& scene, const PathSettings& settings, bool& isServed) {
    const World world(scene, {}, allTables());
    const Probe probe(constantProbe({8, 4}, Rgb(1)));
    const auto lighting = makeStrategy("importance", probe, settings.mis, "test");
    const PathTracer tracer(world, *lighting, settings);
    const SobolTable table(16, dimension::tabulated(6), 0);
    PathContext context{.sampler = PixelSampler(table, 0), .clamp = Clamp()};
    isServed = WidePaths::serves(tracer, context);
    if (!isServed) return size_t(0);
    CameraPixel pixel;
    context.sampler.set(pixel.numbers, 0, 0, 0);
    CameraSamples cameras;
    for (uint32_t i = 0; i < 16; ++i) {
      cameras.add(pixel, context.sampler, i, 0);
      cameras.setRay(i, {{0.1f * float(i) - 0.8f, 5, 0.1f}, {0, -1, 0}});
    }
    cameras.findHits(world, kAllInstances);
    WidePaths wide;
    PathBatch rest;
    std::array<Rgb, 16> radiances;
    wide.trace(cameras, tracer, context, rest, radiances);
    return wide.left().size();
  };
  PathSettings settings;
  settings.estimateDepthCut = false;
  bool isServed;
  NamedScene named = threeScenes()[0];
  EXPECT_EQ(leftOf(named.scene, settings, isServed), 0u);
  EXPECT_TRUE(isServed);
  for (Material& material : named.scene.materials) material.extended.emplace().transmission = 1;
  leftOf(named.scene, settings, isServed);
  EXPECT_FALSE(isServed) << "nothing is plain";
  named = threeScenes()[0];
  named.scene.materials.push_back(named.scene.materials[0]);
  named.scene.materials.back().extended.emplace().transmission = 1;
  named.scene.instances.back().material = int(named.scene.materials.size()) - 1;
  EXPECT_GT(leftOf(named.scene, settings, isServed), 0u);
  EXPECT_TRUE(isServed);
}

// A smooth mirror under a sheet whose back it does not see, with and without a bounce behind it.
TEST(Lanes, MirrorsSeeThroughHiddenBacks) {
  const auto square = [](float height, float size) {
    Mesh mesh;
    mesh.positions = {
        {-size, height, -size}, {-size, height, size}, {size, height, size}, {size, height, -size}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};  // the front is above
    return mesh;
  };
  Scene scene;
  scene.materials.resize(2);
  scene.materials[0].roughness = 0;
  scene.materials[1].specular = scene.materials[1].metallic = 0;
  scene.meshes.push_back(square(0, 2));
  scene.meshes.push_back(square(1, 1));
  scene.instances = {{.mesh = 0, .material = 0}, {.mesh = 1, .material = 1}};
  const World world(scene, {}, allTables());
  const Probe probe(studioProbe({64, 32}));
  for (const int depth : {1, 2, 4}) {
    PathSettings settings;
    settings.maxDepth = depth;
    const auto lighting = makeStrategy("importance", probe, settings.mis, "test");
    const PathTracer tracer(world, *lighting, settings);
    const SobolTable table(64, dimension::tabulated(6), 0);
    PathContext context{.sampler = PixelSampler(table, 0), .clamp = Clamp()};
    ASSERT_TRUE(WidePaths::serves(tracer, context));
    CameraPixel pixel;
    context.sampler.set(pixel.numbers, 0, 0, 0);
    CameraSamples cameras;
    for (uint32_t i = 0; i < 64; ++i) {
      const vec3 target(0.02f * float(i) - 0.64f, 0, 0);
      const vec3 origin(0, 0.5f, 2);
      cameras.add(pixel, context.sampler, i, 0);
      cameras.setRay(i, {origin, glm::normalize(target - origin)});
    }
    cameras.findHits(world, kAllInstances);
    const auto found = PathBatch::traced(cameras, tracer, context);
    float brightest = 0;
    for (size_t i = 0; i < cameras.size(); ++i) {
      cameras[i].start(context.sampler);
      const Rgb single = tracer.radiance(cameras[i].path(), cameras[i].hit, context);
      expectClose(found[i], single, 1e-3f + maxComponent(single));
      brightest = std::max(brightest, maxComponent(single));
    }
    EXPECT_GT(brightest, 0) << "the sky behind the sheet";
  }
}

}  // namespace
}  // namespace chromeball::lanes_test
