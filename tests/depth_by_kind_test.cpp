// SPDX-License-Identifier: Apache-2.0
// Limits of depth by the kind of lobe that chose a bounce: closed forms in an emitting sphere.
#include <gtest/gtest.h>

#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball::depth_by_kind_test {
namespace {

RenderResult renderInside(Material material, const RenderSettings& settings) {
  Scene scene;
  material.emission = Rgb(1);
  material.doubleSided = true;
  addSphere(scene, addMaterial(scene, material), {0, 0, 0}, -1, 24);
  const Camera camera = Camera::lookAt({0.1f, 0, 0}, {1, 0.2f, 0.3f}, {0, 1, 0}, 0.6f);
  const Probe black(constantProbe({16, 8}, Rgb(0)));
  return renderScene(scene, camera, black, "importance", settings);
}

// The radiance inside a closed sphere that emits 1.
double insideSphere(const Material& material, const RenderSettings& settings) {
  return luminance(meanColor(renderInside(material, settings).film.mean()));
}

RenderSettings limited(int diffuse, int specular, int maxDepth = 20) {
  RenderSettings settings = smallRender(8, 8, 256, maxDepth);
  settings.guiding = Guiding::Off;
  settings.maxDiffuseDepth = diffuse, settings.maxSpecularDepth = specular;
  return settings;
}

TEST(DepthByKind, DiffuseBouncesAreAGeometricSeries) {
  constexpr double kAlbedo = 0.6;
  double expected = 0, power = 1;
  for (int depth = 0; depth < 5; ++depth) {
    expected += power;
    power *= kAlbedo;
    const Material matte = lambert(Rgb(float(kAlbedo)));
    EXPECT_NEAR(insideSphere(matte, limited(depth, INT_MAX)), expected, 0.01 * expected) << depth;
  }
}

TEST(DepthByKind, SpecularBouncesAreASeriesToo) {
  Material mirror;  // white: each bounce adds 1
  mirror.roughness = 0;
  for (int depth = 0; depth < 5; ++depth)
    EXPECT_NEAR(insideSphere(mirror, limited(INT_MAX, depth)), 1 + depth, 0.02) << depth;
}

// d bounces of albedo a find the fraction 1 - a^(d+1) of the light.
TEST(SlowDepthByKind, TheCutFractionIsEstimatedWithoutBias) {
  constexpr double kAlbedo = 0.7;
  const Material matte = lambert(Rgb(float(kAlbedo)));
  Material metal;
  metal.baseColor = vec4(vec3(float(kAlbedo)), 1);
  metal.roughness = 0;
  for (const int depth : {0, 1, 3}) {
    const double expected = std::pow(kAlbedo, depth + 1);
    const auto check = [&](const Material& material, RenderSettings settings, DepthLimit own) {
      settings.width = settings.height = 16;
      settings.maxDepth = 100;
      const DepthCut cut = renderInside(material, settings).depthCut;
      for (const DepthLimit limit :
           {DepthLimit::Depth, DepthLimit::Diffuse, DepthLimit::Specular, DepthLimit::Transmission})
        if (limit != own) {
          EXPECT_EQ(cut.fraction(limit), 0) << depth;
        }
      EXPECT_NEAR(cut.fraction(own) / expected, 1, 0.15) << depth;
    };
    check(matte, limited(depth, INT_MAX), DepthLimit::Diffuse);
    check(matte, limited(depth, 0), DepthLimit::Diffuse);
    check(metal, limited(INT_MAX, depth), DepthLimit::Specular);
    check(metal, limited(0, depth), DepthLimit::Specular);
  }
  RenderSettings wide = limited(4, 4, 4);  // the limit of all bounces comes first
  EXPECT_EQ(renderInside(matte, wide).depthCut.fraction(DepthLimit::Diffuse), 0);
  EXPECT_FALSE(wide.path().limitsKinds());
}

TEST(DepthByKind, TheOtherLimitDoesNotMatter) {
  const Material matte = lambert(Rgb(0.6f));
  EXPECT_EQ(insideSphere(matte, limited(INT_MAX, 0, 4)), insideSphere(matte, limited(4, 0, 4)));
  EXPECT_EQ(insideSphere(matte, limited(INT_MAX, 0, 4)),
            insideSphere(matte, limited(INT_MAX, INT_MAX, 4)));
  Material mirror;
  mirror.roughness = 0;
  EXPECT_EQ(insideSphere(mirror, limited(0, INT_MAX, 4)),
            insideSphere(mirror, limited(INT_MAX, INT_MAX, 4)));
}

// A straight passage through a clear sheet is no bounce: the light of a floor below it does not
// depend on how it is found. Without reflection by the sheet, at any limit the same.
TEST(DepthByKind, PassingAClearSheetIsNoBounce) {
  Material sheet;
  sheet.metallic = sheet.roughness = 0;
  sheet.specular = 0;
  sheet.doubleSided = true;
  sheet.extended.emplace();
  sheet.extended->transmission = 1;
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
  addQuad(scene, addMaterial(scene, sheet), {-99, 1, 99}, {198, 0, 0}, {0, 0, -198});
  const Probe white(constantProbe({16, 8}, Rgb(1)));
  for (const char* strategy : {"importance", "uniform", "bsdf"})
    for (const int diffuse : {1, 8})
      for (const int specular : {0, 1, 8}) {
        RenderSettings settings = limited(diffuse, specular);
        const Rgb found =
            meanColor(renderScene(scene, topCamera(5, 10), white, strategy, settings).film.mean());
        EXPECT_NEAR(found.x, 0.5, 0.01) << strategy << diffuse << specular;
      }
}

// A plastic's parts of one bounce by each kind add up to all of it.
TEST(DepthByKind, OneBounceIsTheSumOfItsKinds) {
  for (const float roughness : {0.0f, 0.3f, 0.8f}) {
    Material plastic;
    plastic.baseColor = vec4(0.5f, 0.5f, 0.5f, 1);
    plastic.metallic = 0, plastic.roughness = roughness;
    const double all = insideSphere(plastic, limited(INT_MAX, INT_MAX, 1)) - 1;
    const double diffuse = insideSphere(plastic, limited(INT_MAX, 0, 1)) - 1;
    const double specular = insideSphere(plastic, limited(0, INT_MAX, 1)) - 1;
    EXPECT_GT(diffuse, 0.1);
    EXPECT_GT(specular, 0.02);
    EXPECT_NEAR(diffuse + specular, all, 0.01 * all) << roughness;
  }
}

TEST(DepthByKind, NoBouncesOfAnyKindLeaveEmission) {
  EXPECT_NEAR(insideSphere(lambert(Rgb(0.6f)), limited(0, 0)), 1, 1e-6);
  Material coated = lambert(Rgb(0.6f));
  coated.extended.emplace();
  coated.extended->clearcoat = 1;
  coated.extended->sheenColor = Rgb(0.5f);
  const double coat = insideSphere(coated, limited(0, 0));
  EXPECT_LE(coat, 1);  // the coat absorbs some of the emission
  EXPECT_GT(insideSphere(coated, limited(1, 0)), coat);
  EXPECT_GT(insideSphere(coated, limited(0, 1)), coat);
}

}  // namespace
}  // namespace chromeball::depth_by_kind_test
