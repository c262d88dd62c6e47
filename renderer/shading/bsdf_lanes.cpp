// SPDX-License-Identifier: Apache-2.0
#include "shading/bsdf_lanes.h"

namespace chromeball {
namespace {

using L = LanesOf<Float8>;
using Vector = Lanes3<Float8>;

Float8 zero() { return Float8{}; }
Float8 atMost1(Float8 x) { return smaller(x, L::splat(1)); }
Float8 largest(const Vector& v) { return larger(larger(v.x, v.y), v.z); }
Vector grey(Float8 x) { return {x, x, x}; }

template <class T>
T mixed(const T& x, const T& y, Float8 t) {
  return (1 - t) * x + t * y;
}

// As normalThatReflects().
Vector thatReflects(const Vector& normal, const Vector& geometricNormal, const Vector& wo) {
  const Vector mirrored = 2 * dot(normal, wo) * normal - wo;
  const Float8 height = dot(mirrored, geometricNormal);
  const Float8 minimum = 0.1f * atMost1(dot(wo, geometricNormal));
  const Int8 stays = height >= minimum;
  if (bitsOf(~stays) == 0) return normal;
  const Vector lifted = normalized(mirrored + (minimum - height) * geometricNormal);
  return chosen(stays, normal, normalized(lifted + wo));
}

// As GridPosition.
void position(Float8 t, int nodes, Int8& low, Float8& blend) {
  const Float8 inside = t > 0 ? t : zero();
  const Float8 x = atMost1(inside) * float(nodes - 1);
  low = L::toInt(x);
  low = low < nodes - 2 ? low : Int8{} + (nodes - 2);
  blend = x - L::toFloat(low);
}

Float8 multipleScattering(Float8 f0, Float8 f90, Float8 meanAlbedo) {
  const Float8 mean = f0 + (f90 - f0) * (1.0f / 21);
  return mean * mean * meanAlbedo / (1 - mean * (1 - meanAlbedo));
}

Vector multipleScattering(const Vector& f0, Float8 f90, Float8 meanAlbedo) {
  return {multipleScattering(f0.x, f90, meanAlbedo), multipleScattering(f0.y, f90, meanAlbedo),
          multipleScattering(f0.z, f90, meanAlbedo)};
}

// As ggx::lambda() and ggx::distribution().
Float8 lambda(Float8 z, Float8 alpha) {
  const Float8 z2 = z * z;
  return 0.5f * (L::squareRoot(1 + alpha * alpha * (1 - z2) / z2) - 1);
}
Float8 distribution(const Vector& h, Float8 alpha) {
  const Float8 e = (h.x * h.x + h.y * h.y) / (alpha * alpha) + h.z * h.z;
  return 1 / (kPi * alpha * alpha * e * e);
}

// As squareToCosineHemisphere().
Vector cosineHemisphere(Float8 u, Float8 v) {
  Float8 sine, cosine;
  sinCosTurns(u, sine, cosine);
  const Float8 r = L::squareRoot(v);
  return {r * cosine, r * sine, L::squareRoot(1 - v)};
}

}  // namespace

// Not inlined, here and below: each place could fuse other multiplications and additions, and a
// lane's bits would depend on the kinds of the other lanes.
[[gnu::noinline]] BsdfLanesValue LambertLanes::evaluate(const Vector& wi) const {
  const Float8 cosine = dot(frame_.z, wi);
  const Int8 isLit = ~((cosine <= 0) | (dot(geometricNormal_, wi) <= 0));  // NaN passes
  const Float8 pdf = isLit ? cosine * kInvPi : zero();
  return {chosen(isLit, pdf * albedo_, Vector{}), pdf};
}

[[gnu::noinline]] BsdfLanesSample LambertLanes::sample(Float8 u, Float8 v) const {
  BsdfLanesSample out;
  out.wi = frame_.toWorld(cosineHemisphere(u, v));
  out.weight = albedo_;
  out.pdf = dot(frame_.z, out.wi) * kInvPi;
  out.isValid = (out.pdf > 0) & (dot(geometricNormal_, out.wi) > 0);
  return out;
}

MetallicRoughnessLanes::Rows::Rows(const EnergyTable& energy, Float8 roughness) : table(energy) {
  position(L::squareRoot(roughness), EnergyTable::kRoughnesses, row, blend);
}

MetallicRoughnessLanes::Albedo MetallicRoughnessLanes::Rows::at(Float8 mu) const {
  Int8 low;
  Float8 along;
  position(L::squareRoot(mu), EnergyTable::kAngles, low, along);
  const auto line = [&](int below) {
    std::array<const float*, 8> nodes;
    for (int k = 0; k < 8; ++k) nodes[size_t(k)] = &table.node(row[k] + below, low[k]).a;
    const auto [a0, b0, a1, b1] = L::columns4(nodes);
    return Albedo{a0 + along * (a1 - a0), b0 + along * (b1 - b0)};
  };
  const Albedo x = line(0), y = line(1);
  return {x.a + blend * (y.a - x.a), x.b + blend * (y.b - x.b)};
}

MetallicRoughnessLanes::Albedo MetallicRoughnessLanes::Rows::average() const {
  std::array<const float*, 8> nodes;
  for (int k = 0; k < 8; ++k) nodes[size_t(k)] = &table.averageNode(row[k]).a;
  const auto [a0, b0, a1, b1] = L::columns4(nodes);
  return {a0 + blend * (a1 - a0), b0 + blend * (b1 - b0)};
}

MetallicRoughnessLanes::MetallicRoughnessLanes(const MaterialLanes& m, const Vector& normal,
                                               const Vector& geometricNormal, const Vector& wo,
                                               const EnergyTable& table)
    : energy_(table, m.roughness),
      geometricNormal_(geometricNormal),
      frame_(thatReflects(normal, geometricNormal, wo)),
      wo_(frame_.toLocal(wo)),
      alpha_(m.roughness * m.roughness),
      isSmooth_(alpha_ < kSmoothAlpha),
      f0_(mixed(m.dielectricF0, m.baseColor, m.metallic)),
      f90_(mixed(m.dielectricF90, L::splat(1), m.metallic)),
      dielectricF0_(largest(m.dielectricF0)),
      dielectricF90_(m.dielectricF90) {
  wo_.z = larger(wo_.z, L::splat(1e-6f));
  const Albedo toViewer = energy_.at(wo_.z), mean = energy_.average();
  const Float8 meanAlbedo = mean.a + mean.b;
  const Vector multiple =
      mixed(multipleScattering(m.dielectricF0, m.dielectricF90, meanAlbedo),
            multipleScattering(m.baseColor, L::splat(1), meanAlbedo), m.metallic);
  const Float8 lost = 1 - toViewer.a - toViewer.b, meanLost = 1 - meanAlbedo;
  const Vector multipleAlbedo = lost * multiple;
  multiple_ = chosen(meanLost > 1e-5f, (1 / meanLost) * multipleAlbedo, Vector{});

  dielectricMultiple_ = multipleScattering(dielectricF0_, dielectricF90_, meanAlbedo);
  const Vector diffuseAlbedo = (1 - dielectricAlbedo(toViewer)) * ((1 - m.metallic) * m.baseColor);
  const Float8 through = 1 - dielectricAlbedo(mean);
  diffuse_ = chosen(through > 1e-5f, (1 / through) * diffuseAlbedo, Vector{});

  const Float8 specular = luminance(toViewer.a * f0_ + grey(f90_ * toViewer.b));
  const Float8 albedo = specular + luminance(diffuseAlbedo + multipleAlbedo);
  specularProbability_ = albedo > 0 ? specular / albedo : L::splat(1);
}

Vector MetallicRoughnessLanes::schlick(Float8 cosine) const {
  const Float8 c = 1 - atMost1(cosine), c2 = c * c;
  return f0_ + (c2 * c2 * c) * (grey(f90_) - f0_);
}

[[gnu::noinline]] BsdfLanesValue MetallicRoughnessLanes::evaluate(const Vector& wi) const {
  const Vector local = frame_.toLocal(wi);
  const Int8 isLit = ~((local.z <= 0) | (dot(geometricNormal_, wi) <= 0));  // NaN passes
  const BsdfLanesValue v = evaluateLocal(local);
  return {chosen(isLit, v.fCos, Vector{}), isLit ? v.pdf : zero()};
}

BsdfLanesValue MetallicRoughnessLanes::evaluateLocal(const Vector& wi) const {
  const Float8 cosine = wi.z;
  const Albedo toLight = energy_.at(cosine);
  BsdfLanesValue v;
  v.fCos = (cosine * kInvPi) *
           ((1 - dielectricAlbedo(toLight)) * diffuse_ + (1 - toLight.a - toLight.b) * multiple_);
  v.pdf = (1 - specularProbability_) * cosine * kInvPi;
  if (bitsOf(~isSmooth_) == 0) return v;
  const Vector h = normalized(wo_ + wi);
  const Float8 d = distribution(h, alpha_) / (4 * wo_.z), lambdaO = lambda(wo_.z, alpha_);
  const Vector specular = (d / (1 + lambdaO + lambda(wi.z, alpha_))) * schlick(dot(wo_, h));
  v.fCos = chosen(isSmooth_, v.fCos, v.fCos + specular);
  v.pdf = isSmooth_ ? v.pdf : v.pdf + specularProbability_ * d / (1 + lambdaO);
  return v;
}

// As ggx::sampleVisibleNormal(); the macroscopic normal where the surface is smooth.
Vector MetallicRoughnessLanes::visibleNormal(Float8 u, Float8 v) const {
  const Vector stretched = normalized(Vector{alpha_ * wo_.x, alpha_ * wo_.y, wo_.z});
  const Float8 z = (1 - v) * (1 + stretched.z) - stretched.z;
  Float8 sine, cosine;
  sinCosTurns(u, sine, cosine);
  const Float8 r = L::squareRoot(larger(zero(), (1 - z) * (1 + z)));
  const Vector h = Vector{r * cosine, r * sine, z} + stretched;
  const Vector rough = normalized(Vector{alpha_ * h.x, alpha_ * h.y, larger(zero(), h.z)});
  return chosen(isSmooth_, Vector{zero(), zero(), L::splat(1)}, rough);
}

[[gnu::noinline]] BsdfLanesSample MetallicRoughnessLanes::sample(Float8 u, Float8 v,
                                                                 Float8 lobe) const {
  const Int8 isSpecular = lobe < specularProbability_;
  const Vector h = visibleNormal(u, v);
  const Vector mirrored = 2 * dot(wo_, h) * h - wo_;
  const Vector local = chosen(isSpecular, mirrored, cosineHemisphere(u, v));
  const Int8 isDelta = isSpecular & isSmooth_;
  BsdfLanesSample out;
  out.wi = frame_.toWorld(local);
  const BsdfLanesValue value = evaluate(out.wi);
  out.pdf = isDelta ? zero() : value.pdf;
  out.weight =
      chosen(isDelta, (1 / specularProbability_) * schlick(wo_.z), (1 / value.pdf) * value.fCos);
  // As MetallicRoughness::sample(): NaN passes, to be counted.
  const Int8 isAbove = ~(local.z <= 0) & ~(dot(geometricNormal_, out.wi) <= 0);
  out.isValid = isDelta ? isAbove : (~isSpecular | isAbove) & ~(value.pdf <= 0);
  return out;
}

PlainBsdfLanes::PlainBsdfLanes(const MaterialLanes& m, const Vector& normal,
                               const Vector& geometricNormal, const Vector& wo,
                               const EnergyTable* table)
    : isLambertian_(~((m.metallic > 0) | (m.dielectricF90 > 0))),
      lambert_((1 - m.metallic) * m.baseColor, normal, geometricNormal) {
  if (bitsOf(~isLambertian_) != 0)
    metallicRoughness_.emplace(m, normal, geometricNormal, wo, *table);
}

Vector PlainBsdfLanes::normal() const {
  if (!metallicRoughness_) return lambert_.normal();
  return chosen(isLambertian_, lambert_.normal(), metallicRoughness_->normal());
}

Int8 PlainBsdfLanes::hasBroad() const {
  return metallicRoughness_ ? isLambertian_ | metallicRoughness_->hasBroad() : isLambertian_;
}

BsdfLanesValue PlainBsdfLanes::evaluate(const Vector& wi) const {
  if (!metallicRoughness_) return lambert_.evaluate(wi);
  const BsdfLanesValue other = metallicRoughness_->evaluate(wi);
  if (bitsOf(isLambertian_) == 0) return other;
  const BsdfLanesValue diffuse = lambert_.evaluate(wi);
  return {chosen(isLambertian_, diffuse.fCos, other.fCos), isLambertian_ ? diffuse.pdf : other.pdf};
}

BsdfLanesSample PlainBsdfLanes::sample(Float8 u, Float8 v, Float8 lobe) const {
  if (!metallicRoughness_) return lambert_.sample(u, v);
  const BsdfLanesSample other = metallicRoughness_->sample(u, v, lobe);
  if (bitsOf(isLambertian_) == 0) return other;
  const BsdfLanesSample diffuse = lambert_.sample(u, v);
  return {chosen(isLambertian_, diffuse.wi, other.wi),
          chosen(isLambertian_, diffuse.weight, other.weight),
          isLambertian_ ? diffuse.pdf : other.pdf, isLambertian_ ? diffuse.isValid : other.isValid};
}

}  // namespace chromeball
