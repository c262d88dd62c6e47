// SPDX-License-Identifier: Apache-2.0
// chromeball lights PROBE --method NAME --count N -o FILE
#include "lights.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "base/error.h"
#include "base/file.h"
#include "commands.h"
#include "front/arguments.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "lighting/export/light_file.h"
#include "lighting/export/light_preview.h"
#include "lighting/fit/light_descent.h"
#include "lighting/methods.h"
#include "math/icosphere.h"
#include "messages.h"
#include "probe/irradiance.h"
#include "probe_options.h"
#include "progress_bar.h"

namespace chromeball {
namespace {

constexpr double kMaxAngle = 10;  // degrees; more is no longer a light from one direction

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

// Also checks options that have no meaning without another.
void checkPictures(const LightingMethod& method, const LightsArguments& arguments) {
  if (arguments.regions && arguments.preview.empty())
    throwInput("--regions: are drawn in the image of --preview, which is missing");
  if (arguments.regions && !method.lights.regions)
    throwInput("--regions: {} divides the probe into no regions", method.name);
  if (arguments.normals && arguments.sphere.empty())
    throwInput("--normals: are those of --sphere, which is missing");
  if (!arguments.preview.empty()) checkWritable(arguments.preview);
  if (!arguments.sphere.empty()) checkWritable(arguments.sphere);
  checkDistinct({arguments.output, arguments.preview, arguments.sphere}, {arguments.probe.file});
}

void warnOfUnits(const LightsArguments& arguments, LightFormat format) {
  if (!arguments.units.empty() && format != LightFormat::Gltf)
    warn("--light-units: has no effect on {}, which holds {}", arguments.output,
         format == LightFormat::OpenGl ? "radiance" : "irradiance in W/m^2");
}

// Warns of light that was asked for or found, but is not in the file where other programs look for
// it.
void warnOfLosses(const LightsArguments& arguments, const MadeLights& made, LightFormat format) {
  const bool isGltf = format == LightFormat::Gltf;
  constexpr const char* kUnread = "is only in `extras`, which other programs do not read";
  if (made.ambient && (isGltf || format == LightFormat::Csv))
    warn("{}: the fitted ambient light {}; a .json holds it", arguments.output,
         isGltf ? kUnread : "is not in a .csv");
  const bool hasAngle = std::any_of(made.lights.begin(), made.lights.end(),
                                    [](const DirectionalLight& light) { return light.angle > 0; });
  if (hasAngle && (isGltf || format == LightFormat::OpenGl))
    warn("{}: the lights' angular diameter {}; a .json holds it", arguments.output,
         isGltf ? kUnread : "is not in a header for OpenGL");
  constexpr size_t kOpenGlLights = 8;
  if (format == LightFormat::OpenGl && made.lights.size() > kOpenGlLights)
    warn("{}: {} lights; OpenGL is sure to have {}", arguments.output, made.lights.size(),
         kOpenGlLights);
}

std::string rgbText(const dvec3& c) { return fmt::format("{:.4g} {:.4g} {:.4g}", c.x, c.y, c.z); }

// Writes the picture, and prints what it shows.
void writeSphere(const std::string& file, const Image& latLong, const MadeLights& made,
                 int subdivisions) {
  const std::vector<vec3> normals = icosphereNormals(subdivisions);
  const Rgb ambient = made.ambient.value_or(Rgb(0));
  const IrradianceSpheres spheres{subdivisions, exactIrradiance(latLong, normals),
                                  irradianceOf(made.lights, ambient, normals), made.ambient};
  print(writeImage(file, irradianceSpheres(spheres)));
  const LightError error = lightError(spheres.lights, spheres.probe);
  const auto mean = [](const std::vector<dvec3>& all) {
    return std::accumulate(all.begin(), all.end(), dvec3(0)) / double(all.size());
  };
  say("sphere      mean error {:.4g}%, maximum {:.4g}% over {} normals; mean irradiance of the "
      "probe {}, of the lights {}",
      error.mean, error.max, normals.size(), rgbText(mean(spheres.probe)),
      rgbText(mean(spheres.lights)));
  if (made.ambient) say("; ambient radiance {}", rgbText(dvec3(ambient)));
  say("\n            columns: probe, lights, {:g} x (lights - probe) about grey{}; rows: facing +Z "
      "(front), -Z (back)\n",
      differenceGain(spheres), made.ambient ? ", ambient light" : "");
}

LightUnits unitsOf(const LightsArguments& arguments) {
  return arguments.units.empty() ? LightUnits::Photometric
                                 : parseLightUnits({arguments.units, "--light-units"});
}

// Makes polygons instead of lights by a method.
void runPolygonsOf(const LightsArguments& arguments, const Command& command) {
  if (!arguments.method.empty())
    throwInput("--method: excludes --suggest and --polygons; give one");
  command.refuse({"--count", "--recursion", "--max-error", "--ambient", "--angle", "--regions",
                  "--sphere", "--normals", "--seed"},
                 "is for the lights of a --method, not for polygons");
  if (arguments.suggest)
    command.refuse({"--format", "--light-units"},
                   "is for lights; --suggest writes polygons, a .json; leave it out");
  const LightFormat format = arguments.suggest
                                 ? LightFormat::Json
                                 : lightFormat(arguments.output, arguments.format, "--format");
  checkReplaceable(arguments.output);
  if (!arguments.preview.empty()) checkWritable(arguments.preview);
  arguments.probe.checkMask();
  runPolygons(arguments, format, unitsOf(arguments));
  warnOfUnits(arguments, format);
}

void run(const LightsArguments& arguments, const Command& command) {
  if (arguments.suggest || !arguments.polygons.empty()) return runPolygonsOf(arguments, command);
  if (arguments.method.empty())
    throwInput("--method: is missing; or give --suggest N or --polygons FILE");
  LightRequest request = arguments.request;
  const LightingMethod& method = lightMethod(arguments.method, "--method");
  if (!arguments.maxError.empty())
    request.maxErrorPercent = parsePercent(arguments.maxError, "--max-error");
  checkOptions(method, request);
  if (arguments.angle && !(*arguments.angle > 0 && *arguments.angle <= kMaxAngle))
    throwInput("--angle: should be above 0 and at most {} degrees", kMaxAngle);
  const int subdivisions = subdivisionsFor(arguments.normals.value_or(20480));
  arguments.probe.checkMask();
  if (arguments.seed) request.seed = parseSeed(*arguments.seed);
  const LightUnits units = unitsOf(arguments);
  const LightFormat format = lightFormat(arguments.output, arguments.format, "--format");
  checkReplaceable(arguments.output);
  checkPictures(method, arguments);
  if (arguments.seed && !method.lights.isStochastic)
    warn("--seed: has no effect: {} is not stochastic", method.name);

  const Image latLong = arguments.probe.load();
  std::optional<BusyLine> busy("making lights");
  MadeLights made = makeLights(arguments.method, latLong, request);
  busy.reset();
  if (arguments.angle)
    for (DirectionalLight& light : made.lights) light.angle = float(*arguments.angle);
  const auto& [lights, ambient, meanError] = made;
  writeLights(arguments.output,
              {.probe = arguments.probe.file,
               .method = arguments.method,
               .ambient = ambient,
               .lights = turned(lights, arguments.rotation),
               .units = units},
              format);
  warnOfUnits(arguments, format);
  warnOfLosses(arguments, made, format);
  if (!arguments.preview.empty())
    print(writeImage(arguments.preview,
                     arguments.regions
                         ? lightPreview(latLong, lights, method.lights.regions(latLong, request))
                         : lightPreview(latLong, lights)));
  say("lights      {}\n", lights.size());
  if (meanError) say("mean error  {:.3g}%\n", *meanError);
  if (!arguments.sphere.empty()) writeSphere(arguments.sphere, latLong, made, subdivisions);
  if (meanError && request.maxErrorPercent && *meanError > *request.maxErrorPercent)
    warn("--max-error: {} lights do not reach {}%", lights.size(), *request.maxErrorPercent);
}

}  // namespace

void addLightsCommand(Command app) {
  auto [command, a] = app.addCommand<LightsArguments>(
      "lights", "Replace a probe by directional lights, for other programs.", run);
  command.addRequired("PROBE", a.probe.file, "the probe's image");
  command.footer(lightMethodHelp());
  command.addOption("--method", a.method, "how to find the lights; see below");
  command.addOption("--suggest", a.suggest,
                    "in place of a method: propose polygons around so many bright regions, as a "
                    ".json that [[source]] reads");
  command.addOption("--polygons", a.polygons,
                    "in place of a method: a light for each polygon of this .json");
  command.addOption(
      "--count", a.request.count,
      "number of lights; of cube-grid: of lights along a face's edge; of suns: the maximum");
  command.addRequired(
      "-o,--output", a.output,
      "the lights to write: .json, .gltf (KHR_lights_punctual), .csv or .h (OpenGL)");
  command.addOption("--format", a.format,
                    "of the output, whatever its name: json, gltf, csv or opengl (a C header of "
                    "values for glLightfv)");
  command.addOption("--angle", a.angle,
                    "angular diameter of the written lights in degrees, up to 10; a .json then has "
                    "their radiance too");
  command.addOption("--light-units", a.units,
                    "of a .gltf: photometric (683 lux for 1 W/m^2, as Blender reads them; the "
                    "default), or radiometric (1 lux)");
  command.addOption("--preview", a.preview, "write an image of the probe with a dot at each light");
  command.addFlag("--regions", a.regions,
                  "in the preview: outline the region of each light, of penrose the tiling");
  command.addOption(
      "--sphere", a.sphere,
      "write an image of white spheres: in the left column lit by the probe, in the middle by the "
      "lights, in the right one their difference about grey, times a power of two that is printed; "
      "above the front (+Z), below the back; at the right edge a square of the ambient light");
  command.addOption(
      "--normals", a.normals,
      "number of faces of these spheres: 20 times a power of 4, up to 1310720; 20480 by default");
  command.addOption(
      "--recursion", a.request.levels,
      "median-cut: in place of --count, cut all regions this many times: 8 lights of 3");
  command.addOption("--max-error", a.maxError,
                    "irradiance-fit: find the smallest number of lights, up to --count, whose mean "
                    "error is no greater; percent of the mean irradiance");
  command.addFlag("--ambient", a.request.ambient,
                  "irradiance-fit: also fit a constant radiance from all directions");
  command.addOption("--seed", a.seed, "of stochastic methods");
  addRotationOption(command, a.rotation,
                    ": the lights that are written; mask and images are those of the probe's map");
  command.addOption("--probe-mask", a.probe.mask, kMaskHelp);
  command.addOption("--probe-mapping", a.probe.mapping, "the mapping of PROBE; auto detects it");
}

}  // namespace chromeball
