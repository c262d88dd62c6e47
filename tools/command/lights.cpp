// SPDX-License-Identifier: Apache-2.0
// chromeball lights PROBE --method NAME --count N -o FILE
#include <cstdio>

#include "base/error.h"
#include "commands.h"
#include "image/io/write_image.h"
#include "job/arguments.h"
#include "job/output_file.h"
#include "lighting/light_file.h"
#include "lighting/light_preview.h"
#include "lighting/methods.h"
#include "messages.h"
#include "probe/load.h"

namespace chromeball {
namespace {

struct Arguments {
  std::string probe, mapping = "auto", method, output, preview, maxError, units = "photometric";
  bool regions = false;
  LightRequest request;
};

// "5" or "5%".
double parsePercent(std::string text, std::string_view option) {
  if (text.ends_with('%')) text.pop_back();
  const double percent = parseNumbers(text, 1, option).front();
  if (!(percent > 0)) throwInput("{}: should be a percentage above 0", option);
  return percent;
}

// Throws InputError for options that the method does not support, and for a missing count.
void checkOptions(const LightingMethod& method, const LightRequest& request) {
  const LightingMethod::Lights& lights = method.lights;
  if (request.levels && request.count) throwInput("--recursion: excludes --count; give one");
  if (request.levels && !lights.takesLevels)
    throwInput("--recursion: {} does not cut regions by levels; use median-cut", method.name);
  if (!request.count && !request.levels && !request.maxErrorPercent && !lights.countIsOptional)
    throwInput("--count: the number of lights is missing");
  if (request.ambient && !lights.fitsAmbient)
    throwInput("--ambient: {} fits no ambient light; use irradiance-fit", method.name);
  if (request.maxErrorPercent && !lights.takesMaxError)
    throwInput("--max-error: {} cannot search for a number of lights; use irradiance-fit",
               method.name);
}

void run(Arguments arguments) {
  LightRequest& request = arguments.request;
  const LightingMethod& method = lightMethod(arguments.method, "--method");
  if (!arguments.maxError.empty())
    request.maxErrorPercent = parsePercent(arguments.maxError, "--max-error");
  checkOptions(method, request);
  if (arguments.regions && arguments.preview.empty())
    throwInput("--regions: are drawn in the image of --preview, which is missing");
  if (arguments.regions && !method.lights.regions)
    throwInput("--regions: {} divides the probe into no regions", method.name);
  const LightUnits units = parseLightUnits({arguments.units, "--light-units"});
  checkOutputFile(arguments.output, {".json", ".gltf", ".csv"});
  if (!arguments.preview.empty()) checkWritable(arguments.preview);
  checkDistinct({arguments.output, arguments.preview}, {arguments.probe});

  const LoadedProbe probe = loadProbe(arguments.probe, arguments.mapping, "--mapping");
  for (const std::string& warning : warnings(probe, arguments.probe)) warn(warning);
  const auto [lights, ambient, meanError] = makeLights(arguments.method, probe.latLong, request);
  writeLights(arguments.output, {.probe = arguments.probe,
                                 .method = arguments.method,
                                 .ambient = ambient,
                                 .lights = lights,
                                 .units = units});
  if (!arguments.preview.empty())
    writeImage(arguments.preview, arguments.regions
                                      ? lightPreview(probe.latLong, lights,
                                                     method.lights.regions(probe.latLong, request))
                                      : lightPreview(probe.latLong, lights));
  fmt::print("lights      {}\n", lights.size());
  if (meanError) fmt::print("mean error  {:.3g}%\n", *meanError);
  if (meanError && request.maxErrorPercent && *meanError > *request.maxErrorPercent)
    warn(fmt::format("--max-error: {} lights do not reach {}%", lights.size(),
                     *request.maxErrorPercent));
}

}  // namespace

void addLightsCommand(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("lights", "Replace a probe by directional lights, for other programs.");
  command->add_option("PROBE", arguments->probe, "the probe's image")->required();
  command->footer(lightMethodHelp());
  command->add_option("--method", arguments->method, "how to find the lights; see below")
      ->required();
  command->add_option("--count", arguments->request.count,
                      "number of lights; of cube-grid: of lights along a face's edge; of suns: the "
                      "maximum");
  command
      ->add_option("-o,--output", arguments->output,
                   "the lights to write: .json, .gltf (KHR_lights_punctual) or .csv")
      ->required();
  command->add_option("--light-units", arguments->units,
                      "of a .gltf: photometric (683 lux for 1 W/m^2, as Blender reads them), or "
                      "radiometric (1 lux)");
  command->add_option("--preview", arguments->preview,
                      "write an image of the probe with a dot at each light");
  command->add_flag("--regions", arguments->regions,
                    "in the preview: outline the region of each light, of penrose the tiling");
  command->add_option("--recursion", arguments->request.levels,
                      "median-cut: in place of --count, cut all regions this many times: 8 lights "
                      "of 3");
  command->add_option("--max-error", arguments->maxError,
                      "irradiance-fit: find the smallest number of lights, up to --count, whose "
                      "mean error is no greater; percent of the mean irradiance");
  command->add_flag("--ambient", arguments->request.ambient,
                    "irradiance-fit: also fit a constant radiance from all directions");
  command->add_option("--seed", arguments->request.seed, "of stochastic methods");
  command->add_option("--mapping", arguments->mapping, "the mapping of PROBE; auto detects it");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace chromeball
