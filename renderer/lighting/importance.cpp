#include "lighting/importance.h"

#include <tbb/parallel_for.h>

#include <limits>
#include <numeric>

namespace chromeball {
namespace {

// Share of the plain table's weight below which compensation is not worth having: rounding alone
// leaves a constant probe 1e-7.
constexpr double kLeastCompensated = 1e-3;

// A number in [0, 1) with density proportional to a (1 - x) + b x.
float sampleLinear(float u, float a, float b) {
  const float root = std::sqrt(std::max(a * a + u * (b * b - a * a), 0.0f));
  return std::min(u * (a + b) / std::max(a + root, std::numeric_limits<float>::min()),
                  0x1.fffffep-1f);
}

double meanLuminance(const Probe& probe, const std::vector<float>& rowSine) {
  double sum = 0, weight = 0;
  for (int row = 1; row <= probe.height(); ++row) {
    double rowSum = 0;
    for (int x = 0; x < probe.width(); ++x) rowSum += luminance(probe.corners(x, row - 1).c01);
    sum += rowSum * rowSine[row];
    weight += double(rowSine[row]) * probe.width();
  }
  return sum / weight;
}

}  // namespace

Importance::Importance(const Probe& probe, bool compensated)
    : probe_(probe),
      rowSine_(probe.height() + 2),
      rows_(1, probe.cellRows()),
      columns_(probe.cellRows(), probe.width()) {
  for (int row = 1; row <= probe.height(); ++row)
    rowSine_[row] = float(std::sin(kPiD * (row - 0.5) / probe.height()));
  // The pole itself has no area, but must not have density 0 where it is lit.
  rowSine_.front() = rowSine_[1] / 8;
  rowSine_.back() = rowSine_[probe.height()] / 8;

  total_ = tabulate();
  if (compensated && total_ > 0) {
    const double plain = total_;
    offset_ = float(meanLuminance(probe, rowSine_));
    total_ = tabulate();
    if (total_ < kLeastCompensated * plain) {
      offset_ = 0;
      total_ = tabulate();
    }
  }
  const double jacobian = 2 * kPiD * kPiD / (double(probe.width()) * probe.height());
  scale_ = total_ > 0 ? float(1 / (total_ * jacobian)) : 0;
}

// Fills both levels of the distribution and returns the sum of all cells' weights.
double Importance::tabulate() {
  std::vector<double> rowWeights(probe_.cellRows());
  tbb::parallel_for(0, probe_.cellRows(), [&](int row) {
    std::vector<double> cells(probe_.width());
    const bool cap = row == 0 || row == probe_.height();
    for (int x = 0; x < probe_.width(); ++x) {
      const Weights w = weights(probe_.corners(x, row), row);
      cells[x] = (double(w.w00) + w.w10 + w.w01 + w.w11) * (cap ? 0.125 : 0.25);
    }
    rowWeights[row] = columns_.setRow(row, cells);
  });
  rows_.setRow(0, rowWeights);
  return std::accumulate(rowWeights.begin(), rowWeights.end(), 0.0);
}

Importance::Weights Importance::weights(const Probe::Corners& c, int row) const {
  const float top = rowSine_[row], bottom = rowSine_[row + 1];
  const auto weight = [&](const Rgb& radiance) {
    return std::max(luminance(radiance) - offset_, 0.0f);
  };
  return {weight(c.c00) * top, weight(c.c10) * top, weight(c.c01) * bottom, weight(c.c11) * bottom};
}

DirectionSample Importance::sampleDirection(double u, double v) const {
  if (!(total_ > 0)) return {vec3(0, 1, 0), Rgb(0), 0};
  Probe::Position p;
  p.row = rows_.sample(0, v);
  p.column = columns_.sample(p.row, u);
  const Probe::Corners corners = probe_.corners(p.column, p.row);
  const Weights w = weights(corners, p.row);
  p.t = sampleLinear(float(v), w.w00 + w.w10, w.w01 + w.w11);
  p.s = sampleLinear(float(u), (1 - p.t) * w.w00 + p.t * w.w01, (1 - p.t) * w.w10 + p.t * w.w11);
  const vec3 wi = probe_.direction(p);
  const float density = w.at(p.s, p.t) * scale_ / std::max(p.sinTheta, 1e-9f);
  return {wi, Probe::interpolate(corners, p.s, p.t) / density, density};
}

void Importance::sample(const LightPoint&, const PixelSampler& sampler,
                        std::vector<DirectionSample>& out) const {
  const DirectionSample sample = sampleDirection(sampler.bits(dimension::kLight) * 0x1p-32,
                                                 sampler.bits(dimension::kLight + 1) * 0x1p-32);
  if (sample.density > 0) out.push_back(sample);
}

LightingStrategy::Escaped Importance::escaped(const LightPoint&, const vec3& wi) const {
  const Probe::Position p = probe_.locate(wi);
  const Probe::Corners corners = probe_.corners(p.column, p.row);
  const float density =
      weights(corners, p.row).at(p.s, p.t) * scale_ / std::max(p.sinTheta, 1e-9f);
  return {Probe::interpolate(corners, p.s, p.t), density};
}

float Importance::density(const vec3& wi) const { return escaped({}, wi).density; }

}  // namespace chromeball
