// SPDX-License-Identifier: Apache-2.0
// The report of a comparison: an HTML page.
#pragma once

#include <string>
#include <vector>

#include "probe/probe.h"
#include "session/render_report.h"
#include "study/results.h"

namespace chromeball {

struct ReportScene {
  std::string name;  // for the title
  const Probe* probe;
  float exposure = 0;  // initial exposure of the images, in stops
  std::vector<std::pair<std::string, std::vector<vec3>>> directions;  // sampled by each strategy
};

// SVG: relMSE against samples, or against seconds.
std::string samplesPlot(const StudyResults& results);
std::string secondsPlot(const StudyResults& results);

// A self-contained HTML page.
std::string reportHtml(const Study& study, const RenderStore& store, const StudyResults& results,
                       const ReportScene& scene, const Machine& machine);

}  // namespace chromeball
