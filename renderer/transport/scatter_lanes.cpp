// SPDX-License-Identifier: Apache-2.0
#include "transport/scatter_lanes.h"

#include "transport/path_lanes.h"

namespace chromeball {
namespace {

using L = LanesOf<Float8>;
using Vector = Lanes3<Float8>;

// As toUnit().
Float8 unitsOf(const LaneArray<uint32_t>& bits, size_t i) {
  const Int8 b = Int8(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(&bits[i])));
  return L::toFloat(Int8(_mm256_srli_epi32(__m256i(b), 8))) * 0x1p-24f;
}

// The least alpha behind a bounce (spreadOf()); 0 without regularisation or behind a mirror.
Float8 widenedBy(Float8 widening, Float8 pdf) {
  const Float8 spread = smaller(L::splat(1), 1 / L::squareRoot(kPi * pdf));
  return pdf > 0 ? widening * spread : Float8{};
}

}  // namespace

void ScatterLanes::fillVertices(const LaneTask& task, const PathArrays& paths) {
  for (size_t k = 0; k < paths.size; ++k) {
    const Beam& beam = task.cameras.pixel(size_t(paths.id[k])).beam;
    crossSections_[k] = beam ? beam.crossSection(paths.length[k] + paths.hits.distance[k]) : 0;
  }
  vertices_.fill(task.world().scene, task.world().plain, paths.rays, paths.hits,
                 std::span(crossSections_).first(paths.size));
  for (size_t k = 0; k < paths.size; ++k) vertices_.isHidden[k] &= -(paths.pdf[k] == 0);
}

void ScatterLanes::drawNumbers(const LaneTask& task, const PathArrays& paths, int depth) {
  constexpr size_t kNumbers = dimension::kPerVertex;
  static_assert(kNumbers == kLanes);
  alignas(64) std::array<std::array<float, kNumbers>, kLanes> rows;  // bits
  const PixelSampler& sampler = task.context.sampler;
  for (size_t i = 0; i < paths.size; i += kLanes) {
    std::array<const float*, kLanes> begins;
    for (size_t k = 0; k < kLanes; ++k) {
      begins[k] = rows[k].data();
      if (i + k >= paths.size) continue;
      sampler.vertexBits(task.cameras.numbers(size_t(paths.id[i + k])), depth,
                         reinterpret_cast<uint32_t*>(rows[k].data()));
    }
    const auto columns = L::columns(begins);
    for (size_t d = 0; d < kNumbers; ++d)
      storeLanes(reinterpret_cast<int32_t*>(&numbers_[d][i]), Int8(columns[d]));
  }
}

void ScatterLanes::scatter(const LaneTask& task, const PathArrays& paths,
                           std::span<const uint32_t> keys, int depth, PathArrays& next) {
  drawNumbers(task, paths, depth);
  task.lighting().sampleArrays(std::span(numbers_[dimension::kLight]).first(paths.size),
                               numbers_[dimension::kLight + 1].data(), lights_);
  const std::span ids(paths.id.data(), paths.size);
  sceneLights_.draw(task.world(), task.cameras, ids, depth, vertices_, task.context);
  shadows_.size = next.size = 0;
  shadows_.records.clear();
  for (size_t i = 0; i < paths.size; i += kLanes) scatterLanes(task, paths, depth, i, next);
  task.context.counts.bounce += next.size;
  traceShadowRays(task);
  if (!sceneLights_.isEmpty()) sceneLights_.trace(task.tracer, keys, task.context, task.radiances);
}

