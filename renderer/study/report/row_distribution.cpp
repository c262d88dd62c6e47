// SPDX-License-Identifier: Apache-2.0
#include "study/report/row_distribution.h"

#include <numeric>

#include "base/error.h"

namespace chromeball {
namespace {

// Any whole number is a column of texels; they repeat every `width`.
struct Columns {
  int first, count;

  Columns(const Probe& probe, const AzimuthRange& range) {
    const auto position = [&](double azimuth) {
      return (0.5 - (azimuth - double(probe.rotation().yaw())) / 360) * probe.width();
    };
    constexpr double kRounding = 1e-9;
    first = int(std::floor(position(range.left) + kRounding));
    count = std::clamp(int(std::ceil(position(range.right) - kRounding)) - first, 1, probe.width());
  }
};

int wrapped(int column, int width) { return (column % width + width) % width; }

// The weight of each texel of a row, the upper corner of a cell (probe/probe.h).
std::vector<double> weightsOf(const Probe& probe, const Importance& importance, int row) {
  std::vector<double> weights;
  for (int x = 0; x < probe.width(); ++x)
    weights.push_back(double(importance.field().at({}, {x, row + 1, 0, 0, 1}).weight));
  return weights;
}

// The pdf over one texel: linear from its left edge to its centre, and on to its right edge.
struct TexelPdf {
  double left, centre, right;

  TexelPdf(const std::vector<double>& weights, int column) {
    const int width = int(weights.size());
    const auto weight = [&](int x) { return weights[size_t(wrapped(x, width))]; };
    centre = weight(column);
    left = (weight(column - 1) + centre) / 2, right = (centre + weight(column + 1)) / 2;
  }
  double integral() const { return (left + 2 * centre + right) / 4; }

  // The position in [0, 1] that has this part of the integral on its left.
  double position(double part) const {
    const double leftHalf = (left + centre) / 4, rightHalf = (centre + right) / 4;
    const double mass = part * (leftHalf + rightHalf);
    if (mass < leftHalf || rightHalf == 0) return 0.5 * sampleLinear(mass / leftHalf, left, centre);
    return 0.5 + 0.5 * sampleLinear((mass - leftHalf) / rightHalf, centre, right);
  }

 private:
  // A number in [0, 1] with pdf proportional to a (1 - x) + b x; not both are 0.
  static double sampleLinear(double u, double a, double b) {
    const double greater = std::max(a, b), p = a / greater, q = b / greater;
    const double root = std::sqrt(std::max(p * p + u * (q * q - p * p), 0.0));
    return std::min(u * (p + q) / std::max(p + root, 1e-300), 1.0);
  }
};

void addSamples(RowDistribution& found, const std::vector<double>& weights, int first, int count) {
  for (int i = 0; i < count; ++i) {
    const double number = (i + 0.5) / count;
    const auto above = std::upper_bound(found.cdf.begin(), found.cdf.end(), number);
    const size_t texel = size_t(above - found.cdf.begin()) - 1;
    const double part = (number - found.cdf[texel]) / (found.cdf[texel + 1] - found.cdf[texel]);
    const double position = TexelPdf(weights, first + int(texel)).position(part);
    const double left = found.azimuths[texel], right = found.azimuths[texel + 1];
    found.samples.push_back({number, left + (right - left) * position});
  }
}

}  // namespace

int texelRowAt(const Probe& probe, double elevation) {
  return std::clamp(int((90 - elevation) / 180 * probe.height()), 0, probe.height() - 1);
}

int brightestRow(const Probe& probe, const Importance& importance) {
  int best = 0;
  double most = -1;
  for (int row = 0; row < probe.height(); ++row) {
    const std::vector<double> weights = weightsOf(probe, importance, row);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.) *
                       std::sin(kPiD * (row + 0.5) / probe.height());
    if (sum > most) most = sum, best = row;
  }
  return best;
}

RowDistribution rowDistribution(const Probe& probe, const Importance& importance, int row,
                                const AzimuthRange& range, int count, std::string_view location) {
  const int width = probe.width();
  const Columns columns(probe, range);
  const std::vector<double> weights = weightsOf(probe, importance, row);
  RowDistribution found{};
  found.row = row;
  found.elevation = 90 - 180 * (row + 0.5) / probe.height();

  double within = 0;
  std::vector<double> sums{0};
  for (int i = 0; i <= columns.count; ++i) {
    const int column = columns.first + i;
    found.azimuths.push_back(180 - 360. * column / width + double(probe.rotation().yaw()));
    if (i == columns.count) break;
    const Rgb texel = probe.corners(wrapped(column, width), row + 1).c00;
    found.luminances.push_back(double(luminance(texel)));
    sums.push_back(within += TexelPdf(weights, column).integral());
  }
  // This is also the sum of the integrals over all texels.
  const double all = std::accumulate(weights.begin(), weights.end(), 0.);
  if (!(all > 0))
    throwInput("{}: nothing is sampled in row {}, at an elevation of {:.4g} degrees: it is black",
               location, row, found.elevation);
  if (!(within > 0))
    throwInput(
        "{}: nothing is sampled between the azimuths {:.6g} and {:.6g} in row {}, at an elevation "
        "of {:.4g} degrees",
        location, range.left, range.right, row, found.elevation);
  found.share = within / all;
  for (const double sum : sums) found.cdf.push_back(sum / within);
  addSamples(found, weights, columns.first, count);
  return found;
}

}  // namespace chromeball
