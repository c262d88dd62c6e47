// SPDX-License-Identifier: Apache-2.0
// BSDFs of materials with extensions: sampling, energy conservation, reciprocity.
#include <gtest/gtest.h>

#include "all_tables.h"
#include "math/sampler.h"
#include "shading/fresnel.h"
#include "shading/layered.h"
#include "sphere_test.h"

namespace chromeball::layered_bsdf_test {
namespace {

Surface flatSurface(bool frontFace = true) {
  Surface s{};
  s.geometricNormal = s.normal = {0, 0, 1};
  s.frontFace = frontFace;
  return s;
}

vec3 directionAt(float degrees) {
  const float a = degrees * kPi / 180;
  return {std::sin(a), 0, std::cos(a)};
}

MaterialPoint dielectric(float roughness, float ior = 1.5f, Rgb color = Rgb(1)) {
  const float r = (ior - 1) / (ior + 1);
  return {color, 0, roughness, Rgb(r * r), 1};
}

// A material with extensions.
struct Case {
  std::string name;
  MaterialPoint material;
  ExtendedPoint extended;
  RefractiveIndex index{Rgb(1.5f), 1.5f};
  bool frontFace = true;

  Layered from(float degrees, float mirrorAlpha = 0) const {
    return Layered(material, extended, index, flatSurface(frontFace), directionAt(degrees),
                   allTables(), mirrorAlpha);
  }
};

// White sheen lets no negative light through to the base, however smooth it is.
TEST(SheenLobe, ReflectsNoMoreThanAllLight) {
  for (const float roughness : {0.0f, 0.05f, 0.1f, 0.11f, 0.2f, 0.5f, 1.0f})
    for (float degrees = 0; degrees < 90; degrees += 0.25f) {
      const Sheen sheen(Rgb(1), roughness, flatSurface(), directionAt(degrees), allTables());
      EXPECT_LE(sheen.surfaceAlbedo(), 1) << roughness << " " << degrees;
    }
}

ExtendedPoint transmissive(float fraction, bool thinWalled) {
  ExtendedPoint e;
  e.transmission = fraction;
  e.thinWalled = thinWalled;
  return e;
}

ExtendedPoint coated(float clearcoat, float roughness, vec3 normal = {0, 0, 1}) {
  ExtendedPoint e;
  e.clearcoat = clearcoat;
  e.clearcoatRoughness = roughness;
  e.clearcoatNormal = normal;
  return e;
}

ExtendedPoint sheened(Rgb color, float roughness) {
  ExtendedPoint e;
  e.sheenColor = color;
  e.sheenRoughness = roughness;
  return e;
}

ExtendedPoint brushed(float strength) {
  ExtendedPoint e;
  e.anisotropy = strength;
  e.anisotropyTangent = glm::normalize(vec3(1, 1, 0));
  return e;
}

ExtendedPoint filmed(float ior, float thickness) {
  ExtendedPoint e;
  e.iridescence = 1;
  e.filmIor = ior;
  e.filmThickness = thickness;
  return e;
}

// Every lobe has an albedo of 1, so that no energy may be lost.
std::vector<Case> whiteCases(const std::vector<float>& roughnesses) {
  std::vector<Case> cases;
  for (float r : roughnesses) {
    const std::string at = " roughness " + std::to_string(r);
    for (float ior : {1.1f, 1.5f, 2.4f}) {
      const std::string of = at + " ior " + std::to_string(ior);
      const MaterialPoint glass = dielectric(r, ior);
      cases.push_back({"into glass" + of, glass, transmissive(1, false), {Rgb(ior), ior}});
      cases.push_back(
          {"out of glass" + of, glass, transmissive(1, false), {Rgb(1 / ior), ior}, false});
      cases.push_back({"sheet" + of, glass, transmissive(1, true)});
    }
    cases.push_back({"half glass" + at, dielectric(r), transmissive(0.5f, false)});
    cases.push_back({"half sheet" + at, dielectric(r), transmissive(0.5f, true)});
    MaterialPoint halfMetal = dielectric(r);
    halfMetal.metallic = 0.5f;
    cases.push_back({"half metal, half glass" + at, halfMetal, transmissive(0.5f, false)});
    cases.push_back(
        {"prism" + at, dielectric(r, 1.6f), transmissive(1, false), {{1.5f, 1.6f, 1.7f}, 1.6f}});
    cases.push_back({"coat" + at, dielectric(0.5f), coated(1, r)});
    MaterialPoint metal = dielectric(0.3f);
    metal.metallic = 1;
    cases.push_back({"thin coat on metal" + at, metal, coated(0.5f, r)});
    cases.push_back({"sheen" + at, dielectric(0.5f), sheened(Rgb(1), r)});
    cases.push_back({"faint sheen" + at, dielectric(0.5f), sheened(Rgb(0.3f), r)});
    for (float strength : {0.3f, 0.7f, 1.0f}) {
      const std::string by = at + " strength " + std::to_string(strength);
      cases.push_back({"brushed plastic" + by, dielectric(r), brushed(strength)});
      MaterialPoint brushedMetal = dielectric(r);
      brushedMetal.metallic = 1;
      cases.push_back({"brushed metal" + by, brushedMetal, brushed(strength)});
      brushedMetal.metallic = 0.5f;
      cases.push_back({"brushed half metal" + by, brushedMetal, brushed(strength)});
    }
    for (const auto& [filmIor, thickness] :
         {std::pair(1.3f, 250.0f), {1.8f, 300.0f}, {2.2f, 500.0f}}) {
      const std::string of = at + " film " + std::to_string(filmIor);
      cases.push_back({"plastic" + of, dielectric(r), filmed(filmIor, thickness)});
      Case brushedFilm{"brushed plastic" + of, dielectric(r), brushed(0.7f)};
      brushedFilm.extended.iridescence = 1;
      brushedFilm.extended.filmIor = filmIor;
      brushedFilm.extended.filmThickness = thickness;
      cases.push_back(brushedFilm);
      Case sheet{"sheet" + of, dielectric(r), filmed(filmIor, thickness)};
      sheet.extended.transmission = 0.5f;
      cases.push_back(sheet);
    }
    Case coatedGlass{"coated glass" + at, dielectric(0.4f), coated(1, r)};
    coatedGlass.extended.transmission = 1;
    coatedGlass.extended.thinWalled = false;
    cases.push_back(coatedGlass);
  }
  return cases;
}

TEST(SlowLayeredBsdf, samplesItsPdfOverTheGrid) {
  const std::vector<Case> cases = whiteCases({0.3f, 1});
  constexpr float kAngles[] = {25, 75};
  const int tests = int(cases.size() * std::size(kAngles));
  for (const Case& c : cases)
    for (float angle : kAngles) {
      const Layered bsdf = c.from(angle);
      const SphereTest test = testDirections(
          [&](int i) -> std::optional<vec3> {
            BsdfSample s;
            if (!bsdf.sample(random2(i, 0), random1(i, 2), s)) return std::nullopt;
            return s.wi;
          },
          [&](const vec3& wi) { return bsdf.evaluate(wi).pdf; }, 40000);
      EXPECT_LT(test.totalProbability, 1 + 3e-3) << c.name << " angle " << angle;
      EXPECT_GT(test.chiSquare.pValue, sidak(1e-3, tests)) << c.name << " angle " << angle;
    }
}

Rgb albedo(const Layered& bsdf, int samples) {
  glm::dvec3 sum(0);
  for (int i = 0; i < samples; ++i) {
    BsdfSample s;
    const vec2 u(toUnit(sobol(uint32_t(i), 0)), toUnit(sobol(uint32_t(i), 1)));
    if (bsdf.sample(u, toUnit(sobol(uint32_t(i), 2)), s)) sum += glm::dvec3(s.weight);
  }
  return Rgb(sum / double(samples));
}

TEST(SlowLayeredBsdf, whiteFurnaceLosesNothing) {
  for (const Case& c : whiteCases({0, 0.02f, 0.1f, 0.25f, 0.5f, 0.8f, 1}))
    for (float angle : {0.0f, 30.0f, 60.0f, 80.0f, 88.0f}) {
      const Rgb a = albedo(c.from(angle), 1 << 13);
      for (int k = 0; k < 3; ++k) {
        EXPECT_GT(a[k], 0.99f) << c.name << " angle " << angle;
        EXPECT_LT(a[k], 1.01f) << c.name << " angle " << angle;
      }
    }
}

// A smooth sheet transmits what the opaque surface scatters, with one normal for transmission and
// reflection, also where the shading normal is turned away from the viewer.
TEST(LayeredBsdf, sheetsWithTiltedNormalsLoseNothing) {
  for (const float tilt : {0.0f, 40.0f, 60.0f, 80.0f, 95.0f, 117.0f}) {
    Surface surface = flatSurface();
    surface.normal = directionAt(-std::min(tilt, 89.0f));
    const auto albedoOf = [&](float fraction) {
      const vec3 wo = directionAt(0.5f * tilt);  // at up to 1.5 tilt from the normal
      return albedo(Layered(dielectric(0), transmissive(fraction, true), {Rgb(1.5f), 1.5f}, surface,
                            wo, allTables()),
                    1 << 12)
          .x;
    };
    const float opaque = albedoOf(0);
    EXPECT_NEAR(albedoOf(0.5f), (opaque + 1) / 2, 0.01f) << tilt;
    EXPECT_NEAR(albedoOf(1), 1, 0.01f) << tilt;
  }
}

// KHR_materials_specular scales the reflection of glass and so its energy compensation; light that
// is not reflected is transmitted. Also at a boundary with another body, with a relative index.
TEST(SlowLayeredBsdf, glassOfAnySpecularStrengthLosesNothing) {
  struct Index {
    float ior, outer;
  };
  for (const Index index : {Index{1.0001f, 1},
                            {1.01f, 1},
                            {1.33f, 1},
                            {1.5f, 1},
                            {2.4f, 1},
                            {3, 1},
                            {1.5f, 1.33f},
                            {1.33f, 1.5f},
                            {1, 1.5f}})
    for (const bool frontFace : {true, false})
      for (const float specular : {0.0f, 0.3f, 1.0f})
        for (const Rgb& color : {Rgb(1), Rgb(0.1f, 0.6f, 3)})
          for (const float roughness : {0.0f, 0.05f, 0.2f, 0.45f, 0.7f, 1.0f})
            for (const float angle : {0.0f, 40.0f, 65.0f, 80.0f}) {
              Case c{"", dielectric(roughness, index.ior), transmissive(1, false)};
              const float eta = index.ior / index.outer;
              c.index = {Rgb(frontFace ? eta : 1 / eta), index.ior};
              c.frontFace = frontFace;
              c.material.dielectricF0 = glm::min(c.material.dielectricF0 * color, 1.0f) * specular;
              c.material.dielectricF90 = specular;
              const Rgb a = albedo(c.from(angle), 1 << 12);
              for (int k = 0; k < 3; ++k)
                ASSERT_NEAR(a[k], 1, 0.01f)
                    << "ior " << index.ior << " in " << index.outer << (frontFace ? "" : ", inside")
                    << ", specular " << specular << " color " << color[k] << ", roughness "
                    << roughness << ", angle " << angle;
            }
}

TEST(LayeredBsdf, weightsAreValueOverPdf) {
  for (const Case& c : whiteCases({0.3f, 0.7f})) {
    const Layered bsdf = c.from(50);
    for (int i = 0; i < 300; ++i) {
      BsdfSample s;
      if (!bsdf.sample(random2(i, 0), random1(i, 2), s) || s.isDelta) continue;
      const BsdfValue v = bsdf.evaluate(s.wi);
      ASSERT_NEAR(v.pdf, s.pdf, 1e-3f * s.pdf) << c.name;
      for (int k = 0; k < 3; ++k)
        ASSERT_NEAR(v.fCos[k] / v.pdf, s.weight[k], 1e-3f * (s.weight[k] + 1e-3f)) << c.name;
    }
  }
}

// The roughness limit only divides the lobes into broad and narrow ones: their sum is the BSDF, and
// each sample is of one kind.
TEST(LayeredBsdf, broadAndNarrowLobesSumToTheBsdf) {
  for (const float limit : {0.05f, 0.3f})
    for (const Case& c : whiteCases({0.1f, 0.4f, 0.8f})) {
      const Layered whole = c.from(50), parts = c.from(50, limit);
      for (int i = 0; i < 200; ++i) {
        const vec3 wi = squareToUniformSphere(random2(i, 0));
        const BsdfValue all = whole.evaluate(wi), broad = parts.evaluate(wi),
                        narrow = parts.evaluate(wi, Lobes::Narrow);
        ASSERT_NEAR(broad.pdf + narrow.pdf, all.pdf, 1e-4f * all.pdf) << c.name;
        for (int k = 0; k < 3; ++k)
          ASSERT_NEAR(broad.fCos[k] + narrow.fCos[k], all.fCos[k], 1e-4f * all.fCos[k]) << c.name;
        ASSERT_TRUE(narrow.pdf == 0 || parts.has(Lobes::Narrow)) << c.name;
        ASSERT_TRUE(broad.pdf == 0 || parts.has(Lobes::Broad)) << c.name;
        BsdfSample s;
        if (!parts.sample(random2(i, 0), random1(i, 2), s)) continue;
        const BsdfValue own = parts.evaluate(s.wi, s.lobes);
        ASSERT_NEAR(own.pdf, s.pdf, 1e-3f * s.pdf) << c.name;
        for (int k = 0; k < 3; ++k)
          ASSERT_NEAR(own.fCos[k] / own.pdf, s.weight[k], 1e-3f * (s.weight[k] + 1e-3f)) << c.name;
      }
    }
}

// The coat is on the outer side of a body only.
TEST(LayeredBsdf, bodiesHaveNoCoatFromInside) {
  for (const float roughness : {0.0f, 0.4f})
    for (const bool frontFace : {true, false}) {
      Case bare{"", dielectric(roughness), transmissive(1, false)};
      bare.frontFace = frontFace;
      if (!frontFace) bare.index = {Rgb(1 / 1.5f), 1.5f};
      Case coat = bare;
      coat.extended.clearcoat = 1;
      coat.extended.clearcoatRoughness = 0.3f;
      coat.extended.clearcoatNormal = {0, 0, 1};
      const Layered a = bare.from(40), b = coat.from(40);
      bool same = true;
      for (int i = 0; i < 500; ++i) {
        const vec3 wi = squareToUniformSphere(random2(i, 0));
        same = same && a.evaluate(wi).fCos == b.evaluate(wi).fCos;
      }
      EXPECT_EQ(same, !frontFace) << roughness;
    }
}

TEST(LayeredBsdf, smoothGlassAndSheetsAreDeltas) {
  for (const bool thinWalled : {true, false})
    for (const float roughness : {0.0f, 0.3f}) {
      const Case c{"", dielectric(roughness), transmissive(1, thinWalled)};
      const Layered bsdf = c.from(40);
      int samples = 0;
      for (int i = 0; i < 200; ++i) {
        BsdfSample s;
        if (!bsdf.sample(random2(i, 0), random1(i, 2), s)) continue;
        ++samples;
        ASSERT_EQ(s.isDelta, roughness == 0) << thinWalled;
        ASSERT_EQ(s.pdf == 0, s.isDelta) << thinWalled;
      }
      EXPECT_GT(samples, 100) << thinWalled << " " << roughness;
    }
}

// A base without specular reflection is a Lambert lobe and needs no tables.
TEST(LayeredBsdf, baseWithoutSpecularIsLambert) {
  const BsdfTables none({});
  const MaterialPoint matte{Rgb(0.8f), 0, 0.5f, Rgb(0), 0};
  const Layered bsdf(matte, {}, {}, flatSurface(), directionAt(30), none);
  const Lambert lambert(Rgb(0.8f), {0, 0, 1}, {0, 0, 1});
  for (int i = 0; i < 100; ++i) {
    const vec3 wi = squareToUniformSphere(random2(i, 0));
    ASSERT_EQ(bsdf.evaluate(wi).fCos, lambert.evaluate(wi).fCos);
    ASSERT_EQ(bsdf.evaluate(wi).pdf, lambert.evaluate(wi).pdf);
  }
}

// Fresnel at normal incidence and at Brewster's angle, total reflection, and Snell's law.
TEST(Dielectric, followsFresnelAndSnell) {
  for (float ior : {1.1f, 1.5f, 2.4f}) {
    const float r = (ior - 1) / (ior + 1);
    EXPECT_NEAR(fresnelDielectric(1, ior), r * r, 1e-6f);
    EXPECT_NEAR(fresnelDielectric(1, 1 / ior), r * r, 1e-6f);
    // At Brewster's angle, the reflectance is 0 for p-polarised and s^2 for s-polarised light.
    const float brewster = std::cos(std::atan(ior));
    const float s = (1 - ior * ior) / (1 + ior * ior);
    EXPECT_NEAR(fresnelDielectric(brewster, ior), s * s / 2, 1e-6f);
    const float critical = std::sqrt(1 - 1 / (ior * ior));
    EXPECT_EQ(fresnelDielectric(critical - 1e-3f, 1 / ior), 1);
    EXPECT_LT(fresnelDielectric(critical + 1e-3f, 1 / ior), 1);
    const vec3 wo = directionAt(40), wi = refracted(wo, {0, 0, 1}, ior);
    EXPECT_NEAR(glm::length(wi), 1, 1e-6f);
    EXPECT_NEAR(-wi.x * ior, wo.x, 1e-6f);
    EXPECT_LT(wi.z, 0);
  }
}

// Reciprocity of basic radiance: f(a to b) / n_a^2 is symmetric where there is no energy
// compensation.
TEST(LayeredBsdf, smootherGlassIsReciprocal) {
  constexpr float kIor = 1.5f, kRoughness = 0.2f;
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const vec3 above = squareToUniformHemisphere(random2(i, 0));
    const vec3 bent = refracted(above, {0, 0, 1}, kIor);
    const vec3 below = glm::normalize(bent + 0.03f * squareToUniformSphere(random2(i, 2)));
    if (above.z < 0.5f || below.z > -0.5f) continue;
    Surface back = flatSurface(false);
    back.normal = back.geometricNormal = {0, 0, -1};
    const Layered in(dielectric(kRoughness, kIor), transmissive(1, false), {Rgb(kIor), kIor},
                     flatSurface(), above, allTables());
    const Layered out(dielectric(kRoughness, kIor), transmissive(1, false), {Rgb(1 / kIor), kIor},
                      back, below, allTables());
    const float f = in.evaluate(below).fCos.x / -below.z;
    const float g = out.evaluate(above).fCos.x / above.z;
    if (f < 1e-3f) continue;
    ++compared;
    // Light from below is seen through the boundary with n = 1 above.
    ASSERT_NEAR(f / (kIor * kIor), g, 0.02f * g);
  }
  EXPECT_GT(compared, 100);
}

// A film changes the specular reflection of the base, but must not raise the total albedo above 1.
TEST(LayeredBsdf, filmsOnDielectricsDoNotGainEnergy) {
  for (float thickness : {0.0f, 150.0f, 400.0f, 1000.0f})
    for (float angle : {0.0f, 45.0f, 80.0f}) {
      Case c{"", dielectric(0.3f), {}};
      c.extended.iridescence = 1;
      c.extended.filmIor = 1.5f;
      c.extended.filmThickness = thickness;
      EXPECT_LT(maxComponent(albedo(c.from(angle), 1 << 12)), 1.005f) << thickness << " " << angle;
    }
}

// At normal incidence, rounding makes cosines slightly larger than 1.
TEST(LayeredBsdf, sheenIsFiniteAtNormalIncidence) {
  Surface surface = flatSurface();
  surface.normal.z = 1 + 2e-7f;
  const vec3 wo(0, 0, 1);
  const Layered bsdf(dielectric(0.5f), sheened(Rgb(1), 0.3f), {}, surface, wo, allTables());
  const BsdfValue v = bsdf.evaluate(wo);
  EXPECT_TRUE(isFinite(v.fCos));
  EXPECT_TRUE(std::isfinite(v.pdf));
}

TEST(ThinFilm, vanishesWithItsThickness) {
  for (float cosine : {1.0f, 0.7f, 0.3f})
    for (Rgb f0 : {Rgb(0.04f), Rgb(0.9f, 0.6f, 0.3f)}) {
      const Rgb none = thinFilmReflectance(f0, 1.5f, 0, cosine);
      const float c = 1 - cosine, grazing = c * c * c * c * c;
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(none[k], f0[k] + (1 - f0[k]) * grazing, 1e-4f);
        EXPECT_NEAR(thinFilmF0(f0, 1.5f, 0, cosine)[k], f0[k], 1e-4f);
      }
    }
}