// As PathTracer::scatterAs(), with DirectLight::deferDrawn().
void ScatterLanes::scatterLanes(const LaneTask& task, const PathArrays& paths, int depth, size_t i,
                                PathArrays& next) {
  const Int8 isHere = firstLanes(paths.size - i) & ~loadLanes(&vertices_.isHidden[i]);
  const Vector wo = L::splat(-1) * paths.rays.direction.load(i);
  MaterialLanes material = vertices_.material(i);
  const Float8 minAlpha = loadLanes(&paths.minAlpha[i]);
  material.roughness = larger(material.roughness, L::squareRoot(minAlpha));  // widen()
  const PlainBsdfLanes bsdf(material, vertices_.normal.load(i), vertices_.geometricNormal.load(i),
                            wo, task.world().bsdfTables.energy.get());
  const Vector throughput = paths.throughput.load(i);

  const Vector toLight = lights_.direction.load(i);
  const Float8 lightPdf = loadLanes(&lights_.pdf[i]);
  const BsdfLanesValue value = bsdf.evaluate(toLight);
  const Float8 weight = weightOfLightSample(task.settings().mis, lightPdf, value.pdf);
  const LanePacking lit(bitsOf(isHere & (lightPdf > 0) & ~isBlack(value.fCos)));
  const size_t s = shadows_.size;
  shadows_.rays.origin.store(s, vertices_.rayOrigin(i, toLight), lit);
  shadows_.rays.direction.store(s, toLight, lit);
  shadows_.radiance.store(s, throughput * (weight * value.fCos) * lights_.light.load(i), lit);
  lit.store(&shadows_.id[s], loadLanes(&paths.id[i]));
  shadows_.size += lit.count();
  if (task.context.records) recordSamples(i, lit.bits(), value, bsdf.normal());
  if (!sceneLights_.isEmpty())
    sceneLights_.scatter(i, bsdf, throughput, task.settings().mis, vertices_, paths.id);

  const BsdfLanesSample bounce = bsdf.sample(unitsOf(numbers_[dimension::kBsdf], i),
                                             unitsOf(numbers_[dimension::kBsdf + 1], i),
                                             unitsOf(numbers_[dimension::kLobe], i));
  Vector weighted = throughput * bounce.weight;
  Int8 goesOn = isHere & bounce.isValid;
  if (depth >= kFirstRoulette) {  // as survivesRoulette()
    const Float8 largest = larger(larger(weighted.x, weighted.y), weighted.z);
    const Float8 survival = smaller(largest, L::splat(1));
    goesOn &= ~(unitsOf(numbers_[dimension::kRoulette], i) >= survival);
    weighted = {weighted.x / survival, weighted.y / survival, weighted.z / survival};
  }
  const LanePacking on(bitsOf(goesOn));
  const size_t n = next.size;
  next.rays.origin.store(n, vertices_.rayOrigin(i, bounce.wi), on);
  next.rays.direction.store(n, bounce.wi, on);
  next.throughput.store(n, weighted, on);
  on.store(&next.pdf[n], bounce.pdf);
  on.store(&next.length[n], loadLanes(&paths.length[i]));
  on.store(&next.id[n], loadLanes(&paths.id[i]));
  on.store(&next.scattered[n], loadLanes(&paths.scattered[i]) | (bounce.pdf != 0));
  const Float8 widening = loadLanes(&paths.widening[i]);
  on.store(&next.widening[n], widening);
  on.store(&next.minAlpha[n], larger(minAlpha, widenedBy(widening, bounce.pdf)));
  next.size += on.count();
  if (!next.keepsVertices) return;
  next.position.store(n, vertices_.position.load(i), on);
  next.normal.store(n, bsdf.normal(), on);
  next.throughputBefore.store(n, throughput, on);
}

// As DirectLight::record().
void ScatterLanes::recordSamples(size_t first, unsigned lit, const BsdfLanesValue& value,
                                 const Vector& normal) {
  forBits(lit, [&](unsigned k) {
    const size_t i = first + k;
    const Rgb fCos(value.fCos.x[k], value.fCos.y[k], value.fCos.z[k]);
    const float pdf = lights_.pdf[i];
    shadows_.records.push_back({.position = vertices_.position.at(i),
                                .normal = {normal.x[k], normal.y[k], normal.z[k]},
                                .direction = lights_.direction.at(i),
                                .integrand = luminance(fCos * lights_.light.at(i)) * pdf,
                                .density = pdf + value.pdf[k],
                                .strategyPdf = pdf,
                                .bsdfPdf = value.pdf[k]});
  });
}

void ScatterLanes::traceShadowRays(const LaneTask& task) {
  task.context.counts.shadow += shadows_.size;
  task.world().accel.transmittance(shadows_.rays, std::span(transmittances_).first(shadows_.size),
                                   task.settings().visible);
  for (size_t k = 0; k < shadows_.size; ++k) {
    if (chromeball::isBlack(transmittances_[k])) continue;
    task.radiances[size_t(shadows_.id[k])] += shadows_.radiance.at(k) * transmittances_[k];
    if (task.context.records) task.context.addRecord(shadows_.records[k], transmittances_[k]);
  }
}

}  // namespace chromeball
