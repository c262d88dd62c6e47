// SPDX-License-Identifier: Apache-2.0
// Emitting surfaces that coincide with others: a lamp gives only its visible light, however paths
// find it.
#include <gtest/gtest.h>

#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball::shared_places_test {
namespace {

Material lampOf(Rgb radiance) {
  Material m = lambert(Rgb(0));
  m.emission = radiance;
  m.doubleSided = false;
  return m;
}

Material sheetOf(Rgb color, Rgb emission = Rgb(0)) {
  Material m;
  m.baseColor = vec4(color, 1);
  m.metallic = m.roughness = m.specular = 0;
  m.doubleSided = true;
  m.emission = emission;
  m.extended.emplace();
  m.extended->transmission = 1;
  return m;
}

// A square at height 1 about the y axis.
void addSquare(Scene& scene, const Material& material, bool frontDown, float half = 1) {
  const vec3 x(2 * half, 0, 0), z(0, 0, 2 * half), corner(-half, 1, -half);
  addQuad(scene, addMaterial(scene, material), corner, frontDown ? x : z, frontDown ? z : x);
}

float render(const Scene& scene, const Camera& camera, Mis mis) {
  RenderSettings settings = smallRender(4, 4, 1024, 1);
  settings.mis = mis;
  const Probe black(constantProbe({16, 8}, Rgb(0)));
  return meanColor(renderScene(scene, camera, black, "importance", settings).film.mean()).x;
}

// A view straight from below, at the square's middle.
float seen(const Scene& scene) {
  return render(scene, Camera::lookAt({0, 0.1f, 0}, {0, 1, 0}, {0, 0, 1}, 0.1f), Mis::Balance);
}

// The radiance of a white floor under the middle of the square.
float ofFloor(Scene scene, Mis mis) {
  addQuad(scene, addMaterial(scene, lambert(Rgb(1))), {-1e-3f, 0, -1e-3f}, {0, 0, 2e-3f},
          {2e-3f, 0, 0});
  return render(scene, Camera::lookAt({0.3f, 0.5f, 0}, {0, 0, 0}, {0, 0, 1}, 1e-3f), mis);
}

// The form factor of a square of half edge 1 at distance 1, above its middle.
const float kFormFactor = 4 / kPi * std::sqrt(0.5f) * std::atan(std::sqrt(0.5f));

void expectAsSeen(const Scene& scene, float radiance, const std::string& what) {
  EXPECT_NEAR(seen(scene), radiance, 0.01f) << what;
  for (const Mis mis : {Mis::Balance, Mis::Power, Mis::Off})
    EXPECT_NEAR(ofFloor(scene, mis), radiance * kFormFactor, 0.012f) << what << " " << int(mis);
}

TEST(SharedPlaces, TwoLampsAtOnePlaceGiveTheLightOfOne) {
  Scene scene;
  addSquare(scene, lampOf(Rgb(1)), true);
  expectAsSeen(scene, 1, "alone");
  Scene twice = scene;
  addSquare(twice, lampOf(Rgb(1)), true);
  expectAsSeen(twice, 1, "twice");
  Scene divided = scene;  // into other triangles, which reach beyond
  const int lamp = addMaterial(divided, lampOf(Rgb(1)));
  for (int i = 0; i < 5; ++i)
    addQuad(divided, lamp, {-1, 1, -1 + 0.4f * float(i)}, {2, 0, 0}, {0, 0, 0.4f});
  expectAsSeen(divided, 1, "divided");
  Scene instances = scene;
  instances.instances[0].toWorld = Transform{};
  instances.instances.resize(3, instances.instances[0]);
  expectAsSeen(instances, 1, "instances");
  Scene moving = twice;
  for (Instance& instance : moving.instances) {
    auto motion = std::make_shared<InstanceMotion>();
    for (int k = 0; k < 2; ++k)
      motion->keys.push_back({moving.meshes.shared(instance.mesh), Transform{}});
    instance.toWorld = Transform{};
    instance.motion = motion;
    instance.moves = moving.moves = true;
  }
  expectAsSeen(moving, 1, "moving");
}

// Between two fronts the path meets the one that emits, between a front and a back the front, and
// an opaque surface rather than a sheet.
TEST(SharedPlaces, ALampGivesWhatIsSeenOfIt) {
  const Material dark = lambert(Rgb(0));
  Material darkOneSided = dark;
  darkOneSided.doubleSided = false;
  for (const bool lampFirst : {true, false}) {
    const auto pair = [&](const Material& lamp, const Material& other, bool otherDown) {
      Scene scene;
      if (lampFirst) addSquare(scene, lamp, true);
      addSquare(scene, other, otherDown);
      if (!lampFirst) addSquare(scene, lamp, true);
      return scene;
    };
    const std::string order = lampFirst ? ", lamp first" : ", lamp last";
    expectAsSeen(pair(lampOf(Rgb(1)), dark, true), 1, "two fronts" + order);
    expectAsSeen(pair(lampOf(Rgb(1)), darkOneSided, false), 1, "back of a wall" + order);
    Material twoSided = lampOf(Rgb(1));
    twoSided.doubleSided = true;
    expectAsSeen(pair(twoSided, dark, false), 1, "front of a lamp of two sides" + order);
    expectAsSeen(pair(sheetOf(Rgb(1), Rgb(1)), dark, true), 0, "sheet on a wall" + order);
    const Scene tinted = pair(sheetOf(Rgb(1), Rgb(1)), sheetOf(Rgb(0.5f)), true);
    expectAsSeen(tinted, lampFirst ? 1.0f : 0.5f, "sheet before or behind a tinted one" + order);
  }
}

// A frosted sheet on a lamp: paths come to the lamp over no distance.
TEST(SharedPlaces, ALampUnderAFrostedSheetGivesNoInvalidSample) {
  Scene scene;
  Material lamp = sheetOf(Rgb(1), Rgb(1)), frosted = sheetOf(Rgb(1));
  frosted.roughness = 0.5f;
  addSquare(scene, frosted, true);
  addSquare(scene, lamp, true);
  const Camera camera = Camera::lookAt({0, 0.1f, 0}, {0, 1, 0}, {0, 0, 1}, 0.1f);
  const Probe black(constantProbe({16, 8}, Rgb(0)));
  const RenderResult result =
      renderScene(scene, camera, black, "importance", smallRender(4, 4, 1024, 8));
  EXPECT_EQ(result.invalid.total(), 0u);
  EXPECT_NEAR(meanColor(result.film.mean()).x, 0.9f, 0.1f);
}

// The coordinates of a triangle in a coordinate plane are 0, but a node that was turned into it has
// rounding errors instead.
TEST(SharedPlaces, ALampInACoordinatePlaneIsFlushWithARoundedWall) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lampOf(Rgb(1))), {-1, 0, -1}, {2, 0, 0}, {0, 0, 2});
  Material wall = lambert(Rgb(0));
  wall.doubleSided = true;
  addQuad(scene, addMaterial(scene, wall), {-1.5f, -4e-7f, -1.5f}, {3, 0, 0}, {0, 4e-7f, 3});
  const Camera below = Camera::lookAt({0, -0.9f, 0}, {0, 0, 0}, {0, 0, 1}, 0.1f);
  EXPECT_NEAR(render(scene, below, Mis::Balance), 1, 0.01f);
  addQuad(scene, addMaterial(scene, lambert(Rgb(1))), {-1e-3f, -1, -1e-3f}, {0, 0, 2e-3f},
          {2e-3f, 0, 0});
  const Camera above = Camera::lookAt({0.3f, -0.5f, 0}, {0, -1, 0}, {0, 0, 1}, 1e-3f);
  for (const Mis mis : {Mis::Balance, Mis::Power, Mis::Off})
    EXPECT_NEAR(render(scene, above, mis), kFormFactor, 0.012f) << int(mis);
}

