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

bool hasSources(const LaneTask& task) { return !task.world().sources.all.empty(); }

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
  sceneLights_.clear();
  shadows_.size = next.size = 0;
  shadows_.records.clear();
  for (size_t i = 0; i < paths.size; i += kLanes) scatterLanes(task, paths, depth, i, next);
  task.context.counts.bounce += next.size;
  traceShadowRays(task);
  if (hasSources(task)) sceneLights_.trace(task, keys);
  for (size_t k = 0; task.settings().caustics && k < next.size; ++k) {
    const size_t id = size_t(next.id[k]);
    task.guided.bounces[id].startRest(task.radiances[id]);
  }
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
  const Vector throughput = paths.throughput.load(i), position = vertices_.position.load(i);
  const Float8 ratio = ratiosOf(task, paths, i);
  const Int8 mayBeGuided = isHere & ~(ratio < kLeastGuideRatio);
  const GuidedBsdfLanes guided(bsdf, position, wo, mayBeGuided, task.settings().caustics);

  const Vector toLight = lights_.direction.load(i);
  const Float8 lightPdf = loadLanes(&lights_.pdf[i]);
  const BsdfLanesValue value = guided.evaluate(toLight);
  const Float8 weight = weightOfLightSample(task.settings().mis, lightPdf, value.pdf);
  const LanePacking lit(bitsOf(isHere & (lightPdf > 0) & ~isBlack(value.fCos)));
  const size_t s = shadows_.size;
  shadows_.rays.origin.store(s, vertices_.rayOrigin(i, toLight), lit);
  shadows_.rays.direction.store(s, toLight, lit);
  shadows_.radiance.store(s, throughput * (weight * value.fCos) * lights_.light.load(i), lit);
  lit.store(&shadows_.id[s], loadLanes(&paths.id[i]));
  shadows_.size += lit.count();
  if (task.context.records) recordSamples(i, lit.bits(), value, bsdf.normal());
  if (hasSources(task))
    sceneLights_.scatter(task, paths, depth, i, vertices_, guided, bsdf.normal(), throughput);

  const auto number = [&](int dimension) { return unitsOf(numbers_[size_t(dimension)], i); };
  const GuidedBsdfLanes::Bounce bounce =
      guided.sample(number(dimension::kBsdf), number(dimension::kBsdf + 1),
                    number(dimension::kLobe), number(dimension::kBounce));
  Vector weighted = throughput * bounce.weight;
  Int8 goesOn = isHere & bounce.isValid;
  if (guided.isGuided()) noteGuided(task, paths, i, bounce, goesOn, guided.fraction());
  if (depth >= kFirstRoulette) {  // as survivesRoulette()
    const Float8 largest = larger(larger(weighted.x, weighted.y), weighted.z);
    const Float8 guideRatio = smaller(ratio * bounce.ratio, L::splat(kLargestGuideRatio));
    const Float8 survival = smaller(largest * guideRatio, L::splat(1));
    goesOn &= ~(number(dimension::kRoulette) >= survival);
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
  on.store(&next.minAlpha[n], larger(minAlpha, widenedBy(widening, bounce.bsdfPdf)));
  next.size += on.count();
  if (!next.keepsVertices) return;
  next.position.store(n, position, on);
  next.normal.store(n, bsdf.normal(), on);
  next.throughputBefore.store(n, throughput, on);
}

Float8 ScatterLanes::ratiosOf(const LaneTask& task, const PathArrays& paths, size_t first) {
  Float8 ratios = L::splat(1);
  if (!task.settings().caustics) return ratios;
  for (size_t k = 0; k < kLanes && first + k < paths.size; ++k)
    ratios[k] = task.guided.ratio[size_t(paths.id[first + k])];
  return ratios;
}

// As PathTracer::noteGuided().
void ScatterLanes::noteGuided(const LaneTask& task, const PathArrays& paths, size_t first,
                              const GuidedBsdfLanes::Bounce& bounce, Int8 isHere, float fraction) {
  forBits(bitsOf(isHere), [&](unsigned k) {
    const size_t id = size_t(paths.id[first + k]);
    float& ratio = task.guided.ratio[id];
    ratio = std::min(ratio * bounce.ratio[k], kLargestGuideRatio);
    GuidedBounce& noted = task.guided.bounces[id];
    if (task.context.records && bounce.lobesPdf[k] > 0 && noted.record.lobesPdf == 0)
      noted = {{0, bounce.lobesPdf[k], bounce.bsdfPdf[k], fraction}, {}, true};
  });
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
