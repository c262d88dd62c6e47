// SPDX-License-Identifier: Apache-2.0
#include "lighting/importance.h"

#include <array>
#include <cassert>
#include <numeric>

#include "base/parallel.h"
#include "base/progress.h"
#include "math/lanes.h"

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

// Directions and their positions on the probe, in lanes.
struct Located {
  std::array<Lanes3<Float8>, LightSource::kMaxMany / kWidth> directions;
  std::array<Probe::PositionOf<Float8>, LightSource::kMaxMany / kWidth> positions;

  template <class Ray>
  Located(const Probe& probe, std::span<const Ray> rays) {
    assert(rays.size() <= LightSource::kMaxMany);
    forLanes(rays.size(), [&](size_t first, int count) {
      Lanes3<Float8>& d = directions[first / kWidth];
      d = Lanes3<Float8>{};
      for (int k = 0; k < count; ++k) {
        const vec3& wi = rays[first + size_t(k)].wi;
        d.x[k] = wi.x, d.y[k] = wi.y, d.z[k] = wi.z;
      }
      const auto& p = positions[first / kWidth] = probe.locate(d);
      for (int k = 0; k < count; ++k) probe.prefetch(p.column[k], p.row[k]);
    });
  }
};

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
  const int row = rows_.sample(0, v);
  const int column = columns_.sample(row, u);
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
  const LuminanceField::Point seen = field_.at(wi, probe_.locate(wi));
  return {seen.radiance, seen.weight * scale_};
}

// Each loop prefetches what the next one reads.
bool Importance::sampleMany(std::span<const glm::uvec2> numbers,
                            std::span<DirectionSample> out) const {
  assert(numbers.size() <= kMaxMany);
  if (!(total_ > 0)) {
    for (DirectionSample& sample : out) sample.pdf = 0;
    return true;
  }
  std::array<double, kMaxMany> us, vs;
  std::array<int, kMaxMany> columns, rows;
  for (size_t i = 0; i < numbers.size(); ++i) {
    us[i] = numbers[i].x * 0x1p-32, vs[i] = numbers[i].y * 0x1p-32;
    rows[i] = rows_.sample(0, vs[i]);
    columns_.prefetchGuide(rows[i], us[i]);
  }
  for (size_t i = 0; i < numbers.size(); ++i) columns_.prefetchCdf(rows[i], us[i]);
  for (size_t i = 0; i < numbers.size(); ++i) {
    columns[i] = columns_.sample(rows[i], us[i]);
    probe_.prefetch(columns[i], rows[i]);
  }
  forLanes(numbers.size(), [&](size_t first, int count) {
    Int8 column{}, row{};
    Float8 u{}, v{};
    for (int k = 0; k < count; ++k) {
      const size_t i = first + size_t(k);
      column[k] = columns[i], row[k] = rows[i];
      u[k] = float(us[i]), v[k] = float(vs[i]);
    }
    const auto point = field_.sample<Float8>(column, row, u, v);
    const Float8 pdf = point.weight * scale_;
    const Float8 x = point.radiance.x / pdf, y = point.radiance.y / pdf, z = point.radiance.z / pdf;
    for (int k = 0; k < count; ++k) {
      const Lanes3<Float8>& d = point.direction;
      out[first + size_t(k)] = {{d.x[k], d.y[k], d.z[k]}, {x[k], y[k], z[k]}, pdf[k]};
    }
  });
  return true;
}

void Importance::escapedMany(std::span<const Escape> rays, std::span<Escaped> out) const {
  const Located at(probe_, rays);
  forLanes(rays.size(), [&](size_t first, int count) {
    const auto seen = field_.at(at.directions[first / kWidth], at.positions[first / kWidth]);
    const Float8 pdf = seen.weight * scale_;
    const Lanes3<Float8>& c = seen.radiance;
    for (int k = 0; k < count; ++k) out[first + size_t(k)] = {{c.x[k], c.y[k], c.z[k]}, pdf[k]};
  });
}

void Importance::backgroundMany(std::span<const Sight> rays, std::span<Rgb> out) const {
  const Located at(probe_, rays);
  forLanes(rays.size(), [&](size_t first, int count) {
    const Lanes3<Float8> c = probe_.radiance(at.positions[first / kWidth]);
    for (int k = 0; k < count; ++k) out[first + size_t(k)] = {c.x[k], c.y[k], c.z[k]};
  });
}

float Importance::pdf(const vec3& wi) const { return escaped({}, wi).pdf; }

}  // namespace chromeball
