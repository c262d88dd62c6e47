// SPDX-License-Identifier: Apache-2.0
// Renders of light through bodies and thin sheets of glass.
#include <gtest/gtest.h>

#include "probe/convert.h"
#include "probe/synth.h"
#include "shading/fresnel.h"
#include "test_scene.h"

namespace chromeball::transmission_test {
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

// White furnace test.
TEST(Transmission, glassInAWhiteFurnaceIsInvisible) {
  for (float roughness : {0.0f, 0.4f})
    for (bool thinWalled : {false, true}) {
      Scene scene;
      addSphere(scene, addMaterial(scene, glass(roughness, thinWalled)), vec3(0), 1, 48);
      const Rgb mean = meanUnder(scene, whiteProbe(), "importance", 64, 64);
      EXPECT_NEAR(mean.y, 1, 0.01) << roughness << " " << thinWalled;
    }
}

// A boundary of a stack of parallel slabs: the index on its far side, and the transmittance of the
// medium from there to the next boundary.
struct Layer {
  double ior, transmittance;
};

// Radiance of a stack under constant radiance 1, R + T, summed over all reflections between its
// boundaries from the last to the first:
//   R = r + (1-r)^2 a^2 R' / (1 - r a^2 R'),   T = (1-r) a T' / (1 - r a^2 R')
// with r the Fresnel reflectance at the angle given by Snell's law and a the transmittance of the
// medium. `coat` is the reflectance of a coat on the outer side of the first boundary.
double stackRadiance(std::vector<Layer> layers, double sine, double coat = 0) {
  double reflected = 0, through = 1;
  for (size_t i = layers.size(); i-- > 0;) {
    const double before = i > 0 ? layers[i - 1].ior : 1, s = sine / before;
    const double r = fresnelDielectric(float(std::sqrt(1 - s * s)), float(layers[i].ior / before));
    const double a = layers[i].transmittance, again = 1 - r * a * a * reflected;
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

// Radiance seen by parallel rays at an angle to the normal, given by its sine.
Rgb radianceAt(const Scene& scene, double sine, int samples) {
  const float s = float(sine), c = std::sqrt(1 - s * s);
  Camera camera = Camera::lookAt({0, 8 * c, 8 * s}, vec3(0), {0, 0, -1}, 0.4f);
  camera.orthographic = true;
  camera.halfHeight = 0.1f;
  return meanColor(
      renderScene(scene, camera, whiteProbe(), "importance", smallRender(8, 8, samples, 32))
          .film.mean());
}

// Tested at normal and oblique incidence.
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
      const Rgb mean = radianceAt(scene, sine, 1024);
      const double slant = std::sqrt(1 - sine * sine / (ior * ior));
      for (int c = 0; c < 3; ++c) {
        const double transmittance = std::exp(-attenuation[c] * kThickness / slant);
        EXPECT_NEAR(mean[c], stackRadiance({{ior, transmittance}, {1, 1}}, sine), 2e-3f)
            << ior << " " << c;
      }
    }
}

// Nested bodies: refraction and reflection at a boundary depend on the indices on both sides, and
// absorption on the innermost body. At most four nested bodies are tracked: a fifth has no effect.
TEST(SlowTransmission, upToFourNestedBodies) {
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
      EXPECT_NEAR(radianceAt(scene, sine, 1024).y, stackRadiance(down, sine), 3e-3)
          << bodies << " bodies, sine " << sine;
    }
}

// A coat is on the outer side: it reflects light that arrives from outside, but not light inside
// the body.
TEST(Transmission, aCoatReflectsOnlyOutside) {
  Material m = glass(0, false);
  m.extended->clearcoat = 1;
  m.extended->attenuation = Rgb(1.2f);
  Scene scene;
  addSlab(scene, m, 0, -0.5f);
  EXPECT_NEAR(radianceAt(scene, 0, 4096).y,
              stackRadiance({{1.5, std::exp(-1.2 * 0.5)}, {1, 1}}, 0, 0.04), 1e-3);
}

