// Plots for reports: both axes logarithmic.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace chromeball {

struct PlotSeries {
  std::string name;
  std::vector<std::pair<double, double>> points;  // those not above 0, or infinite, are left out
};

struct PlotPanel {
  std::string title;
  std::vector<PlotSeries> series;  // the same names in the same order in every panel
};

// A self-contained SVG: panels side by side on common axes, and a legend. Series differ by their
// marks and dashes, so that they can be told apart without colour.
std::string logLogPlot(const std::string& title, const std::string& xLabel,
                       const std::string& yLabel, const std::vector<PlotPanel>& panels);

}  // namespace chromeball
