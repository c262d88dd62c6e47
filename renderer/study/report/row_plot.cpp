// SPDX-License-Identifier: Apache-2.0
#include "study/report/row_distribution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "probe/convert.h"
#include "probe/mapping.h"
#include "study/report/log_log_plot.h"
#include "study/report/report.h"

namespace chromeball {
namespace {

// Sizes in pixels.
constexpr double kPlotLeft = 72, kWidth = 864, kRight = 24, kPlotTop = 46, kPanel = 190,
                 kPanelGap = 26;
constexpr double kCdfTop = kPlotTop + kPanel + kPanelGap, kCdfBottom = kCdfTop + kPanel;
constexpr double kZero = 18;  // from the black texels to the least luminance of the axis
constexpr double kStripTop = kCdfBottom + 50, kStrip = 96, kPlotBottom = 34;
constexpr const char *kLine = "#27a", *kFill = "#dbe7f3", *kArrow = "#c33";

struct AzimuthAxis {
  double left, right;  // degrees, left > right
  double operator()(double azimuth) const {
    return kPlotLeft + kWidth * (left - azimuth) / (left - right);
  }
  // Multiples of a round step; also just outside, as cells of a whole row begin before its left.
  std::vector<double> ticks() const {
    constexpr double kMaxTicks = 9;
    const double outside = 0.002 * (left - right);
    double step = 90;
    for (const double finer :
         {60., 45., 30., 15., 10., 5., 2., 1., 0.5, 0.2, 0.1, 0.05, 0.02, 0.01})
      if ((left - right) / finer <= kMaxTicks) step = finer;
    std::vector<double> ticks;
    for (double k = std::ceil((right - outside) / step); k * step <= left + outside; ++k)
      ticks.push_back(k * step);
    return ticks;
  }
};

// Decades that contain the row's luminances, but at most the twelve below the largest; and 0, at a
// distance below them, where a texel is black.
struct LuminanceAxis {
  int first = 0, last = 1;  // powers of ten
  double height = kPanel;   // of the decades

