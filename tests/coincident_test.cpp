// SPDX-License-Identifier: Apache-2.0
// Surfaces at one distance: a ray that passes one of them meets the others.
#include <gtest/gtest.h>

#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball::coincident_test {
namespace {

const Rgb kRed(0.8f, 0.1f, 0.1f), kGreen(0.1f, 0.8f, 0.1f);

Material oneSidedMatte(Rgb albedo) {
  Material m = lambert(albedo);
  m.doubleSided = false;
  return m;
}

Material sheetOfGlass(Rgb color = Rgb(1)) {
  Material m;
  m.baseColor = vec4(color, 1);
  m.metallic = 0;
  m.roughness = 0;
  m.doubleSided = true;
  m.extended.emplace();
  m.extended->transmission = 1;
  return m;
}

Material bodyOf(float ior, Rgb attenuation) {
  Material m = sheetOfGlass();
  m.ior = ior;
  const float r = (ior - 1) / (ior + 1);
  m.specular = r == 0 ? 0 : 1;
  m.extended->thinWalled = false;
  m.extended->attenuation = attenuation;
  return m;
}

// A square at height y, whose front faces up or down, oblique and larger than what a camera sees.
void addSquare(Scene& scene, int material, float y, bool frontUp, float half = 300) {
  const vec3 a(2 * half, 0, 0.1f * half), b(0, 0, -2 * half);
  addQuad(scene, material, {-half, y, half}, frontUp ? a : b, frontUp ? b : a);
}
void addSquare(Scene& scene, const Material& material, float y, bool frontUp, float half = 300) {
  addSquare(scene, addMaterial(scene, material), y, frontUp, half);
}

// A slab between two heights.
void addSlab(Scene& scene, const Material& material, float bottom, float top) {
  const int body = addMaterial(scene, material);
  addSquare(scene, body, bottom, false);
  addSquare(scene, body, top, true);
}

Rgb meanIn(const Scene& scene, const Camera& camera, const Image& probe, uint32_t samples = 64,
           const std::string& strategy = "importance", int depth = 6) {
  return meanColor(
      renderScene(scene, camera, Probe(probe), strategy, smallRender(8, 8, samples, depth))
          .film.mean());
}

Rgb meanInWhite(const Scene& scene, const Camera& camera, uint32_t samples = 64,
                const std::string& strategy = "importance") {
  return meanIn(scene, camera, constantProbe({16, 8}, Rgb(1)), samples, strategy);
}

Camera above(float height = 5) {
  return Camera::lookAt({0.4f, height, 0.3f}, {0, 0, 0}, {0, 0, -1}, 0.3f);
}
Camera below() { return Camera::lookAt({0.4f, -5, 0.3f}, {0, 0, 0}, {0, 0, -1}, 0.3f); }

void expectColor(const Rgb& found, const Rgb& expected, float tolerance, const std::string& what) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance) << what << " " << c;
}

// The camera sees the front, and never the probe behind a back.
TEST(Coincident, OfTwoSheetsBackToBackEachSideShowsItsFront) {
  for (const bool redFirst : {true, false}) {
    Scene scene;
    if (redFirst) addSquare(scene, oneSidedMatte(kRed), 0, true);
    addSquare(scene, oneSidedMatte(kGreen), 0, false);
    if (!redFirst) addSquare(scene, oneSidedMatte(kRed), 0, true);
    expectColor(meanInWhite(scene, above()), kRed, 0.01f, "from above");
    expectColor(meanInWhite(scene, below()), kGreen, 0.01f, "from below");
  }
}

TEST(Coincident, InstancesAndMovingSurfacesToo) {
  for (const bool moves : {false, true}) {
    Scene scene;
    addSquare(scene, oneSidedMatte(kRed), 0, true);
    scene.materials.push_back(oneSidedMatte(kGreen));
    // The same mesh, turned over about the x axis and back into the same plane.
    Instance turned = scene.instances[0];
    turned.material = 1;
    scene.instances[0].toWorld = Transform{};
    Transform over;
    over.linear = glm::mat3(vec3(1, 0, 0), vec3(0, -1, 0), vec3(0, 0, -1));
    turned.toWorld = over;
    scene.instances.push_back(turned);
    if (moves)
      for (Instance& instance : scene.instances) {
        auto motion = std::make_shared<InstanceMotion>();
        for (const float x : {0.0f, 1.0f}) {
          Transform at = *instance.toWorld;
          at.translation = {x, x, 0};
          motion->keys.push_back({scene.meshes.shared(0), at});
        }
        instance.motion = motion;
        instance.moves = scene.moves = true;
      }
    expectColor(meanInWhite(scene, above()), kRed, 0.01f, moves ? "moving" : "still");
    expectColor(meanInWhite(scene, below()), kGreen, 0.01f, moves ? "moving" : "still");
  }
}

