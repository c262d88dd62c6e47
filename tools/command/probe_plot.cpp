// SPDX-License-Identifier: Apache-2.0
// chromeball probe plot PROBE OUT.svg
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "commands.h"
#include "front/arguments.h"
#include "image/io/output_file.h"
#include "image_files.h"
#include "messages.h"
#include "probe/load.h"
#include "study/report/row_distribution.h"

namespace chromeball {
namespace {

struct ProbePlotArguments {
  std::string file, out, mapping = "auto", azimuth;
  std::optional<int> row;
  std::optional<double> elevation;
  int samples = 16;
  bool compensated = false;
};

AzimuthRange parseAzimuthRange(const std::string& text) {
  if (text.empty()) return {};
  const std::vector<double> ends = parseNumbers(text, 2, "--azimuth");
  const AzimuthRange range{std::max(ends[0], ends[1]), std::min(ends[0], ends[1])};
  constexpr double kLargest = 3600;
  if (range.left == range.right || range.left - range.right > 360 ||
      std::max(range.left, -range.right) > kLargest)
    throwInput("--azimuth: {} should be two different azimuths, at most 360 degrees apart", text);
  return range;
}

int chosenRow(const ProbePlotArguments& arguments, const Probe& probe,
              const Importance& importance) {
  if (arguments.elevation) return texelRowAt(probe, *arguments.elevation);
  if (!arguments.row) return brightestRow(probe, importance);
  if (*arguments.row < 0 || *arguments.row >= probe.height())
    throwInput("--row: {} should be 0 to {}, a row of texels of the lat-long map", *arguments.row,
               probe.height() - 1);
  return *arguments.row;
}

void run(const ProbePlotArguments& arguments) {
  checkOutputFile(arguments.out, {".svg"});
  checkDistinct({arguments.out}, {arguments.file});
  constexpr int kMaxSamples = 10000;
  if (arguments.samples < 0 || arguments.samples > kMaxSamples)
    throwInput("--samples: {} should be 0 to {}", arguments.samples, kMaxSamples);
  if (arguments.elevation && !(std::fabs(*arguments.elevation) <= 90))
    throwInput("--elevation: {} should be -90 to 90 degrees", *arguments.elevation);
  const AzimuthRange range = parseAzimuthRange(arguments.azimuth);
  const LoadedProbe loaded = openProbe(arguments.file, arguments.mapping, "--probe-mapping");
  const Probe probe(loaded.latLong);
  const Importance importance(probe, arguments.compensated);
  const RowDistribution row =
      rowDistribution(probe, importance, chosenRow(arguments, probe, importance), range,
                      arguments.samples, arguments.file);
  const std::string title =
      fmt::format("{}: row {}, elevation {:.4g} degrees, {} sample{}",
                  std::filesystem::path(arguments.file).filename().string(), row.row, row.elevation,
                  row.samples.size(), row.samples.size() == 1 ? "" : "s");
  writeText(arguments.out, rowPlot(probe, row, title));
}

}  // namespace

void addProbePlotCommand(Command probe) {
  auto [command, a] = probe.addCommand<ProbePlotArguments>(
      "plot", "Plot how importance sampling draws directions from one row of a probe.", run);
  command.addRequired("PROBE", a.file, "the probe's image");
  command.addRequired("OUT", a.out, "the plot to write: .svg");
  command.addOption("--row", a.row,
                    "row of texels of the lat-long map, from 0 at the top; else the brightest");
  command.addOption("--elevation", a.elevation, "or the row at this elevation, degrees")
      .excludes("--row");
  command.addOption("--azimuth", a.azimuth,
                    "A,B: the part to plot, in degrees from -Z, the map's centre, "
                    "counter-clockwise seen from above; else all of the row");
  command.addWithDefault("--samples", a.samples, "number of samples to draw");
  command.addFlag("--compensated", a.compensated,
                  "sample what is brighter than the mean, as renders with MIS do");
  command.addOption("--probe-mapping", a.mapping, "the mapping of PROBE; auto detects it");
}

}  // namespace chromeball