// A prism refracts each channel by Snell's law with its own index: by KHR_materials_dispersion,
// n -+ (n - 1) / (2 V) for red and blue with Abbe number V = 20 / dispersion. The probe's radiance
// is a linear function of the angle in the plane of the rays, which gives the deviation.
TEST(Transmission, aPrismSplitsColoursByAbbesNumber) {
  constexpr double kApex = 30 * kPiD / 180, kSlope = 40, kOffset = 1.5, kIor = 1.6, kAbbe = 15;
  Material m = glass(0, false);
  m.ior = float(kIor);
  m.extended->dispersion = float(20 / kAbbe);
  Scene scene;  // the upper face is horizontal; the lower one rises towards +X by the apex angle
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
  // Maximum depth 2 excludes internal reflection. The first boundary reflects the black upper half
  // of the probe.
  const Rgb found = meanColor(
      renderScene(scene, camera, probe, "importance", smallRender(8, 8, 4096, 2)).film.mean());
  for (int c = 0; c < 3; ++c) {
    const double n = kIor + (c - 1) * (kIor - 1) / (2 * kAbbe);
    const double transmittance = (1 - fresnelDielectric(1, float(n))) *
                                 (1 - fresnelDielectric(float(std::cos(kApex)), float(1 / n)));
    const double deviation = std::asin(n * std::sin(kApex)) - kApex;  // towards the thick end, -X
    EXPECT_NEAR(found[c] / transmittance / kSlope - kOffset, -deviation, 3e-3) << "channel " << c;
  }
}

// A sphere inside a body of the same index is invisible; a sphere of air is visible.
TEST(Transmission, nestedBodiesUseRelativeIndices) {
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
  double sameDifference = 0, airDifference = 0;
  for (int y = 0; y < alone.height; ++y)
    for (int x = 0; x < alone.width; ++x) {
      sameDifference += std::fabs(alone.rgb(x, y).x - same.rgb(x, y).x);
      airDifference += std::fabs(alone.rgb(x, y).x - air.rgb(x, y).x);
    }
  EXPECT_LT(sameDifference, 0.1 * airDifference);
}

// The indices on both sides of a boundary are those of the channel: glass in glass of the same
// dispersion is invisible, and so is the boundary between two slabs of it that touch.
TEST(SlowTransmission, nestedBodiesUseTheIndicesOfEachChannel) {
  constexpr float kIor = 1.5f, kDispersion = 20, kAttenuation = 0.5f;
  constexpr double kSine = 0.8;
  for (const auto& spans : std::vector<std::vector<std::pair<float, float>>>{
           {{1, 0}}, {{1, 0}, {0.7f, 0.3f}}, {{1, 0.5f}, {0.5f, 0}}}) {
    Scene scene;
    for (const auto& [top, bottom] : spans) {
      Material m = glass(0, false);
      m.ior = kIor;
      m.extended->dispersion = kDispersion;
      m.extended->attenuation = Rgb(kAttenuation);
      addSlab(scene, m, top, bottom);
    }
    const Rgb found = radianceAt(scene, kSine, 4096);
    for (int c = 0; c < 3; ++c) {
      const double index = kIor + (c - 1) * (kIor - 1) * 0.025 * kDispersion;
      const double slant = std::sqrt(1 - kSine * kSine / (index * index));
      EXPECT_NEAR(found[c],
                  stackRadiance({{index, std::exp(-kAttenuation / slant)}, {1, 1}}, kSine), 4e-3)
          << spans.size() << " slabs, channel " << c;
    }
  }
}

// Shadow rays pass through smooth thin sheets. Light samples and BSDF samples give the same
// radiance of the floor below, at any maximum depth.
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

// At normal incidence, the transmittance of a sheet is (1 - F0) times its colour.
TEST(Transmission, sheetTransmittanceAtNormalIncidence) {
  Scene scene;
  Material sheet = glass(0, true);
  sheet.baseColor = {0.9f, 0.5f, 0.1f, 1};
  addQuad(scene, addMaterial(scene, sheet), {-9, 1, 9}, {18, 0, 0}, {0, 0, -18});
  const Accel accel(scene);
  const Rgb transmittance = accel.transmittance({{0.1f, 0, 0.2f}, {0, 1, 0}});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(transmittance[c], 0.96f * sheet.baseColor[c], 1e-5f);
  EXPECT_EQ(accel.transmittance({{0.1f, 0, 0.2f}, {0, 1, 0}, 0.5f}), Rgb(1));
}

}  // namespace
}  // namespace chromeball::transmission_test
