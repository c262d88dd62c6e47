// SPDX-License-Identifier: Apache-2.0
// chromeball lights PROBE --method NAME --count N -o FILE
#include <cstdio>

#include "base/error.h"
#include "commands.h"
#include "image/io/write.h"
#include "job/arguments.h"
#include "job/output_file.h"
#include "light_methods.h"
#include "lighting/light_preview.h"
#include "probe/load.h"

namespace chromeball {
namespace {

struct Arguments {
  std::string probe, mapping = "auto", output, preview, maxError, units = "photometric";
  LightOptions options;
};

// "5" or "5%".
double parsePercent(std::string text, std::string_view option) {
  if (text.ends_with('%')) text.pop_back();
  const double percent = parseNumbers(text, 1, option).front();
  if (!(percent > 0)) throwInput("{}: should be a percentage above 0", option);
  return percent;
}

void run(Arguments arguments) {
  LightOptions& options = arguments.options;
  checkLightMethod(options.method, "--method");
  if (!arguments.maxError.empty())
    options.maxError = parsePercent(arguments.maxError, "--max-error");
  checkLightOptions(options);
  const LightUnits units = parseLightUnits({arguments.units, "--light-units"});
  checkOutputFile(arguments.output, {".json", ".gltf", ".csv"});
  if (!arguments.preview.empty()) checkWritable(arguments.preview);
  checkDistinct({arguments.output, arguments.preview}, {arguments.probe});

  const LoadedProbe probe = loadProbe(arguments.probe, arguments.mapping, "--mapping");
  for (const std::string& warning : warnings(probe, arguments.probe))
    fmt::print(stderr, "chromeball: {}\n", warning);
  auto [rig, meanError] = makeLights(probe.latLong, options);
  rig.probe = arguments.probe;
  rig.units = units;
  writeLights(arguments.output, rig);
  if (!arguments.preview.empty())
    writeImage(arguments.preview, lightPreview(probe.latLong, rig.lights));
  fmt::print("lights      {}\n", rig.lights.size());
  if (meanError) fmt::print("mean error  {:.3g}%\n", *meanError);
  if (meanError && options.maxError && *meanError > *options.maxError)
    fmt::print(stderr, "chromeball: --max-error: {} lights do not reach {}%\n", rig.lights.size(),
               *options.maxError);
}

}  // namespace

void addLightsCommand(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("lights", "Stand directional lights in for a probe, for other programs.");
  command->add_option("PROBE", arguments->probe, "the probe's image")->required();
  command->add_option("--method", arguments->options.method, lightMethodList())->required();
  command->add_option("--count", arguments->options.count,
                      "how many lights; cube-grid: points along a face's edge; suns: the most to "
                      "keep, else all");
  command
      ->add_option("-o,--output", arguments->output,
                   "the lights to write: .json, .gltf (KHR_lights_punctual) or .csv")
      ->required();
  command->add_option("--light-units", arguments->units,
                      "of a .gltf: photometric (683 lux for 1 W/m^2, as Blender reads them), or "
                      "radiometric (1 lux)");
  command->add_option("--preview", arguments->preview,
                      "draw the lights into the probe, and write this image");
  command->add_option("--max-error", arguments->maxError,
                      "irradiance-fit: percent of the mean irradiance; the fewest lights, at most "
                      "--count, whose mean error is no more");
  command->add_flag("--ambient", arguments->options.ambient,
                    "irradiance-fit: fit a constant radiance too");
  command->add_option("--seed", arguments->options.seed, "of the methods that throw dice");
  command->add_option("--mapping", arguments->mapping, "the mapping of PROBE; auto guesses");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace chromeball
