// SPDX-License-Identifier: Apache-2.0
// Light through bodies and sheets of glass, as pictures.
#include <gtest/gtest.h>

#include "probe/rasterize.h"
#include "probe/synth.h"
#include "shading/fresnel.h"
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

// One layer of a stack of parallel slabs: the index on its far side, and what passes of the light
// on the way to the next boundary.
struct Layer {
  double ior, passed;
};

// What a stack reflects and lets through together of a uniform white surrounding, by adding up the
// reflections between its boundaries from the last to the first:
//   R = r + (1-r)^2 a^2 R' / (1 - r a^2 R'),   T = (1-r) a T' / (1 - r a^2 R')
// with r Fresnel's reflectance at the angle that Snell's law gives there. `coat` is what another
// reflector on the first boundary, from outside alone, takes first.
double throughStack(std::vector<Layer> layers, double sine, double coat = 0) {
  double reflected = 0, through = 1;
  for (size_t i = layers.size(); i-- > 0;) {
    const double before = i > 0 ? layers[i - 1].ior : 1, s = sine / before;
    const double r = fresnelDielectric(float(std::sqrt(1 - s * s)), float(layers[i].ior / before));
    const double a = layers[i].passed, again = 1 - r * a * a * reflected;
    through = (1 - r) * a * through / again;
    reflected = r + (1 - r) * (1 - r) * a * a * reflected / again;
    if (i == 0) return coat + (1 - coat) * (reflected + through);
  }
  return 1;
}

// A large slab between y = top and y = bottom.
void addSlab(Scene& scene, const Material& m, float top, float bottom) {
  const int material = addMaterial(scene, m);
  addQuad(scene, material, {-99, top, 99}, {198, 0, 0}, {0, 0, -198});
  addQuad(scene, material, {-99, bottom, -99}, {198, 0, 0}, {0, 0, 198});
}

// Seen by parallel rays under an angle to the normal.
Rgb seenUnder(const Scene& scene, double sine, int samples) {
  const float s = float(sine), c = std::sqrt(1 - s * s);
  Camera camera = Camera::lookAt({0, 8 * c, 8 * s}, vec3(0), {0, 0, -1}, 0.4f);
  camera.orthographic = true;
  camera.halfHeight = 0.1f;
  return meanColor(
      renderScene(scene, camera, whiteProbe(), "importance", smallRender(8, 8, samples, 32))
          .film.mean());
}

// With faces at right angles to the view and aslant.
TEST(Transmission, aSlabAbsorbsByBeersLaw) {
  constexpr float kThickness = 0.5f;
  const Rgb attenuation(0.3f, 1, 3);
  for (const double sine : {0.0, 0.7})
    for (const float ior : {1.0f, 1.5f, 2.0f}) {
      Material m = glass(0, false);
      m.ior = ior;
      m.extended->attenuation = attenuation;
      Scene scene;
      addSlab(scene, m, 0, -kThickness);
      const Rgb mean = seenUnder(scene, sine, 1024);
      const double slant = std::sqrt(1 - sine * sine / (ior * ior));
      for (int c = 0; c < 3; ++c) {
        const double passed = std::exp(-attenuation[c] * kThickness / slant);
        EXPECT_NEAR(mean[c], throughStack({{ior, passed}, {1, 1}}, sine), 2e-3f) << ior << " " << c;
      }
    }
}

// Bodies within bodies: at each boundary the light is bent and reflected by the indices of the two
// that meet there, and absorbed by the innermost one. A fifth is not there.
TEST(Transmission, upToFourBodiesLieWithinEachOther) {
  const float iors[] = {1.5f, 1.2f, 2.0f, 1.33f, 2.4f};
  const float attenuations[] = {0.5f, 1.5f, 0.2f, 3, 9};
  for (const double sine : {0.0, 0.6})
    for (const int bodies : {2, 3, 4, 5}) {
      Scene scene;
      std::vector<Layer> down, up;
      const int innermost = std::min(bodies, 4) - 1;
      for (int i = 0; i < bodies; ++i) {
        Material m = glass(0, false);
        m.ior = iors[i];
        m.extended->attenuation = Rgb(attenuations[i]);
        addSlab(scene, m, 1 - 0.1f * float(i), 0.1f * float(i));
        if (i > innermost) continue;
        const double thickness = i < innermost ? 0.1 : 1 - 0.2 * i;
        const double slant = std::sqrt(1 - sine * sine / (iors[i] * iors[i]));
        down.push_back({iors[i], std::exp(-attenuations[i] * thickness / slant)});
        if (i < innermost) up.insert(up.begin(), down.back());
      }
      down.insert(down.end(), up.begin(), up.end());
      down.push_back({1, 1});
      EXPECT_NEAR(seenUnder(scene, sine, 1024).y, throughStack(down, sine), 3e-3)
          << bodies << " bodies, sine " << sine;
    }
}

// A coat lies on the outer side: it takes its share from light that comes in, and none from light
// that is reflected within.
TEST(Transmission, aCoatIsNotSeenFromInside) {
  Material m = glass(0, false);
  m.extended->clearcoat = 1;
  m.extended->attenuation = Rgb(1.2f);
  Scene scene;
  addSlab(scene, m, 0, -0.5f);
  EXPECT_NEAR(seenUnder(scene, 0, 4096).y,
              throughStack({{1.5, std::exp(-1.2 * 0.5)}, {1, 1}}, 0, 0.04), 1e-3);
}

// Through a prism each channel goes where Snell's law sends it with its own index, by the extension
// n -+ (n - 1) / (2 V) for red and blue, V = 20 / dispersion being Abbe's number. The radiance that
// the probe shows tells the angle in the plane of the rays.
TEST(Transmission, aPrismSplitsColoursByAbbesNumber) {
  constexpr double kApex = 30 * kPiD / 180, kSlope = 40, kOffset = 1.5, kIor = 1.6, kAbbe = 15;
  Material m = glass(0, false);
  m.ior = float(kIor);
  m.extended->dispersion = float(20 / kAbbe);
  Scene scene;  // the upper face is level; the lower one rises towards +X by the apex
  const int material = addMaterial(scene, m);
  const float rise = 18 * float(std::tan(kApex));
  addQuad(scene, material, {-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
  addQuad(scene, material, {-9, -rise - 0.1f, -9}, {18, rise, 0}, {0, 0, 18});
  const Probe probe(rasterize(Mapping::LatLong, {1024, 512}, 1, [&](const dvec3& d) {
    return dvec3(d.y < 0 ? kSlope * std::max(kOffset + std::atan2(d.x, -d.y), 0.0) : 0);
  }));
  Camera camera = topCamera(4, 20);
  camera.orthographic = true;
  camera.halfHeight = 0.05f;
  // Two boundaries: what is reflected within would need a third. What the first one reflects is
  // black.
  const Rgb seen = meanColor(
      renderScene(scene, camera, probe, "importance", smallRender(8, 8, 4096, 2)).film.mean());
  for (int c = 0; c < 3; ++c) {
    const double n = kIor + (c - 1) * (kIor - 1) / (2 * kAbbe);
    const double passed = (1 - fresnelDielectric(1, float(n))) *
                          (1 - fresnelDielectric(float(std::cos(kApex)), float(1 / n)));
    const double deviation = std::asin(n * std::sin(kApex)) - kApex;  // towards the thick end, -X
    EXPECT_NEAR(seen[c] / passed / kSlope - kOffset, -deviation, 3e-3) << "channel " << c;
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