// Diffuse bounces, mirrors and light samples see an opaque surface, whatever lies on it.
TEST(Coincident, AnOpaqueSurfaceHidesWhatIsBehindGlassOnIt) {
  Material rough = sheetOfGlass();
  rough.roughness = 0.5f;
  for (const Material& glass : {sheetOfGlass(), rough, bodyOf(1.5f, Rgb(0))})
    for (const bool glassFirst : {true, false}) {
      Scene scene;
      if (glassFirst) addSquare(scene, glass, 0, true);
      addSquare(scene, lambert(kRed), 0, true);
      if (!glassFirst) addSquare(scene, glass, 0, true);
      for (const char* strategy : {"importance", "bsdf"})
        expectColor(meanInWhite(scene, above(), 256, strategy), kRed, 0.02f, strategy);
    }
}

TEST(Coincident, ASheetOnARoofLetsNoLightThrough) {
  Scene roof;
  addSquare(roof, lambert(Rgb(0.5f)), 0, true, 1);
  addSquare(roof, lambert(Rgb(0.8f)), 1, true, 300);
  Scene covered = roof;
  addSquare(covered, sheetOfGlass(), 1, true, 300);
  const Camera camera = Camera::lookAt({0, 0.5f, 0.4f}, {0, 0, 0}, {0, 1, 0}, 0.3f);
  for (const char* strategy : {"importance", "bsdf"})
    EXPECT_EQ(meanInWhite(roof, camera, 64, strategy).x,
              meanInWhite(covered, camera, 64, strategy).x);
}

// The front of a roof that passes light from behind, over a floor: light samples and bounces agree
// whatever coincides with it, and neither a doubled roof nor a clear sheet on it changes the light.
TEST(Coincident, AFrontThatPassesLightFromBehindPassesItBehindASheet) {
  for (const std::string other : {"none", "same", "sheet", "opaque"}) {
    std::vector<float> found;
    for (const char* strategy : {"importance", "bsdf"}) {
      Scene scene;
      addSquare(scene, lambert(Rgb(0.5f)), -1, true);
      Material roof = oneSidedMatte(Rgb(0.5f));
      roof.singleSided = SingleSided::Light;
      addSquare(scene, roof, 0, false);
      Material sheet = sheetOfGlass();
      sheet.specular = 0;
      if (other == "same") addSquare(scene, roof, 0, false);
      if (other == "sheet") addSquare(scene, sheet, 0, true);
      if (other == "opaque") addSquare(scene, lambert(Rgb(0)), 0, true);
      const Camera inside = Camera::lookAt({0.4f, -0.2f, 0.3f}, {0, -1, 0}, {0, 0, -1}, 0.3f);
      found.push_back(meanInWhite(scene, inside, 512, strategy).x);
    }
    // Infinite sheets: the roof passes all light, and both reflect half of it, up to depth 6.
    float expected = 0;
    for (int i = 1; i <= 6; i += 2) expected += std::pow(0.5f, float(i));
    if (other == "opaque") expected = 0;
    for (const float mean : found) EXPECT_NEAR(mean, expected, 0.02f) << other;
  }
}

// Slabs that touch: exp(-sum of attenuation x thickness), from both sides and in any order.
TEST(Coincident, TouchingBodiesAbsorbInTurn) {
  const Rgb first(0.3f, 0.1f, 0), second(0.1f, 0.4f, 0.2f), third(0, 0.2f, 0.5f);
  const Rgb expected = glm::exp(-(first * 1.0f + second * 2.0f + third * 0.5f));
  for (int order = 0; order < 3; ++order) {
    Scene scene;
    for (int k = 0; k < 3; ++k) switch ((order + k) % 3) {
        case 0:
          addSlab(scene, bodyOf(1, first), 0, 1);
          break;
        case 1:
          addSlab(scene, bodyOf(1, second), 1, 3);
          break;
        default:
          addSlab(scene, bodyOf(1, third), 3, 3.5f);
      }
    for (const vec3& eye : {vec3(0.01f, 50, 0), vec3(0.01f, -50, 0)}) {
      const Camera camera = Camera::lookAt(eye, {0, 0, 0}, {0, 0, -1}, 0.01f);
      expectColor(meanInWhite(scene, camera, 256), expected, 0.015f, std::to_string(order));
    }
  }
}

