// SPDX-License-Identifier: Apache-2.0
#include "shading/extended_bsdf.h"

#include "scene/thin_wall.h"
#include "shading/anisotropic_table.h"
#include "shading/ggx.h"
#include "shading/glass_table.h"
#include "shading/thin_film.h"

namespace chromeball {
namespace {

// The coat as a black dielectric of index 1.5, with its own normal.
Bsdf coatBsdf(const ExtendedPoint& e, Surface surface, const vec3& wo, float mirrorAlpha) {
  surface.normal = e.clearcoatNormal;
  return Bsdf({Rgb(0), 0, e.clearcoatRoughness, Rgb(kCoatF0 * e.clearcoat), e.clearcoat}, surface,
              wo, mirrorAlpha);
}

}  // namespace

void prepareExtendedBsdf(const Material& m) {
  EnergyTable::get();
  if (m.extended->anisotropy > 0) AnisotropicTable::get();
  if (!isBlack(m.extended->sheenColor)) SheenTable::get();
  if (m.extended->transmission > 0 && !m.extended->thinWalled && m.roughness > 0) GlassTable::get();
}

template <class Self, class Function>
void ExtendedBsdf::forEachPart(Self& self, Function&& function) {
  if (self.coat_) function(*self.coat_);
  if (self.base_) function(*self.base_);
  if (self.brushed_) function(*self.brushed_);
  if (self.underFilm_) function(*self.underFilm_);
  if (self.sheen_) function(*self.sheen_);
  if (self.glass_) function(*self.glass_);
  if (self.sheet_) function(*self.sheet_);
}

ExtendedBsdf::ExtendedBsdf(const MaterialPoint& m, const ExtendedPoint& e,
                           const RefractiveIndex& index, const Surface& surface, const vec3& wo,
                           float mirrorAlpha)
    : normal_(surface.normal) {
  const bool inside = isInsideBody(surface, e);
  float through = 1;
  if (e.clearcoat > 0 && !inside) {
    const Bsdf coat = coatBsdf(e, surface, wo, mirrorAlpha);
    coat_ = {coat, 1, coat.albedo()};
    through -= coat.surfaceAlbedo();
  }
  if (!isBlack(e.sheenColor) && !inside) {
    const Sheen sheen(e.sheenColor, e.sheenRoughness, surface, wo);
    sheen_ = {sheen, through, through * sheen.albedo()};
    through *= 1 - sheen.surfaceAlbedo();
  }
  MaterialPoint base = m;
  Rgb metalF0 = m.baseColor;
  if (e.iridescence > 0) {
    const float cosine = glm::clamp(glm::dot(surface.normal, wo), 0.0f, 1.0f);
    const auto filmed = [&](const Rgb& f0) {
      return glm::mix(f0, thinFilmF0(f0, e.filmIor, e.filmThickness, cosine), e.iridescence);
    };
    if (m.dielectricF90 > 0)
      base.dielectricF0 = glm::min(filmed(m.dielectricF0), Rgb(m.dielectricF90));
    metalF0 = filmed(m.baseColor);
  }
  addBase(base, metalF0, e, index, surface, wo, mirrorAlpha, through);

  float total = 0;
  forEachPart(*this, [&](auto& part) { total += part.fraction; });
  forEachPart(*this, [&](auto& part) {
    part.fraction = total > 0 ? part.fraction / total : 0;
    hasBroad_ = hasBroad_ || part.lobe.has(Lobes::Broad);
    hasNarrow_ = hasNarrow_ || part.lobe.has(Lobes::Narrow);
  });
}

// Under a coloured film the lobe's diffuse part gets what the film lets through of its strongest
// colour; what passes of the others is a diffuse lobe of its own.
Rgb ExtendedBsdf::addMetallicRoughness(const MaterialPoint& m, const Rgb& diffuse,
                                       const Rgb& metalF0, const ExtendedPoint& e,
                                       const Surface& surface, const vec3& wo, float mirrorAlpha,
                                       float factor) {
  const auto add = [&](auto& part, const auto& lobeOf) {
    const auto lobe = lobeOf(m);
    part = {lobe, factor, factor * lobe.albedo()};
    normal_ = lobe.normal();
    Rgb reflected(lobe.surfaceAlbedo());
    if (e.iridescence == 0) return reflected;
    MaterialPoint grey = m;
    for (int c = 0; c < 3; ++c) {
      grey.dielectricF0 = Rgb(m.dielectricF0[c]);
      reflected[c] = lobeOf(grey).surfaceAlbedo();
    }
    const Rgb through = diffuse * glm::max(lobe.surfaceAlbedo() - reflected, 0.0f);
    if (isBlack(through)) return reflected;
    Surface beneath = surface;
    beneath.normal = normal_;
    const Bsdf lambert({through, 0, 1, Rgb(0), 0}, beneath, wo);
    underFilm_ = {lambert, factor, factor * lambert.albedo()};
    return reflected;
  };
  if (e.anisotropy == 0)
    return add(base_, [&](const MaterialPoint& p) {
      return Bsdf(p, diffuse, metalF0, surface, wo, mirrorAlpha);
    });
  return add(brushed_, [&](const MaterialPoint& p) {
    return Brushed(p, diffuse, metalF0, e.anisotropy, e.anisotropyTangent, surface, wo,
                   mirrorAlpha);
  });
}

void ExtendedBsdf::addBase(const MaterialPoint& m, const Rgb& metalF0, const ExtendedPoint& e,
                           const RefractiveIndex& index, const Surface& surface, const vec3& wo,
                           float mirrorAlpha, float factor) {
  const float transmission = e.transmission * (1 - m.metallic);
  if (e.thinWalled) {
    const Rgb reflected = addMetallicRoughness(m, m.baseColor * (1 - m.metallic - transmission),
                                               metalF0, e, surface, wo, mirrorAlpha, factor);
    if (transmission == 0) return;
    const bool smooth = m.roughness * m.roughness < ggx::kSmoothAlpha && e.iridescence == 0;
    const Rgb fraction = smooth
                             ? sheetTransmittance(m, e.transmission, glm::dot(surface.normal, wo))
                             : m.baseColor * transmission * (1.0f - reflected);
    const Sheet sheet(fraction, m.roughness, surface, wo, mirrorAlpha);
    sheet_ = {sheet, factor, factor * sheet.albedo()};
    return;
  }
  if (transmission > 0) {
    const Glass glass(m, index, surface, wo, mirrorAlpha);
    glass_ = {glass, factor * transmission, factor * transmission * glass.albedo()};
    normal_ = glass.normal();
  }
  if (transmission < 1) {
    MaterialPoint rest = m;  // of the same amount of metal, and less of the dielectric
    rest.metallic = m.metallic / (1 - transmission);
    addMetallicRoughness(rest, rest.baseColor * (1 - rest.metallic), metalF0, e, surface, wo,
                         mirrorAlpha, factor * (1 - transmission));
  }
}

Bsdf::Value ExtendedBsdf::evaluate(const vec3& wi, Lobes lobes) const {
  Bsdf::Value sum{Rgb(0), 0};
  forEachPart(*this, [&](const auto& part) {
    const Bsdf::Value v = part.lobe.evaluate(wi, lobes);
    sum.fCos += part.factor * v.fCos;
    sum.pdf += part.fraction * v.pdf;
  });
  return sum;
}

template <class Lobe>
bool ExtendedBsdf::samplePart(const Part<Lobe>& part, vec2 u, float lobe, BsdfSample& out) const {
  if (!part.lobe.sample(u, lobe, out)) return false;
  if (out.pdf == 0) {
    out.weight *= part.factor / part.fraction;
    return true;
  }
  return completeSample(evaluate(out.wi, out.lobes), out);
}

bool ExtendedBsdf::sample(vec2 u, float lobe, BsdfSample& out) const {
  bool chosen = false, passed = false;
  forEachPart(*this, [&](const auto& part) {
    if (chosen) return;
    if (lobe < part.fraction) {
      chosen = true;
      passed = samplePart(part, u, lobe / part.fraction, out);
    }
    lobe -= part.fraction;
  });
  return passed;
}

}  // namespace chromeball
