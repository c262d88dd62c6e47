// SPDX-License-Identifier: Apache-2.0
#include "shading/layered.h"

#include "scene/extended_surface.h"
#include "shading/fresnel.h"
#include "shading/ggx.h"

namespace chromeball {
namespace {

// The coat as a black dielectric of index 1.5, with its own normal.
MetallicRoughness coatOf(const ExtendedPoint& e, Surface surface, const vec3& wo,
                         const BsdfTables& tables, float mirrorAlpha) {
  surface.normal = e.clearcoatNormal;
  return MetallicRoughness(
      {Rgb(0), 0, e.clearcoatRoughness, Rgb(kCoatF0 * e.clearcoat), e.clearcoat}, surface, wo,
      tables, mirrorAlpha);
}

}  // namespace

template <class Self, class Function>
void Layered::forEachLobe(Self& self, Function&& function) {
  if (self.coat_) function(*self.coat_);
  if (self.metallicRoughness_) function(*self.metallicRoughness_);
  if (self.brushed_) function(*self.brushed_);
  if (self.lambert_) function(*self.lambert_);
  if (self.sheen_) function(*self.sheen_);
  if (self.glass_) function(*self.glass_);
  if (self.sheet_) function(*self.sheet_);
}

Layered::Layered(const MaterialPoint& m, const ExtendedPoint& e, const RefractiveIndex& index,
                 const Surface& surface, const vec3& wo, const BsdfTables& tables,
                 float mirrorAlpha)
    : normal_(surface.normal) {
  const bool inside = isInsideBody(surface, e);
  float through = 1;
  if (e.clearcoat > 0 && !inside) {
    const MetallicRoughness coat = coatOf(e, surface, wo, tables, mirrorAlpha);
    add(coat_, coat, 1);
    through -= coat.surfaceAlbedo();
  }
  if (!isBlack(e.sheenColor) && !inside) {
    const Sheen sheen(e.sheenColor, e.sheenRoughness, surface, wo, tables);
    add(sheen_, sheen, through);
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
  addBase({e, index, surface, wo, tables, mirrorAlpha}, base, metalF0, through);
  chooseProbabilities();
}

// Makes the probabilities proportional to what the lobes reflect, which is in `probability`.
void Layered::chooseProbabilities() {
  float total = 0;
  forEachLobe(*this, [&](auto& part) { total += part.probability; });
  forEachLobe(*this, [&](auto& part) {
    part.probability = total > 0 ? part.probability / total : 0;
    hasBroad_ = hasBroad_ || part.lobe.has(Lobes::Broad);
    hasNarrow_ = hasNarrow_ || part.lobe.has(Lobes::Narrow);
  });
}

void Layered::addBase(const Point& p, const MaterialPoint& m, const Rgb& metalF0, float weight) {
  const ExtendedPoint& e = p.extended;
  const float transmission = e.transmission * (1 - m.metallic);
  if (e.thinWalled) {
    const Rgb reflected =
        addOpaque(p, m, m.baseColor * (1 - m.metallic - transmission), metalF0, weight);
    if (transmission == 0) return;
    const bool smooth = m.roughness * m.roughness < kSmoothAlpha && e.iridescence == 0;
    const Rgb fraction = smooth ? sheetTransmittance(m, e.transmission, glm::dot(normal_, p.wo))
                                : m.baseColor * transmission * (1.0f - reflected);
    add(sheet_, Sheet(fraction, m.roughness, p.surface, p.wo, p.tables, p.mirrorAlpha), weight);
    return;
  }
  if (transmission > 0) {
    add(glass_, Glass(m, p.index, p.surface, p.wo, p.tables, p.mirrorAlpha), weight * transmission);
    normal_ = glass_->lobe.normal();
  }
  if (transmission < 1) {
    MaterialPoint rest = m;  // the metal, and the part of the dielectric that does not transmit
    rest.metallic = m.metallic / (1 - transmission);
    addOpaque(p, rest, rest.baseColor * (1 - rest.metallic), metalF0, weight * (1 - transmission));
  }
}

Rgb Layered::addOpaque(const Point& p, const MaterialPoint& m, const Rgb& diffuse,
                       const Rgb& metalF0, float weight) {
  const ExtendedPoint& e = p.extended;
  if (e.anisotropy > 0)
    return addOpaqueLobe(brushed_, p, m, diffuse, weight, [&](const MaterialPoint& material) {
      return Brushed(material, diffuse, metalF0, e.anisotropy, e.anisotropyTangent, p.surface, p.wo,
                     p.tables, p.mirrorAlpha);
    });
  if (m.metallic > 0 || m.dielectricF90 > 0)
    return addOpaqueLobe(metallicRoughness_, p, m, diffuse, weight,
                         [&](const MaterialPoint& material) {
                           return MetallicRoughness(material, diffuse, metalF0, p.surface, p.wo,
                                                    p.tables, p.mirrorAlpha);
                         });
  add(lambert_, Lambert(diffuse, p.surface.normal, p.surface.geometricNormal), weight);
  normal_ = p.surface.normal;
  return Rgb(0);
}

// Under a coloured film, the lobe's diffuse part is scaled by the film's smallest transmittance
// over the channels. The additional transmittance of the other channels is a separate diffuse lobe.
template <class Lobe, class LobeOf>
Rgb Layered::addOpaqueLobe(std::optional<Weighted<Lobe>>& to, const Point& p,
                           const MaterialPoint& m, const Rgb& diffuse, float weight,
                           const LobeOf& lobeOf) {
  const Lobe lobe = lobeOf(m);
  add(to, lobe, weight);
  normal_ = lobe.normal();
  Rgb reflected(lobe.surfaceAlbedo());
  if (p.extended.iridescence == 0) return reflected;
  MaterialPoint grey = m;
  for (int c = 0; c < 3; ++c) {
    grey.dielectricF0 = Rgb(m.dielectricF0[c]);
    reflected[c] = lobeOf(grey).surfaceAlbedo();
  }
  const Rgb through = diffuse * glm::max(lobe.surfaceAlbedo() - reflected, 0.0f);
  if (!isBlack(through))
    add(lambert_, Lambert(through, normal_, p.surface.geometricNormal), weight);
  return reflected;
}

BsdfValue Layered::evaluate(const vec3& wi, Lobes lobes) const {
  BsdfValue sum{Rgb(0), 0};
  forEachLobe(*this, [&](const auto& part) {
    const BsdfValue v = part.lobe.evaluate(wi, lobes);
    sum.fCos += part.weight * v.fCos;
    sum.pdf += part.probability * v.pdf;
  });
  return sum;
}

template <class Lobe>
bool Layered::sampleLobe(const Weighted<Lobe>& part, vec2 u, float choice, BsdfSample& out) const {
  if (!part.lobe.sample(u, choice, out)) return false;
  if (!out.isDelta) return completeSample(evaluate(out.wi, out.lobes), out);
  out.weight *= part.weight / part.probability;
  return true;
}

bool Layered::sample(vec2 u, float lobe, BsdfSample& out) const {
  bool chosen = false, passed = false;
  forEachLobe(*this, [&](const auto& part) {
    if (chosen) return;
    if (lobe < part.probability) {
      chosen = true;
      passed = sampleLobe(part, u, lobe / part.probability, out);
    }
    lobe -= part.probability;
  });
  return passed;
}

void Layered::addTo(MapLobes& lobes, float weight) const {
  forEachLobe(*this, [&](const auto& part) { part.lobe.addTo(lobes, weight * part.weight); });
}

void Layered::keepOnly(KeptLobes kept) {
  hasBroad_ = hasNarrow_ = false;
  forEachLobe(*this, [&](auto& part) {
    part.lobe.keepOnly(kept);
    part.probability = part.weight * part.lobe.albedo();
  });
  chooseProbabilities();
}

}  // namespace chromeball
