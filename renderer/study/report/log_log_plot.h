// SPDX-License-Identifier: Apache-2.0
// Plots with two logarithmic axes, as SVG.
#pragma once

#include <string>
#include <vector>

namespace chromeball {

struct PlotPoint {
  double x, y;
  double low = y, high = y;  // confidence interval of y; drawn if it is not empty
};

struct PlotSeries {
  std::string name;
  std::vector<PlotPoint> points;  // points that are infinite or not positive are ignored
};

struct PlotPanel {
  std::string title;
  std::vector<PlotSeries> series;  // same names and order in every panel
};

enum class Ticks { Binary, Decimal };  // at powers of two, or at 1, 2, 5, 10, ...

// A self-contained SVG: panels side by side with common axes, and a legend. Series differ in marks
// and dashes, so that they can be distinguished without colour.
std::string logLogPlot(const std::string& title, const std::string& xLabel,
                       const std::string& yLabel, const std::vector<PlotPanel>& panels,
                       Ticks xTicks = Ticks::Binary);

// Text in HTML and SVG.

// Escapes & < and ", and drops control characters.
std::string escaped(const std::string& text);

// The begin of an SVG of this size in pixels, on white.
std::string svgHead(double width, double height);

// An SVG text element, in pixels; `anchor` is start, middle or end.
std::string svgText(double x, double y, const char* anchor, const std::string& text);

}  // namespace chromeball
