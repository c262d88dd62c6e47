// Light through bodies and sheets of glass, as pictures.
#include <gtest/gtest.h>

#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball {
namespace {

Probe whiteProbe() { return Probe(constantProbe({64, 32}, Rgb(1))); }

Material glass(float roughness, bool thinWalled) {
  Material m;
  m.metallic = 0;
  m.roughness = roughness;
  m.doubleSided = true;
  m.extended.emplace();
  m.extended->transmission = 1;
  m.extended->thinWalled = thinWalled;
  return m;
}

Rgb meanUnder(const Scene& scene, const Probe& probe, const std::string& strategy, int samples,
              int maxDepth, uint64_t seed = 0) {
  return meanColor(renderScene(scene, topCamera(4, 20), probe, strategy,
                               smallRender(16, 16, samples, maxDepth, seed))
                       .film.mean());
}

// A white furnace does not show what is inside it.
TEST(Transmission, aFurnaceHidesGlass) {
  for (float roughness : {0.0f, 0.4f})
    for (bool thinWalled : {false, true}) {
      Scene scene;
      addSphere(scene, addMaterial(scene, glass(roughness, thinWalled)), vec3(0), 1, 48);
      const Rgb mean = meanUnder(scene, whiteProbe(), "importance", 64, 64);
      EXPECT_NEAR(mean.y, 1, 0.01) << roughness << " " << thinWalled;
    }
}

// Seen straight on, a slab with faces at right angles to the view passes what Fresnel's equations
// and Beer's law say: T = (1-R)^2 a / (1 - R^2 a^2), and reflects R + R T a.
TEST(Transmission, aSlabAbsorbsByBeersLaw) {
  constexpr float kThickness = 0.5f;
  const Rgb attenuation(0.3f, 1, 3);
  for (float ior : {1.0f, 1.5f, 2.0f}) {
    Material m = glass(0, false);
    m.ior = ior;
    m.extended->attenuation = attenuation;
    Scene scene;
    const int material = addMaterial(scene, m);
    addQuad(scene, material, {-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
    addQuad(scene, material, {-9, -kThickness, -9}, {18, 0, 0}, {0, 0, 18});
    Camera camera = topCamera(4, 20);
    camera.orthographic = true;
    camera.halfHeight = 0.1f;
    const Rgb mean = meanColor(
        renderScene(scene, camera, whiteProbe(), "importance", smallRender(8, 8, 1024, 32))
            .film.mean());
    const float r = (ior - 1) / (ior + 1), reflectance = r * r;
    for (int c = 0; c < 3; ++c) {
      const float a = std::exp(-attenuation[c] * kThickness);
      const float t =
          (1 - reflectance) * (1 - reflectance) * a / (1 - reflectance * reflectance * a * a);
      EXPECT_NEAR(mean[c], reflectance + reflectance * t * a + t, 2e-3f) << ior << " " << c;
    }
  }
}

// A sphere of the same index within a body is not there; one of air is seen.
TEST(Transmission, nestedBodiesKnowTheirSurroundings) {
  const auto nested = [](float innerIor) {
    Scene scene;
    Material outer = glass(0, false), inner = glass(0, false);
    inner.ior = innerIor;
    addSphere(scene, addMaterial(scene, outer), vec3(0), 1, 48);
    if (innerIor > 0) addSphere(scene, addMaterial(scene, inner), vec3(0), 0.5f, 48);
    const Probe probe(gradientProbe({64, 32}, Rgb(1), {0.7, 0.2, 0.5}));
    return renderScene(scene, topCamera(4, 12), probe, "importance", smallRender(16, 16, 64, 32))
        .film.mean();
  };
  const Image alone = nested(0), same = nested(1.5f), air = nested(1);
  double unseen = 0, seen = 0;
  for (int y = 0; y < alone.height; ++y)
    for (int x = 0; x < alone.width; ++x) {
      unseen += std::fabs(alone.rgb(x, y).x - same.rgb(x, y).x);
      seen += std::fabs(alone.rgb(x, y).x - air.rgb(x, y).x);
    }
  EXPECT_LT(unseen, 0.1 * seen);
}

// Shadow rays pass a smooth sheet, so that the floor beneath is lit without noise; and however the
// light is sampled, at whatever depth paths end, it is the same light.
TEST(Transmission, sheetsColourTheLightBeneath) {
  Scene scene;
  Material sheet = glass(0, true);
  sheet.baseColor = {0.9f, 0.5f, 0.1f, 1};
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  addQuad(scene, addMaterial(scene, sheet), {-9, 1, 9}, {18, 0, 0}, {0, 0, -18});
  Camera camera = Camera::lookAt({0, 0.9f, 0}, {0, 0, 0}, {0, 0, -1}, 0.3f);
  const Probe probe(gradientProbe({64, 32}, Rgb(1), {0.7, 0.2, 0.5}));
  for (int maxDepth : {1, 4}) {
    const auto render = [&](const char* strategy) {
      return renderScene(scene, camera, probe, strategy, smallRender(8, 8, 1024, maxDepth));
    };
    const RenderResult found = render("bsdf"), sampled = render("importance");
    const Rgb a = meanColor(found.film.mean()), b = meanColor(sampled.film.mean());
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c] / b[c], 1, 0.01) << maxDepth;
    EXPECT_GT(b.x, 4 * b.z);
  }
}

// One sheet under a lamp straight above: (1 - F0) times the colour.
TEST(Transmission, aSheetPassesItsShareStraightOn) {
  Scene scene;
  Material sheet = glass(0, true);
  sheet.baseColor = {0.9f, 0.5f, 0.1f, 1};
  addQuad(scene, addMaterial(scene, sheet), {-9, 1, 9}, {18, 0, 0}, {0, 0, -18});
  const Accel accel(scene);
  const Rgb passed = accel.transmittance({{0.1f, 0, 0.2f}, {0, 1, 0}});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(passed[c], 0.96f * sheet.baseColor[c], 1e-5f);
  EXPECT_EQ(accel.transmittance({{0.1f, 0, 0.2f}, {0, 1, 0}, 0.5f}), Rgb(1));
}

}  // namespace
}  // namespace chromeball