  explicit LuminanceAxis(const std::vector<double>& luminances) {
    constexpr int kMaxDecades = 12;
    const double maximum = *std::max_element(luminances.begin(), luminances.end());
    double minimum = maximum;
    for (const double l : luminances) {
      if (l > 0) minimum = std::min(minimum, l);
      if (!(l > 0)) height = kPanel - kZero;
    }
    if (!(maximum > 0)) return;
    last = int(std::ceil(std::log10(maximum) + 1e-9));
    first = std::max(int(std::floor(std::log10(minimum))), last - kMaxDecades);
  }
  bool hasZero() const { return height < kPanel; }
  double operator()(double luminance) const {
    if (!(luminance > 0)) return kPlotTop + kPanel;
    const double power = std::log10(luminance);
    return kPlotTop + height * (1 - std::clamp((power - first) / (last - first), 0., 1.));
  }
  // Powers of ten, only some if there are many; with twice and five times each if there are two or
  // three.
  std::vector<double> ticks() const {
    std::vector<double> ticks;
    const int step = (last - first + 5) / 6;
    for (int power = first; power <= last; power += step)
      for (const double factor : {1., 2., 5.})
        if (factor == 1 || (last - first <= 2 && power < last))
          ticks.push_back(factor * std::pow(10, power));
    return ticks;
  }
};

std::string frame(const AzimuthAxis& azimuth, double top) {
  std::string svg = "<g stroke=\"#e4e4e4\">";
  for (const double tick : azimuth.ticks())
    svg += fmt::format("<path d=\"M{:.1f} {:.1f}v{}\"/>", azimuth(tick), top, kPanel);
  return svg + fmt::format(
                   "</g>\n<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" "
                   "stroke=\"#333\"/>\n",
                   kPlotLeft, top, kWidth, kPanel);
}

std::string verticalLabel(double middle, const std::string& text) {
  return fmt::format("<g transform=\"translate(18 {}) rotate(-90)\">{}</g>\n", middle,
                     svgText(0, 0, "middle", text));
}

// Where a map has many more texels than the plot has pixels, each step shows the largest of
// several.
std::string luminancePanel(const RowDistribution& row, const AzimuthAxis& azimuth) {
  constexpr size_t kMaxSteps = 1728;
  const LuminanceAxis axis(row.luminances);
  const size_t texels = row.luminances.size(), stride = (texels + kMaxSteps - 1) / kMaxSteps;
  std::string path;
  for (size_t i = 0; i < texels; i += stride) {
    const size_t end = std::min(i + stride, texels);
    const double y = axis(*std::max_element(row.luminances.begin() + ptrdiff_t(i),
                                            row.luminances.begin() + ptrdiff_t(end)));
    path += fmt::format("{}{:.1f} {:.1f}H{:.1f}", i == 0 ? 'M' : 'L', azimuth(row.azimuths[i]), y,
                        azimuth(row.azimuths[end]));
  }
  std::string svg = fmt::format("<path d=\"{}V{:.1f}H{:.1f}z\" fill=\"{}\"/>\n", path,
                                kPlotTop + kPanel, kPlotLeft, kFill);
  svg += frame(azimuth, kPlotTop);
  for (const double tick : axis.ticks()) {
    svg += fmt::format("<path d=\"M{} {:.1f}h{}\" stroke=\"#e4e4e4\"/>", kPlotLeft, axis(tick),
                       kWidth);
    svg += svgText(kPlotLeft - 8, axis(tick) + 4, "end", fmt::format("{:.6g}", tick));
  }
  if (axis.hasZero()) {
    svg += svgText(kPlotLeft - 8, axis(0) + 4, "end", "0");
    svg += fmt::format("<path d=\"M{} {:.1f}h{}\" stroke=\"#999\" stroke-dasharray=\"2 3\"/>",
                       kPlotLeft, kPlotTop + axis.height, kWidth);
  }
  svg += fmt::format(
      "<path class=\"luminance\" d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.3\"/>\n",
      path, kLine);
  return svg + verticalLabel(kPlotTop + kPanel / 2, fmt::format("luminance of row {}", row.row));
}

double cdfY(double number) { return kCdfBottom - kPanel * number; }

// Arrows from the number on the axis to the curve, and down to the azimuth. The lines of many
// samples are thinner, so that together they cover no more of the panel.
std::string arrows(const RowDistribution& row, const AzimuthAxis& azimuth) {
  const double crowd = double(row.samples.size());
  const double lineWidth = std::min(1., 24 / crowd), opacity = std::clamp(100 / crowd, 0.3, 0.85);
  std::string lines, heads;
  for (const RowDistribution::Sample& sample : row.samples) {
    const double x = azimuth(sample.azimuth), size = crowd > 100 ? 2 : 3.5;
    lines += fmt::format("M{} {:.1f}H{:.1f}V{:.1f}", kPlotLeft, cdfY(sample.number), x,
                         kCdfBottom - 2 * size);
    heads += fmt::format("M{:.1f} {:.1f}l{} {}h{}z", x, kCdfBottom, -size, -2 * size, 2 * size);
  }
  return fmt::format(
      "<g class=\"samples\"><path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:.4g}\" "
      "opacity=\"0.85\"/><path d=\"{}\" fill=\"{}\" opacity=\"{:.2f}\"/></g>\n",
      lines, kArrow, lineWidth, heads, kArrow, opacity);
}

std::string cdfPanel(const RowDistribution& row, const AzimuthAxis& azimuth) {
  constexpr size_t kMaxSteps = 3456;
  const size_t texels = row.luminances.size(), stride = (texels + kMaxSteps - 1) / kMaxSteps;
  std::string path, svg = frame(azimuth, kCdfTop);
  for (size_t i = 0; i < texels + stride; i += stride) {
    const size_t edge = std::min(i, texels);
    path += fmt::format("{}{:.1f} {:.2f}", i == 0 ? 'M' : 'L', azimuth(row.azimuths[edge]),
                        cdfY(row.cdf[edge]));
  }
  for (const double tick : {0., 0.25, 0.5, 0.75, 1.}) {
    svg += fmt::format("<path d=\"M{} {:.1f}h-5\" stroke=\"#333\"/>", kPlotLeft, cdfY(tick));
    svg += svgText(kPlotLeft - 8, cdfY(tick) + 4, "end", fmt::format("{:g}", tick));
  }
  svg += arrows(row, azimuth);
  svg += fmt::format(
      "<path class=\"cdf\" d=\"{}\" fill=\"none\" stroke=\"#111\" stroke-width=\"1.8\"/>\n", path);
  for (const double tick : azimuth.ticks())
    svg += svgText(azimuth(tick), kCdfBottom + 18, "middle", fmt::format("{:.6g}", tick));
  svg += svgText(kPlotLeft + kWidth / 2, kCdfBottom + 36, "middle",
                 "azimuth (degrees from -Z, counter-clockwise seen from above)");
  return svg + verticalLabel(kCdfTop + kPanel / 2, "cdf");
}

// The probe around the row, with square degrees, as a PNG of half the resolution of the plot.
std::string strip(const Probe& probe, const RowDistribution& row, const AzimuthAxis& azimuth) {
  const int width = int(kWidth / 2), height = int(kStrip / 2);
  const double degrees = (azimuth.left - azimuth.right) * kStrip / kWidth;
  const double top = std::clamp(row.elevation + degrees / 2, std::min(90., degrees - 90), 90.);
  const DisplayTransform transform = previewTransform(probe.latLong());
  std::vector<uint8_t> bytes;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const dvec3 d = directionAt(azimuth.left - (azimuth.left - azimuth.right) * (x + 0.5) / width,
                                  top - degrees * (y + 0.5) / height);
      const Rgb color = display(transform, probe.radiance(vec3(d)));
      for (int c = 0; c < 3; ++c)
        bytes.push_back(uint8_t(std::lround(255 * std::clamp(linearToSrgb(color[c]), 0.f, 1.f))));
    }
  const double rowY = kStripTop + kStrip * (top - row.elevation) / degrees;
  std::string marks;
  for (const RowDistribution::Sample& sample : row.samples)
    marks += fmt::format("M{:.1f} {:.1f}v10", azimuth(sample.azimuth), rowY - 5);
  std::string svg = fmt::format(
      "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" "
      "href=\"{}\"/>\n",
      kPlotLeft, kStripTop, kWidth, kStrip, pngUri(width, height, 3, bytes));
  svg += fmt::format("<path d=\"M{} {:.1f}h{}\" stroke=\"#fff\" stroke-width=\"0.7\"/>", kPlotLeft,
                     rowY, kWidth);
  svg += fmt::format("<path d=\"{}\" stroke=\"{}\" stroke-width=\"1.4\"/>\n", marks, kArrow);
  svg += svgText(kPlotLeft - 8, kStripTop + 11, "end", fmt::format("{:.1f}", top));
  svg += svgText(kPlotLeft - 8, kStripTop + kStrip, "end", fmt::format("{:.1f}", top - degrees));
  return svg + verticalLabel(kStripTop + kStrip / 2, "elevation");
}

}  // namespace

std::string rowPlot(const Probe& probe, const RowDistribution& row, const std::string& title) {
  const AzimuthAxis azimuth{row.azimuths.front(), row.azimuths.back()};
  std::string svg = svgHead(kPlotLeft + kWidth + kRight, kStripTop + kStrip + kPlotBottom);
  svg += fmt::format("<g font-size=\"14\">{}</g>\n",
                     svgText(kPlotLeft + kWidth / 2, 26, "middle", title));
  svg += luminancePanel(row, azimuth) + cdfPanel(row, azimuth) + strip(probe, row, azimuth);
  return svg + "</svg>\n";
}

}  // namespace chromeball
