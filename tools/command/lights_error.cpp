// SPDX-License-Identifier: Apache-2.0
// chromeball lights-error PROBE --methods a,b,c --counts 2,4,8,...
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "base/progress.h"
#include "commands.h"
#include "image/io/output_file.h"
#include "lighting/fit/light_descent.h"
#include "lighting/methods.h"
#include "math/icosphere.h"
#include "messages.h"
#include "probe/irradiance.h"
#include "probe_options.h"
#include "progress_bar.h"
#include "study/report/log_log_plot.h"

namespace chromeball {
namespace {

struct LightsErrorArguments {
  LightsProbe probe;
  std::string csv, plot;
  std::vector<std::string> methods;
  std::vector<int> counts, levels;
  int normals = 20480;
  std::optional<std::string> seed;
};

struct Row {
  std::string method;
  int count;  // as requested; for levels, the maximum
  size_t lights;
  LightError error;
  double seconds;  // to make the lights
};

Row measure(const std::string& method, const Image& latLong, const LightRequest& request,
            std::span<const vec3> normals, std::span<const dvec3> irradiance) {
  const Stopwatch watch;
  const MadeLights made = makeLights(method, latLong, request);
  const double seconds = watch.seconds();
  const auto lit = irradianceOf(made.lights, made.ambient.value_or(Rgb(0)), normals);
  const int count = request.levels ? 1 << *request.levels : *request.count;
  return {method, count, made.lights.size(), lightError(lit, irradiance), seconds};
}

std::string formatCsv(const std::vector<Row>& rows) {
  std::string text = "method,count,lights,mean_percent,max_percent,seconds\n";
  for (const Row& row : rows)
    text += fmt::format("{},{},{},{:.6g},{:.6g},{:.4g}\n", row.method, row.count, row.lights,
                        row.error.mean, row.error.max, row.seconds);
  return text;
}

std::string formatPlot(const LightsErrorArguments& arguments, const std::vector<Row>& rows) {
  PlotPanel mean{"mean over the normals", {}}, max{"maximum over the normals", {}};
  for (const std::string& method : arguments.methods) {
    PlotSeries& means = mean.series.emplace_back(PlotSeries{method, {}});
    PlotSeries& maxima = max.series.emplace_back(PlotSeries{method, {}});
    for (const Row& row : rows)
      if (row.method == method) {
        means.points.push_back({double(row.lights), row.error.mean});
        maxima.points.push_back({double(row.lights), row.error.max});
      }
    const auto isLeft = [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; };
    for (PlotSeries* series : {&means, &maxima})
      std::stable_sort(series->points.begin(), series->points.end(), isLeft);
  }
  return logLogPlot(std::filesystem::path(arguments.probe.file).filename().string(),
                    "number of directional lights", "error of irradiance, % of its mean",
                    {mean, max});
}

std::vector<LightRequest> requestsOf(const LightsErrorArguments& arguments) {
  if (arguments.counts.empty() && arguments.levels.empty())
    throwInput("--counts: the numbers of lights are missing; give either --counts or --recursion");
  if (!arguments.counts.empty() && !arguments.levels.empty())
    throwInput("--recursion: excludes --counts; give one");
  const uint64_t seed = arguments.seed ? parseSeed(*arguments.seed) : 0;
  std::vector<LightRequest> requests;
  for (const int count : arguments.counts) requests.push_back({.count = count, .seed = seed});
  for (const int levels : arguments.levels) requests.push_back({.seed = seed, .levels = levels});
  return requests;
}

// Keeps the first of equal elements.
template <class T>
void removeRepeats(std::vector<T>& all) {
  std::vector<T> once;
  for (const T& element : all)
    if (std::find(once.begin(), once.end(), element) == once.end()) once.push_back(element);
  all = std::move(once);
}

void run(const LightsErrorArguments& given) {
  LightsErrorArguments arguments = given;
  removeRepeats(arguments.methods);
  removeRepeats(arguments.counts);
  removeRepeats(arguments.levels);
  const std::vector<LightRequest> requests = requestsOf(arguments);
  const auto isStochastic = [](const std::string& method) {
    return lightMethod(method, "--methods").lights.isStochastic;
  };
  if (std::ranges::count_if(arguments.methods, isStochastic) == 0 && arguments.seed)
    warn("--seed: has no effect: none of the methods is stochastic");
  for (const std::string& method : arguments.methods)
    for (const LightRequest& request : requests) checkLightCount(method, request);
  if (!arguments.csv.empty()) checkOutputFile(arguments.csv, {".csv"});
  if (!arguments.plot.empty()) checkOutputFile(arguments.plot, {".svg"});
  checkDistinct({arguments.csv, arguments.plot}, {arguments.probe.file});
  const std::vector<vec3> normals = icosphereNormals(subdivisionsFor(arguments.normals));
  arguments.probe.checkMask();
  const Image latLong = arguments.probe.load();
  std::optional<BusyLine> busy("irradiance of the probe");
  const std::vector<dvec3> irradiance = exactIrradiance(latLong, normals);

  std::vector<Row> rows;
  busy.reset();
  say("{:<22} {:>6} {:>7} {:>9} {:>9} {:>9}\n", "method", "count", "lights", "mean %", "max %",
      "seconds");
  for (const std::string& method : arguments.methods)
    for (const LightRequest& request : requests) {
      busy.emplace("making lights by " + method);
      const Row& row = rows.emplace_back(measure(method, latLong, request, normals, irradiance));
      busy.reset();
      say("{:<22} {:>6} {:>7} {:>9.3f} {:>9.3f} {:>9.3f}\n", row.method, row.count, row.lights,
          row.error.mean, row.error.max, row.seconds);
      std::fflush(stdout);
    }
  if (!arguments.csv.empty()) writeText(arguments.csv, formatCsv(rows));
  if (!arguments.plot.empty()) writeText(arguments.plot, formatPlot(arguments, rows));
}

}  // namespace

void addLightsErrorCommand(Command app) {
  auto [command, a] = app.addCommand<LightsErrorArguments>(
      "lights-error", "The error of the irradiance of directional lights against their probe.",
      run);
  command.addRequired("PROBE", a.probe.file, "the probe's image");
  command.footer(lightMethodHelp());
  command.addRequired("--methods", a.methods, "one or several; see below").delimiter(',');
  command.addOption("--counts", a.counts, "numbers of lights: 2,4,8,...").delimiter(',');
  command
      .addOption("--recursion", a.levels,
                 "median-cut: in place of --counts, how often all regions are cut: 1,2,3,...")
      .delimiter(',');
  command.addWithDefault(
      "--normals", a.normals,
      "number of surface orientations to compare: 20 times a power of 4, up to 1310720");
  command.addOption("--csv", a.csv, "write the table to this file");
  command.addOption("--plot", a.plot, "write a plot of the table to this .svg");
  command.addOption("--seed", a.seed, "of stochastic methods");
  command.addOption("--probe-mask", a.probe.mask, kMaskHelp);
  command.addOption("--probe-mapping", a.probe.mapping, "the mapping of PROBE; auto detects it");
}

}  // namespace chromeball