// A boundary between glass and water refracts by their ratio: a slab of both loses less light by
// reflection than two slabs, at normal incidence 2 R_g + 2 R_w + 2 R_gw to first order in R.
TEST(Coincident, TouchingGlassAndWaterRefractAsOneBoundary) {
  const auto reflectance = [](double n1, double n2) {
    const double r = (n1 - n2) / (n1 + n2);
    return r * r;
  };
  for (const bool waterFirst : {true, false}) {
    Scene scene;
    if (waterFirst) addSlab(scene, bodyOf(1.33f, Rgb(0)), 0, 1);
    addSlab(scene, bodyOf(1.5f, Rgb(0)), 1, 2);
    if (!waterFirst) addSlab(scene, bodyOf(1.33f, Rgb(0)), 0, 1);
    expectColor(meanInWhite(scene, above(), 64), Rgb(1), 0.01f, "white");
    Material black = lambert(Rgb(0));
    addSquare(scene, black, -1, true);  // the camera sees a reflection
    // Incoherent layers (as of a pile of plates): r / (1 - r) adds.
    double ratio = 0;
    for (const double r : {reflectance(1, 1.5), reflectance(1.5, 1.33), reflectance(1.33, 1)})
      ratio += r / (1 - r);
    const Camera camera = Camera::lookAt({0.01f, 50, 0}, {0, 0, 0}, {0, 0, -1}, 0.01f);
    expectColor(meanInWhite(scene, camera, 2048), Rgb(float(ratio / (1 + ratio))), 2e-3f,
                "reflected");
  }
}

void addBox(Scene& scene, const Material& material, const vec3& low, const vec3& high) {
  const int body = addMaterial(scene, material);
  const vec3 size = high - low, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  for (const auto& [corner, a, b] : {std::tuple(low, z, y),
                                     {high, -y, -z},
                                     {low, x, z},
                                     {high, -z, -x},
                                     {low, y, x},
                                     {high, -x, -y}})
    addQuad(scene, body, corner, a, b);
}

// Bodies that overlap and share some of their outer faces: a path that one of these reflects at
// such a place stays in the medium where it was, and does not walk to and fro for ever.
TEST(Coincident, OverlappingBodiesWithFlushFacesAreAFurnace) {
  const vec3 low(-1), high(1);
  const std::pair<vec3, vec3> others[] = {{{0, -1, -1}, {2, 1, 1}},      // half of it
                                          {{-1, -1, -1}, {1, 0.4f, 1}},  // its lower part
                                          {low, high}};
  for (const auto& [first, second] : {std::pair(1.5f, 1.33f), {1.33f, 1.5f}, {1.5f, 1.5f}})
    for (const auto& [from, to] : others) {
      Scene scene;
      addBox(scene, bodyOf(first, Rgb(0)), low, high);
      addBox(scene, bodyOf(second, Rgb(0)), from, to);
      RenderSettings settings = smallRender(16, 16, 16, 50);
      settings.maxTransmissionDepth = 1000;
      const Image image =
          renderScene(scene, Camera::lookAt({0.3f, 1.5f, 4}, {0, 0, 0}, {0, 1, 0}, 40),
                      Probe(constantProbe({16, 8}, Rgb(1))), "importance", settings)
              .film.mean();
      for (const float texel : image.texels) EXPECT_NEAR(texel, 1, 1e-4f);
    }
}

// Any number of surfaces; a path meets a bounded number of them.
TEST(Coincident, ManySheetsAreAFurnace) {
  for (const int count : {2, 5, 8, 9, 40}) {
    Scene scene;
    for (int i = 0; i < count; ++i) addSquare(scene, sheetOfGlass(), 0, i % 2 == 0);
    expectColor(meanInWhite(scene, above(), 256), Rgb(1), 0.01f, std::to_string(count));
  }
}

