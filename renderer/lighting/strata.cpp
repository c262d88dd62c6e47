// SPDX-License-Identifier: Apache-2.0
#include "lighting/strata.h"

#include "base/hash.h"

namespace chromeball {
namespace {

// The position of `target` in the interval from `before` to `after`, in [0, 1).
double positionIn(double before, double after, double target) {
  return std::clamp((target - before) / (after - before), 0.0, 0x1.fffffffffffffp-1);
}

}  // namespace

void Stratum::add(int column, int row, double weight) {
  if (runs_.empty() || runs_.back().row != row)
    runs_.push_back({row, uint32_t(columns_.size()), this->weight()});
  sums_.push_back(this->weight() + weight);
  columns_.push_back(column);
}

Stratum::Cell Stratum::choose(double& u, double& v) const {
  double target = v * weight();
  const auto next = std::upper_bound(runs_.begin() + 1, runs_.end(), target,
                                     [](double sum, const Run& run) { return sum < run.before; });
  const Run& run = *(next - 1);
  const bool last = next == runs_.end();
  const uint32_t end = last ? uint32_t(sums_.size()) : next->first;
  const double after = last ? weight() : next->before;
  v = positionIn(run.before, after, target);

  target = run.before + u * (after - run.before);
  const auto sum = std::upper_bound(sums_.begin() + run.first, sums_.begin() + end - 1, target);
  const uint32_t cell = uint32_t(sum - sums_.begin());
  u = positionIn(cell == run.first ? run.before : sums_[cell - 1], *sum, target);
  return {columns_[cell], run.row};
}

Strata::Strata(const Probe& probe, int regions)
    : ProbeLight(probe),
      field_(probe),
      partition_(kolligKellerRegions(probe.latLong(), regions)),
      strata_(partition_.regions),
      choice_(1, partition_.regions) {
  if (strata_.empty()) return;
  for (int row = 0; row < probe.cellRows(); ++row)
    for (int column = 0; column < probe.width(); ++column)
      if (const double weight = field_.integral(column, row); weight > 0)
        strata_[regionOf({column, row})].add(column, row, weight);
  std::vector<double> weights;
  for (const Stratum& stratum : strata_) weights.push_back(stratum.weight());
  total_ = choice_.setRow(0, weights);
}

float Strata::pdfScale(int region, int depth) const {
  const double weight = depth == 0 ? strata_[region].weight() : total_ / kLater;
  return float(1 / (weight * field_.jacobian()));
}

DirectionSample Strata::sampleCells(int region, double u, double v, float scale) const {
  const Stratum::Cell cell = strata_[region].choose(u, v);
  const LuminanceField::Point point = field_.sample(cell.column, cell.row, float(u), float(v));
  const float pdf = point.weight * scale;
  return {point.direction, point.radiance / pdf, pdf};
}

DirectionSample Strata::sampleRegion(int region, double u, double v) const {
  return sampleCells(region, u, v, pdfScale(region, 0));
}

void Strata::sample(const LightPoint& point, const PixelSampler& sampler,
                    std::vector<DirectionSample>& out) const {
  if (!(total_ > 0)) return;
  const uint32_t u = sampler.bits(dimension::kLight), v = sampler.bits(dimension::kLight + 1);
  const auto append = [&](const DirectionSample& sample) {
    if (sample.pdf > 0) out.push_back(sample);
  };
  if (point.depth > 0) {
    for (int k = 0; k < kLater; ++k) {
      double choice = (k + u * 0x1p-32) / kLater;
      const int region = choice_.sample(0, choice);
      append(sampleCells(region, choice, v * 0x1p-32, pdfScale(region, point.depth)));
    }
    return;
  }
  // All regions use the same stratified point, with a different digital shift in each.
  for (int region = 0; region < regions(); ++region) {
    if (!(strata_[region].weight() > 0)) continue;
    const uint64_t shift = hash(uint64_t(region));
    append(sampleRegion(region, (u ^ uint32_t(shift)) * 0x1p-32,
                        (v ^ uint32_t(shift >> 32)) * 0x1p-32));
  }
}

LightSource::Escaped Strata::escaped(const LightPoint& point, const vec3& wi) const {
  const Probe::Position p = probe_.locate(wi);
  const LuminanceField::Point seen = field_.at(wi, p);
  if (!(seen.weight > 0)) return {seen.radiance, 0};
  return {seen.radiance, seen.weight * pdfScale(regionOf(p), point.depth)};
}

}  // namespace chromeball
