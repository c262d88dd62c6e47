// SPDX-License-Identifier: Apache-2.0
// The page people look at.
#pragma once

#include <string>
#include <vector>

#include "job/machine.h"
#include "probe/probe.h"
#include "study/results.h"

namespace chromeball {

struct ReportScene {
  std::string name;  // what the page is about
  const Probe* probe;
  float exposure = 0;                                                 // stops, at first
  std::vector<std::pair<std::string, std::vector<vec3>>> directions;  // that strategies sample
};

// SVG: relMSE against samples, or against seconds.
std::string samplesPlot(const StudyResults& results);
std::string secondsPlot(const StudyResults& results);

// One HTML file that needs no other.
std::string reportHtml(const Study& study, const RenderStore& store, const StudyResults& results,
                       const ReportScene& scene, const Machine& machine);

}  // namespace chromeball