// Two tinted sheets: light passes both, by the camera's rays and by shadow rays.
TEST(Coincident, TwoSheetsTintTwice) {
  Material tinted = sheetOfGlass({0.5f, 0.8f, 1});
  tinted.specular = 0;  // no reflection
  Scene scene;
  addSquare(scene, tinted, 1, true);
  addSquare(scene, tinted, 1, true);
  const Camera camera = Camera::lookAt({0, 5, 0.1f}, {0, 0, 0}, {0, 1, 0}, 0.1f);
  expectColor(meanInWhite(scene, camera), {0.25f, 0.64f, 1}, 1e-3f, "seen through");
  addSquare(scene, lambert(Rgb(0.5f)), 0, true);
  const Camera under = Camera::lookAt({0, 0.5f, 0.4f}, {0, 0, 0}, {0, 1, 0}, 0.1f);
  for (const char* strategy : {"importance", "bsdf"})
    expectColor(meanInWhite(scene, under, 512, strategy), 0.5f * Rgb(0.25f, 0.64f, 1), 0.01f,
                strategy);
}

// A blended body is there as a whole or not at all: alpha T + 1 - alpha.
// A surface that the camera's ray has passed is not met by another choice where the ray comes to a
// surface at the same place.
TEST(Coincident, CoverageInViewIsDecidedOnce) {
  Material half = oneSidedMatte(Rgb(0));
  half.baseColor.w = 0.5f;
  half.alphaMode = AlphaMode::Blend;
  for (const bool swapped : {false, true}) {
    const auto shown = [&](const Material& other, bool otherFrontUp) {
      Scene scene;
      if (swapped) addSquare(scene, other, 0, otherFrontUp);
      addSquare(scene, half, 0, true);
      if (!swapped) addSquare(scene, other, 0, otherFrontUp);
      return meanInWhite(scene, above(), 1024);
    };
    expectColor(shown(sheetOfGlass(), true), Rgb(0.5f), 0.01f, "with a clear pane");
    expectColor(shown(half, false), Rgb(0.5f), 0.01f, "of a leaf of two sheets");
  }
}

TEST(BlendedBody, ItsCoverageIsDecidedOnce) {
  const float attenuation = -std::log(0.75f) / 2;
  Material body = bodyOf(1, Rgb(attenuation));
  body.alphaMode = AlphaMode::Blend;
  body.baseColor.w = 0.5f;
  for (const bool wall : {false, true}) {
    Scene scene;
    addSlab(scene, body, 1, 3);
    if (wall) {
      Material white = lambert(Rgb(1));
      white.unlit = true;
      addSquare(scene, white, 0, true);
    }
    const Camera camera = Camera::lookAt({0.01f, 90, 0}, {0, 0, 0}, {0, 0, -1}, 0.01f);
    EXPECT_NEAR(meanInWhite(scene, camera, 4096).x, 0.875f, 0.004f) << wall;
  }
}

// A floor below a blended body, which blocks light samples where it is: both ways to find the light
// agree.
TEST(BlendedBody, LightSamplesAndBouncesAgree) {
  Material body = bodyOf(1.5f, Rgb(0.3f));
  body.alphaMode = AlphaMode::Blend;
  body.baseColor.w = 0.5f;
  Scene scene;
  addSlab(scene, body, 1, 2);
  addSquare(scene, lambert(Rgb(0.5f)), 0, true);
  const Camera under = Camera::lookAt({0, 0.5f, 0.4f}, {0, 0, 0}, {0, 1, 0}, 0.1f);
  const float sampled = meanInWhite(scene, under, 4096).x;
  EXPECT_NEAR(meanInWhite(scene, under, 4096, "bsdf").x, sampled, 0.01f * sampled);
  EXPECT_NEAR(meanInWhite(scene, under, 4096, "uniform").x, sampled, 0.01f * sampled);
}

// More copies of one instance at one place than a ray could visit.
TEST(Coincident, EqualInstancesCostNothing) {
  Scene scene;
  addSquare(scene, lambert(kRed), 0, true);
  scene.instances[0].toWorld = Transform{};
  scene.instances.resize(100000, scene.instances[0]);
  expectColor(meanInWhite(scene, above(), 256), kRed, 0.01f, "opaque");
  scene.materials[0] = sheetOfGlass();
  expectColor(meanInWhite(scene, above(), 256), Rgb(1), 0.01f, "sheets");
}

}  // namespace
}  // namespace chromeball::coincident_test