// A film of air's index, or of its base's, has one boundary: the base's. (At other angles the
// Schlick term of the base under the film differs from Fresnel's.)
TEST(ThinFilm, withoutContrastChangesNothing) {
  const Rgb metal(0.9f, 0.5f, 0.2f);
  const Rgb asBase = thinFilmReflectance(Rgb(0.04f), 1.5f, 400, 1),
            asAir = thinFilmReflectance(metal, 1, 400, 1);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(asBase[c], 0.04f, 1e-4f);
    EXPECT_NEAR(asAir[c], metal[c], 1e-4f);
  }
}

// A film of index sqrt(n_base) cancels the reflection of green light if its thickness is 1/4 of the
// wavelength in it, and has no effect if it is 1/2.
TEST(ThinFilm, quarterWaveCoatingIsDark) {
  const float base = 1.9f, film = std::sqrt(base), f0 = 0.9f * 0.9f / (2.9f * 2.9f);
  const float quarter = 550 / (4 * film);
  EXPECT_LT(thinFilmReflectance(Rgb(f0), film, quarter, 1).y, 0.1f * f0);
  EXPECT_NEAR(thinFilmReflectance(Rgb(f0), film, 2 * quarter, 1).y, f0, 0.1f * f0);
}

// The highlight of a brushed surface is wide along the tangent, narrow across.
TEST(LayeredBsdf, brushedHighlightsSpreadAlongTheTangent) {
  MaterialPoint metal = dielectric(0.3f);
  metal.metallic = 1;
  const Layered bsdf(metal, brushed(0.8f), {}, flatSurface(), {0, 0, 1}, allTables());
  const vec3 along = glm::normalize(vec3(0.4f, 0.4f, 1)),
             across = glm::normalize(vec3(0.4f, -0.4f, 1));
  EXPECT_GT(bsdf.evaluate(along).fCos.x, 10 * bsdf.evaluate(across).fCos.x);
}

TEST(LayeredBsdf, sheetMirrorsItsHighlightBelow) {
  const Layered bsdf(dielectric(0.4f), transmissive(1, true), {Rgb(1.5f), 1.5f}, flatSurface(),
                     directionAt(30), allTables());
  // The maximum below the sheet is in the direction -wo, straight through.
  float maximum = 0, at = 0;
  for (float angle = 0; angle < 80; angle += 1) {
    const vec3 wi = directionAt(-angle);
    const float f = bsdf.evaluate({wi.x, 0, -wi.z}).fCos.x;
    if (f > maximum) maximum = f, at = angle;
  }
  EXPECT_NEAR(at, 30, 6);
}

}  // namespace
}  // namespace chromeball::layered_bsdf_test
