// SPDX-License-Identifier: Apache-2.0
#include "lighting/importance.h"

#include <array>
#include <cassert>
#include <numeric>

#include "base/parallel.h"
#include "base/progress.h"

namespace chromeball {
namespace {

// Compensation is not used if it leaves less than this fraction of the plain table's weight. For a
// constant probe rounding errors leave 1e-7.
constexpr double kMinCompensated = 1e-3;

double meanLuminance(const Probe& probe) {
  double sum = 0, weight = 0;
  for (int row = 0; row < probe.height(); ++row) {
    endIfCancelled();
    const double sine = std::sin(kPiD * (row + 0.5) / probe.height());
    double rowSum = 0;
    for (int x = 0; x < probe.width(); ++x) rowSum += luminance(probe.corners(x, row).c01);
    sum += rowSum * sine;
    weight += sine * probe.width();
  }
  return sum / weight;
}

}  // namespace

Importance::Importance(const Probe& probe, bool compensated)
    : probe_(probe),
      field_(probe),
      rows_(1, probe.cellRows()),
      columns_(probe.cellRows(), probe.width()),
      total_(tabulate()) {
  if (compensated && total_ > 0) {
    const double plain = total_;
    field_ = LuminanceField(probe, float(meanLuminance(probe)));
    total_ = tabulate();
    if (total_ < kMinCompensated * plain) {
      field_ = LuminanceField(probe);
      total_ = tabulate();
    }
  }
  scale_ = total_ > 0 ? float(1 / (total_ * field_.jacobian())) : 0;
}

// Fills both levels of the distribution; returns the sum of all cells' weights.
double Importance::tabulate() {
  std::vector<double> rowWeights(probe_.cellRows());
  parallelFor(0, probe_.cellRows(), [&](int row) {
    std::vector<double> cells(probe_.width());
    for (int x = 0; x < probe_.width(); ++x) cells[x] = field_.integral(x, row);
    rowWeights[row] = columns_.setRow(row, cells);
  });
  rows_.setRow(0, rowWeights);
  return std::accumulate(rowWeights.begin(), rowWeights.end(), 0.0);
}

DirectionSample Importance::sampleDirection(double u, double v) const {
  if (!(total_ > 0)) return {vec3(0, 1, 0), Rgb(0), 0};
  const int row = rows_.sample(0, v);
  const int column = columns_.sample(row, u);
  return sampleOf(column, row, u, v);
}

DirectionSample Importance::sampleOf(int column, int row, double u, double v) const {
  const LuminanceField::Point point = field_.sample(column, row, float(u), float(v));
  const float pdf = point.weight * scale_;
  return {point.direction, point.radiance / pdf, pdf};
}

void Importance::sample(const LightPoint&, const PixelSampler& sampler,
                        std::vector<DirectionSample>& out) const {
  const DirectionSample sample = sampleDirection(sampler.bits(dimension::kLight) * 0x1p-32,
                                                 sampler.bits(dimension::kLight + 1) * 0x1p-32);
  if (sample.pdf > 0) out.push_back(sample);
}

LightSource::Escaped Importance::escaped(const LightPoint&, const vec3& wi) const {
  return escapedAt(wi, probe_.locate(wi));
}

LightSource::Escaped Importance::escapedAt(const vec3& wi, const Probe::Position& position) const {
  const LuminanceField::Point seen = field_.at(wi, position);
  return {seen.radiance, seen.weight * scale_};
}

// Each loop prefetches what the next one reads.
bool Importance::sampleMany(std::span<const glm::uvec2> numbers,
                            std::span<DirectionSample> out) const {
  struct Place {
    double u, v;
    int column, row;
  };
  std::array<Place, kMaxMany> places;
  assert(numbers.size() <= kMaxMany);
  if (!(total_ > 0)) {
    for (DirectionSample& sample : out) sample.pdf = 0;
    return true;
  }
  for (size_t i = 0; i < numbers.size(); ++i) {
    Place& p = places[i];
    p.u = numbers[i].x * 0x1p-32, p.v = numbers[i].y * 0x1p-32;
    p.row = rows_.sample(0, p.v);
    columns_.prefetchGuide(p.row, p.u);
  }
  for (size_t i = 0; i < numbers.size(); ++i) columns_.prefetchCdf(places[i].row, places[i].u);
  for (size_t i = 0; i < numbers.size(); ++i) {
    Place& p = places[i];
    p.column = columns_.sample(p.row, p.u);
    probe_.prefetch(p.column, p.row);
  }
  for (size_t i = 0; i < numbers.size(); ++i) {
    const Place& p = places[i];
    out[i] = sampleOf(p.column, p.row, p.u, p.v);
  }
  return true;
}

void Importance::escapedMany(std::span<const Escape> rays, std::span<Escaped> out) const {
  std::array<Probe::Position, kMaxMany> positions;
  assert(rays.size() <= kMaxMany);
  for (size_t i = 0; i < rays.size(); ++i) {
    positions[i] = probe_.locate(rays[i].wi);
    probe_.prefetch(positions[i].column, positions[i].row);
  }
  for (size_t i = 0; i < rays.size(); ++i) out[i] = escapedAt(rays[i].wi, positions[i]);
}

float Importance::pdf(const vec3& wi) const { return escaped({}, wi).pdf; }

}  // namespace chromeball
