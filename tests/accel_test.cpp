// What a ray meets: no leaks, instances as good as baked meshes, alpha resolved.
#include "trace/accel.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "math/frame.h"
#include "measure/statistics.h"
#include "scene/mesh_attributes.h"
#include "scene/surface.h"
#include "test_scene.h"

namespace chromeball {
namespace {

// Deterministic random numbers in [0, 1).
class Random {
 public:
  float next() { return toUnit(uint32_t(hash(++count_))); }
  vec2 next2() { return {next(), next()}; }

 private:
  uint64_t count_ = 0;
};

// Six quads of one mesh each, that face inwards.
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
  int escaped = 0;  // met nothing
  int stuck = 0;    // met the flat face they started from
  float largestOffset = 0;
};

// Follows a path inside a closed scene: every ray must meet another face. An escaped path starts
// again. A mesh of two triangles is one flat face; of more, each triangle is.
Leaks bounceAround(const Scene& scene, int rays) {
  const Accel accel(scene);
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
  const Mesh& mesh = scene.meshes[0];
  const vec3 inside = 0.5f * (bounds(scene).min + bounds(scene).max);
  (void)mesh;
  for (int i = 0; i < rays; ++i) {
    const Instance& instance = scene.instances[hit.instance];
    const vec3 corner = instance.toWorld.point(
        scene.meshes[instance.mesh].positions[scene.meshes[instance.mesh].triangles[hit.triangle].x]);
    const Surface surface =
        surfaceAt(scene, instance, hit.triangle, hit.barycentric, glm::normalize(inside - corner));
    leaks.largestOffset = std::max(leaks.largestOffset, surface.rayOffset);
    const vec3 direction =
        Frame(surface.geometricNormal).toWorld(squareToUniformHemisphere(random.next2()));
    Hit next;
    if (!accel.intersect({surface.rayOrigin(direction), direction}, 0, next)) {
      ++leaks.escaped;
      next = start();
    } else if (next.instance == hit.instance && (flatMeshes || next.triangle == hit.triangle)) {
      ++leaks.stuck;
      next = start();
    }
    hit = next;
  }
  return leaks;
}

TEST(AccelProbe, Measure) {
  for (float scale : {1e-4f, 1.0f, 1e7f})
    for (float offset : {0.0f, 1.0f, 10.0f, 100.0f, 1e3f, 1e4f, 1e6f}) {
      const vec3 centre = scale * offset * vec3(1, -0.7f, 0.4f);
      for (int shape = 0; shape < 2; ++shape) {
        const Leaks l =
            bounceAround(shape ? sphereScene(scale / 2, centre) : boxScene(scale, centre), 1000000);
        fmt::print("{} scale {} offset {}: escaped {} stuck {} offset/size {}\n",
                   shape ? "sphere" : "box", scale, offset, l.escaped, l.stuck,
                   l.largestOffset / scale);
      }
    }
}

}  // namespace
}  // namespace chromeball
