// SPDX-License-Identifier: Apache-2.0
#include "study/report/log_log_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/text.h"

namespace chromeball {
namespace {

constexpr double kPanelWidth = 360, kPanelHeight = 320, kLeft = 64, kTop = 56, kGap = 28;
constexpr double kLegendWidth = 210, kBottom = 56;

struct Style {
  const char *color, *dash;
  int mark;
};
constexpr int kMarks = 5;

Style styleOf(size_t series) {
  static constexpr std::array kColors = {"#111", "#c33", "#27a", "#282", "#a5c", "#b70", "#777"};
  static constexpr std::array kDashes = {"none", "7 3", "2 3", "9 3 2 3"};
  return {kColors[series % kColors.size()], kDashes[series % kDashes.size()], int(series % kMarks)};
}

bool canShow(const PlotPoint& point) {
  return point.x > 0 && point.y > 0 && std::isfinite(point.x) && std::isfinite(point.y);
}

// A logarithmic axis from minimum to maximum over `length` pixels.
struct Axis {
  double minimum = std::numeric_limits<double>::max(), maximum = 0, length;

  void cover(double number) {
    minimum = std::min(minimum, number);
    maximum = std::max(maximum, number);
  }
  // Adds room for a mark at both ends. An axis without numbers, or with one, gets a decade.
  void finish() {
    constexpr double kFraction = 0.06;  // of the axis, at each end
    if (maximum == 0) minimum = maximum = 1;
    const double room =
        maximum > 2 * minimum ? std::pow(maximum / minimum, kFraction / (1 - 2 * kFraction)) : 3.2;
    minimum /= room;
    maximum *= room;
  }
  double operator()(double number) const {
    return length * std::log(number / minimum) / std::log(maximum / minimum);
  }
  // Powers of two.
  std::vector<double> binaryTicks() const {
    std::vector<double> ticks;
    for (double tick = std::exp2(std::ceil(std::log2(minimum))); tick <= maximum; tick *= 2)
      ticks.push_back(tick);
    return ticks;
  }
  // 1, 2 and 5 times powers of ten; powers of ten alone if these are too many.
  std::vector<double> decimalTicks() const {
    std::vector<double> ticks;
    const bool crowded = maximum > 2e3 * minimum;
    const int first = int(std::floor(std::log10(minimum))),
              last = int(std::ceil(std::log10(maximum)));
    for (int exponent = first; exponent <= last; ++exponent)
      for (const double factor : {1.0, 2.0, 5.0}) {
        const double tick = factor * std::pow(10, exponent);
        if (tick >= minimum && tick <= maximum && (factor == 1 || !crowded)) ticks.push_back(tick);
      }
    return ticks;
  }
  std::vector<double> ticks(Ticks kind) const {
    return kind == Ticks::Binary ? binaryTicks() : decimalTicks();
  }
};

std::string mark(const Style& style, double x, double y) {
  static constexpr std::array<const char*, kMarks> kPaths = {
      "m-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z", "m-3.5 -3.5h7v7h-7z", "m0 -4.5l4.5 8h-9z",
      "m0 -5l5 5l-5 5l-5 -5z", "m0 4.5l4.5 -8h-9z"};
  return fmt::format("<path d=\"M{:.1f} {:.1f}{}\" fill=\"#fff\" stroke=\"{}\"/>\n", x, y,
                     kPaths[style.mark], style.color);
}

std::string frameOf(const Axis& x, Ticks xTicks, const Axis& y, const std::string& title,
                    bool labelY) {
  std::string svg = "<g stroke=\"#ddd\">";
  for (const double tick : x.ticks(xTicks))
    svg += fmt::format("<path d=\"M{:.1f} 0v{}\"/>", x(tick), kPanelHeight);
  for (const double tick : y.decimalTicks())
    svg += fmt::format("<path d=\"M0 {:.1f}h{}\"/>", kPanelHeight - y(tick), kPanelWidth);
  svg += fmt::format("</g>\n<rect width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#333\"/>\n",
                     kPanelWidth, kPanelHeight);
  for (const double tick : x.ticks(xTicks))
    svg += svgText(x(tick), kPanelHeight + 18, "middle", fmt::format("{:g}", tick));
  if (labelY)
    for (const double tick : y.decimalTicks())
      svg += svgText(-8, kPanelHeight - y(tick) + 4, "end", fmt::format("{:g}", tick));
  return svg + svgText(kPanelWidth / 2, -10, "middle", title);
}

std::string lineOf(const PlotSeries& series, const Style& style, const Axis& x, const Axis& y) {
  std::string path, intervals, marks;
  for (const auto& point : series.points) {
    if (!canShow(point)) continue;
    const double px = x(point.x), py = kPanelHeight - y(point.y);
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', px, py);
    if (point.low < point.high) {
      const double top = kPanelHeight - y(std::min(point.high, y.maximum));
      const double bottom = kPanelHeight - y(std::max(point.low, y.minimum));
      intervals += fmt::format("M{:.1f} {:.1f}V{:.1f}", px, top, bottom);
    }
    marks += mark(style, px, py);
  }
  if (path.empty()) return "";
  return fmt::format(
      "<g class=\"series\"><path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" "
      "stroke-dasharray=\"{}\"/>\n<path d=\"{}\" stroke=\"{}\"/>\n{}</g>\n",
      path, style.color, style.dash, intervals, style.color, marks);
}

std::string legendOf(const std::vector<PlotSeries>& series) {
  std::string svg;
  for (size_t i = 0; i < series.size(); ++i) {
    const Style style = styleOf(i);
    const double y = 12 + 22 * double(i);
    svg += fmt::format(
        "<path d=\"M0 {0}h40\" stroke=\"{1}\" stroke-width=\"1.6\" stroke-dasharray=\"{2}\"/>\n", y,
        style.color, style.dash);
    svg += mark(style, 20, y) + svgText(48, y + 4, "start", series[i].name);
  }
  return svg;
}

}  // namespace

std::string logLogPlot(const std::string& title, const std::string& xLabel,
                       const std::string& yLabel, const std::vector<PlotPanel>& panels,
                       Ticks xTicks) {
  Axis x{.length = kPanelWidth}, y{.length = kPanelHeight};
  for (const PlotPanel& panel : panels)
    for (const PlotSeries& series : panel.series)
      for (const auto& point : series.points)
        if (canShow(point)) x.cover(point.x), y.cover(point.y);
  x.finish();
  y.finish();

  const double plots = kLeft + double(panels.size()) * (kPanelWidth + kGap);
  const double width = plots + kLegendWidth, height = kTop + kPanelHeight + kBottom;
  std::string svg = svgHead(width, height);
  svg += svgText(plots / 2, 22, "middle", title);
  svg += svgText(plots / 2, height - 14, "middle", xLabel);
  svg += fmt::format("<g transform=\"translate(16 {}) rotate(-90)\">\n", kTop + kPanelHeight / 2) +
         svgText(0, 0, "middle", yLabel) + "</g>\n";
  for (size_t i = 0; i < panels.size(); ++i) {
    svg += fmt::format("<g transform=\"translate({} {})\">\n",
                       kLeft + double(i) * (kPanelWidth + kGap), kTop);
    svg += frameOf(x, xTicks, y, panels[i].title, i == 0);
    for (size_t s = 0; s < panels[i].series.size(); ++s)
      svg += lineOf(panels[i].series[s], styleOf(s), x, y);
    svg += "</g>\n";
  }
  svg += fmt::format("<g transform=\"translate({} {})\">\n", plots, kTop);
  if (!panels.empty()) svg += legendOf(panels.front().series);
  return svg + "</g>\n</svg>\n";
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : printable(text)) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '"')
      result += "&quot;";
    else if (static_cast<unsigned char>(c) >= ' ')
      result += c;
  }
  return result;
}

std::string svgHead(double width, double height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#111\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
      width, height);
}

std::string svgText(double x, double y, const char* anchor, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     escaped(text));
}

}  // namespace chromeball