// Triangles of a lamp that touch at edges, walls that cross it, and surfaces before or behind it do
// not share its place, at any scale.
TEST(SharedPlaces, NeighboursDoNotShareAPlace) {
  for (const float scale : {1e-3f, 1.0f, 1e5f}) {
    Scene scene;
    const int lamp = addMaterial(scene, lampOf(Rgb(1))), wall = addMaterial(scene, lambert({}));
    addSphere(scene, lamp, {0, 0, 0}, scale, 16);
    const auto quad = [&](int material, vec3 corner, vec3 a, vec3 b) {
      addQuad(scene, material, scale * corner, scale * a, scale * b);
    };
    quad(lamp, {2, 0, 0}, {1, 0, 0}, {0, 1, 0.3f});
    quad(wall, {3, 0, 0}, {1, 0, 0}, {0, 1, 0.3f});      // beside it in its plane
    quad(wall, {2, 0.5f, -1}, {1, 0, 0}, {0, 0.1f, 2});  // crosses it
    quad(wall, {2, 0, 0.01f}, {1, 0, 0}, {0, 1, 0.3f});  // behind it
    const Accel accel(scene);
    const SharedPlaces shared(accel);
    for (uint32_t i = 0; i < scene.instances.size(); ++i)
      for (uint32_t t = 0; t < scene.meshes[size_t(scene.instances[i].mesh)].triangles.size(); ++t)
        EXPECT_FALSE(shared.contains(i, t)) << scale << ": " << i << " " << t;
    quad(wall, {2.9f, 0.1f, 0.03f}, {1, 0, 0}, {0, 0.5f, 0.15f});  // overlaps it by a tenth
    const Accel overlapping(scene);
    const SharedPlaces found(overlapping);
    const auto sharing = [&](uint32_t i) { return found.contains(i, 0) || found.contains(i, 1); };
    EXPECT_TRUE(sharing(1) && sharing(5)) << scale;
    EXPECT_FALSE(sharing(0) || sharing(2) || sharing(3) || sharing(4)) << scale;
  }
}

}  // namespace
}  // namespace chromeball::shared_places_test
