// SPDX-License-Identifier: Apache-2.0
#include "lighting/importance.h"

#include <array>
#include <cassert>
#include <numeric>

#include "base/parallel.h"
#include "base/progress.h"
#include "lighting/light_arrays.h"

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

constexpr int kWidth = LanesOf<Float8>::kCount;

// Calls visit(first, count) for groups of lanes.
template <class Visit>
void forLanes(size_t size, const Visit& visit) {
  for (size_t first = 0; first < size; first += kWidth)
    visit(first, int(std::min<size_t>(kWidth, size - first)));
}

// Positions on the probe, in lanes, and their directions.
using Positions = std::array<Probe::PositionOf<Float8>, kMostInArrays / kWidth>;
Positions located(const Probe& probe, const LaneArrays3& directions, size_t count) {
  assert(count <= kMostInArrays);
  Positions positions;
  forLanes(count, [&](size_t first, int some) {
    const auto& p = positions[first / kWidth] = probe.locate(directions.load(first));
    for (int k = 0; k < some; ++k) probe.prefetch(p.column[k], p.row[k]);
  });
  return positions;
}

template <class Ray>
void copyDirections(std::span<const Ray> rays, LaneArrays3& directions) {
  for (size_t i = 0; i < rays.size(); ++i) directions.set(i, rays[i].wi);
}

}  // namespace

Importance::Importance(const Probe& probe, bool compensated)
    : ProbeLight(probe),
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
  float inColumn, inRow;
  const int row = rows_.sample(0, uint32_t(v * 0x1p32), inRow);
  const int column = columns_.sample(row, uint32_t(u * 0x1p32), inColumn);
  const LuminanceField::Point point = field_.sample(column, row, inColumn, inRow);
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
  const LuminanceField::Point seen = field_.at(wi, probe_.locate(wi));
  return {seen.radiance, seen.weight * scale_};
}

bool Importance::sampleMany(std::span<const glm::uvec2> numbers,
                            std::span<DirectionSample> out) const {
  std::array<uint32_t, kMaxMany> u{}, v{};
  for (size_t i = 0; i < numbers.size(); ++i) u[i] = numbers[i].x, v[i] = numbers[i].y;
  LightArrays found;
  sampleArrays(std::span(u).first(numbers.size()), v.data(), found);
  for (size_t i = 0; i < numbers.size(); ++i)
    out[i] = {found.direction.at(i), found.light.at(i), found.pdf[i]};
  return true;
}

// Each loop prefetches what the next one reads.
void Importance::sampleArrays(std::span<const uint32_t> us, const uint32_t* vs,
                              LightArrays& out) const {
  const size_t count = us.size();
  assert(count <= kMostInArrays);
  if (!(total_ > 0)) return out.pdf.fill(0);
  alignas(64) LaneArray<int32_t> columns{}, rows{};
  alignas(64) LaneArray<float> u{}, v{};
  for (size_t i = 0; i < count; ++i) {
    rows[i] = rows_.sample(0, vs[i], v[i]);
    columns_.prefetchGuide(rows[i], us[i]);
  }
  for (size_t i = 0; i < count; ++i) columns_.prefetchEnds(rows[i], us[i]);
  for (size_t i = 0; i < count; ++i) {
    columns[i] = columns_.sample(rows[i], us[i], u[i]);
    probe_.prefetch(columns[i], rows[i]);
  }
  forLanes(count, [&](size_t first, int) {
    const auto point = field_.sample<Float8>(loadLanes(&columns[first]), loadLanes(&rows[first]),
                                             loadLanes(&u[first]), loadLanes(&v[first]));
    const Float8 pdf = point.weight * scale_;
    out.direction.store(first, point.direction);
    out.light.store(first,
                    {point.radiance.x / pdf, point.radiance.y / pdf, point.radiance.z / pdf});
    storeLanes(&out.pdf[first], pdf);
  });
}

void Importance::escapedMany(std::span<const Escape> rays, std::span<Escaped> out) const {
  RayArrays arrays{};
  copyDirections(rays, arrays.direction);
  LightArrays found;
  escapedArrays(arrays, rays.size(), found);
  for (size_t i = 0; i < rays.size(); ++i) out[i] = {found.light.at(i), found.pdf[i]};
}

void Importance::escapedArrays(const RayArrays& rays, size_t count, LightArrays& out) const {
  const Positions positions = located(probe_, rays.direction, count);
  forLanes(count, [&](size_t first, int) {
    const auto seen = field_.at(rays.direction.load(first), positions[first / kWidth]);
    out.light.store(first, seen.radiance);
    storeLanes(&out.pdf[first], seen.weight * scale_);
  });
}

void Importance::backgroundMany(std::span<const Sight> rays, std::span<Rgb> out) const {
  RayArrays arrays{};
  copyDirections(rays, arrays.direction);
  LightArrays found;
  backgroundArrays(arrays, rays.size(), found);
  for (size_t i = 0; i < rays.size(); ++i) out[i] = found.light.at(i);
}

void Importance::backgroundArrays(const RayArrays& rays, size_t count, LightArrays& out) const {
  const Positions positions = located(probe_, rays.direction, count);
  forLanes(count, [&](size_t first, int) {
    out.light.store(first, probe_.radiance(positions[first / kWidth]));
  });
}

float Importance::pdf(const vec3& wi) const { return escaped({}, wi).pdf; }

}  // namespace chromeball
