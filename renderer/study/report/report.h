// SPDX-License-Identifier: Apache-2.0
// The report of a comparison: an HTML page.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

#include "lighting/strategy.h"
#include "probe/probe.h"
#include "session/render_report.h"
#include "study/render_store.h"
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

// The images and maps of a report, in the form that report.js reads.

// JSON:
//   width, height       of the images in pixels
//   heat, signed        colour tables, 256 [r, g, b] each
//   reference           {rgb, exponent}: PNG data URIs of radiance in Ward's RGBE, with separate
//                       images for mantissas and exponents
//   images              [{name, budget, samples, seconds, rgb, exponent, error}]: one render per
//                       strategy, all of about equal time. `error` is a map of the root of the mean
//                       over repeats of the squared relative error, logarithmic
//   errorScale          {max, decades} of these maps
//   bias                [{name, map, budget}]: maps of the relative bias of biased strategies,
//                       linear, 128 where the bias is less than two standard errors
//   biasScale           {max} of these maps
//   pairs               [{a, b, map, width, height}]: maps of z, one texel per tile
//   zScale              |z| at the ends of these maps
nlohmann::ordered_json reportImages(const RenderStore& store, const StudyResults& results);

std::string pngUri(int width, int height, int channels, std::span<const uint8_t> bytes);

// The directions that a strategy samples, for display.

// World-space directions of the light samples at a point on a floor: all lights of a constellation,
// 128 random samples of other strategies. Empty for a strategy without light samples.
std::vector<vec3> sampledDirections(const LightSource& strategy);

}  // namespace chromeball
