// SPDX-License-Identifier: Apache-2.0
#include "lighting/row_distribution.h"

#include "base/error.h"

namespace chromeball {
namespace {

// Column c of cells starts at the centre of texel c: u = (c + 1/2) / width. Any whole number is a
// column; they repeat every `width`.
struct Columns {
  int first, count;

  Columns(const Probe& probe, const AzimuthRange& range) {
    const auto position = [&](double azimuth) {
      return (0.5 - (azimuth - probe.rotationDegrees()) / 360) * probe.width() - 0.5;
    };
    constexpr double kRounding = 1e-9;
    first = int(std::floor(position(range.left) + kRounding));
    count = std::clamp(int(std::ceil(position(range.right) - kRounding)) - first, 1, probe.width());
  }
};

int wrapped(int column, int width) { return (column % width + width) % width; }

// The row's cdf at the left edge of a column, continued beyond the map's ends.
double cdfAt(std::span<const double> row, int column) {
  const int width = int(row.size()) - 1, within = wrapped(column, width);
  return double((column - within) / width) + row[size_t(within)];
}

}  // namespace

int cellRowAt(const Probe& probe, double elevation) {
  return std::clamp(int((90 - elevation) / 180 * probe.height() + 0.5), 0, probe.height());
}

RowDistribution rowDistribution(const Probe& probe, const Importance& importance, int row,
                                const AzimuthRange& range, int count, std::string_view location) {
  const int width = probe.width(), height = probe.height();
  const Columns columns(probe, range);
  RowDistribution found{};
  found.row = row;
  // The rows next to the poles are half as high.
  const double middle = row == 0 ? 0.25 : row == height ? height - 0.25 : row;
  found.elevation = 90 - 180 * middle / height;

  const std::span<const double> rows = importance.rows().row(0),
                                cdf = importance.columns().row(row);
  const double begin = cdfAt(cdf, columns.first);
  found.share = cdfAt(cdf, columns.first + columns.count) - begin;
  if (!(rows[size_t(row) + 1] > rows[size_t(row)]))
    throwInput(
        "{}: nothing is sampled in the row at an elevation of {:.4g} degrees: it is black, "
        "or too dark beside the others",
        location, found.elevation);
  if (!(found.share > 0))
    throwInput(
        "{}: nothing is sampled between the azimuths {:.6g} and {:.6g} at an elevation of "
        "{:.4g} degrees",
        location, range.left, range.right, found.elevation);

  for (int i = 0; i <= columns.count; ++i) {
    const int column = columns.first + i;
    found.azimuths.push_back(180 - 360 * (column + 0.5) / width + probe.rotationDegrees());
    found.cdf.push_back((cdfAt(cdf, column) - begin) / found.share);
    if (i == columns.count) break;
    const Probe::Corners corners = probe.corners(wrapped(column, width), row);
    found.luminances.push_back(double(luminance(Probe::interpolate(corners, 0.5f, 0.5f))));
  }

  const double v = 0.5 * (rows[size_t(row)] + rows[size_t(row) + 1]);
  for (int i = 0; i < count; ++i) {
    const double number = (i + 0.5) / count, u = begin + number * found.share;
    const vec3 d = importance.sampleDirection(u - std::floor(u), v).wi;
    const double azimuth = std::atan2(double(-d.x), double(-d.z)) * 180 / kPiD;
    if (!std::isfinite(azimuth))
      throwInput("{}: radiance near the largest float cannot be sampled; scale it down", location);
    // The same azimuth to the right of the left edge, but for rounding.
    const double turns = std::floor((found.azimuths.front() - azimuth) / 360 + 1e-6);
    found.samples.push_back({number, azimuth + 360 * turns});
  }
  return found;
}

}  // namespace chromeball
