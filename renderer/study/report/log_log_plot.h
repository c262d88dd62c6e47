// SPDX-License-Identifier: Apache-2.0
// Plots for reports: both axes logarithmic.
#pragma once

#include <string>
#include <vector>

namespace chromeball {

struct PlotPoint {
  double x, y;
  double low = y, high = y;  // of y's interval, drawn where they differ
};

struct PlotSeries {
  std::string name;
  std::vector<PlotPoint> points;  // those not above 0, or infinite, are left out
};

struct PlotPanel {
  std::string title;
  std::vector<PlotSeries> series;  // the same names in the same order in every panel
};

enum class Ticks { Binary, Decimal };  // at powers of two, or at 1, 2, 5, 10, ...

// A self-contained SVG: panels side by side on common axes, and a legend. Series differ by their
// marks and dashes, so that they can be told apart without colour.
std::string logLogPlot(const std::string& title, const std::string& xLabel,
                       const std::string& yLabel, const std::vector<PlotPanel>& panels,
                       Ticks xTicks = Ticks::Binary);

}  // namespace chromeball
