// SPDX-License-Identifier: Apache-2.0
// chromeball probe sun CLIPPED.exr --diffuse BALL.exr --circle X,Y,R --paint R,G,B --camera AZ,EL

#include "base/error.h"
#include "base/file.h"
#include "commands.h"
#include "front/arguments.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "json_values.h"
#include "lighting/export/light_file.h"
#include "messages.h"
#include "probe/capture/sun_from_ball.h"
#include "probe/synth.h"

namespace chromeball {
namespace {

constexpr double kSeldomExplained = 0.2;  // of the mean: another direction, or another ball

struct ProbeSunArguments {
  std::string probe, mapping = "auto", ball, circle, paint, camera, distance, direction, mask;
  std::string output, lights, residual;
  double angle = 0.53;
  bool json = false;
};

DiffuseBall parseBall(const ProbeSunArguments& arguments) {
  const std::vector<double> circle = parseNumbers(arguments.circle, 3, "--circle");
  const bool isGrey = arguments.paint.find(',') == std::string::npos;
  std::vector<double> paint = parseNumbers(arguments.paint, isGrey ? 1 : 3, "--paint");
  if (isGrey) paint.resize(3, paint.front());
  const std::vector<double> camera = parseNumbers(arguments.camera, 2, "--camera");
  DiffuseBall ball{.circle = {{circle[0], circle[1]}, circle[2]},
                   .paint = {paint[0], paint[1], paint[2]},
                   .camera = {camera[0], camera[1]}};
  if (!(ball.circle.radius >= 8))
    throwInput("--circle: the radius {} should be at least 8", ball.circle.radius);
  for (const double channel : paint)
    if (!(channel > 0 && channel <= 1))
      throwInput("--paint: {} should be a reflectance, above 0 and at most 1", arguments.paint);
  if (std::abs(ball.camera.elevation) > 90)
    throwInput("--camera: the elevation {} should be -90 to 90 degrees", ball.camera.elevation);
  if (!arguments.distance.empty())
    ball.distance = parseNumbers(arguments.distance, 1, "--distance").front();
  if (!(ball.distance > 1))
    throwInput("--distance: {} should be above 1, in radii of the ball", ball.distance);
  return ball;
}

// 1 where a pixel of the ball does not count: outside the mask, or saturated.
Image excludedPixels(const ProbeSunArguments& arguments, const ImageFile& file,
                     const Image& photograph) {
  constexpr float kSaturated = 0.98f;
  const std::optional<Image> clipped = layerOf(file, "clipped", arguments.ball);
  Image mask;
  if (!arguments.mask.empty())
    mask = maskOf(openImageFile(arguments.mask, IntegerTexels::Linear), arguments.mask);
  if (!mask.empty() && (mask.width != photograph.width || mask.height != photograph.height))
    throwInput("{}: is {} x {}, but {} is {} x {}; a mask has the photograph's size",
               arguments.mask, mask.width, mask.height, arguments.ball, photograph.width,
               photograph.height);
  Image excluded(photograph.width, photograph.height, 1);
  for (int y = 0; y < excluded.height; ++y)
    for (int x = 0; x < excluded.width; ++x) {
      const bool isMasked = !mask.empty() && !(maxComponent(mask.rgb(x, y)) > 0.5f);
      const bool isClipped = clipped && *clipped->at(x, y) > 0.5f;
      const bool isWhite = file.integers && maxComponent(photograph.rgb(x, y)) >= kSaturated;
      *excluded.at(x, y) = isMasked || isClipped || isWhite ? 1 : 0;
    }
  return excluded;
}

BallSamples readBall(const ProbeSunArguments& arguments, const DiffuseBall& ball) {
  const ImageFile file = openImageFile(arguments.ball);
  const Image photograph = colorOf(ImageFile(file), arguments.ball);
  if (file.integers)
    warn("{}: has integer texels, {}; a merged .exr is linear", arguments.ball,
         decodingInWords(file));
  BallSamples samples =
      sampleBall(ball, photograph, excludedPixels(arguments, file, photograph), arguments.ball);
  if (samples.invalid > 0)
    warn("{}: left out {} pixels that are not finite, or negative", arguments.ball,
         samples.invalid);
  return samples;
}

// The direction of the sun, and the width of its plateau if the probe shows one.
struct Direction {
  dvec3 direction;
  std::optional<double> width;
};

Direction directionOf(const ProbeSunArguments& arguments, const LoadedProbe& probe) {
  constexpr double kWide = 3;
  if (!arguments.direction.empty()) {
    const std::vector<double> d = parseNumbers(arguments.direction, 3, "--direction");
    const dvec3 direction(d[0], d[1], d[2]);
    if (!(glm::length(direction) > 0)) throwInput("--direction: should not be 0,0,0");
    return {glm::normalize(direction), std::nullopt};
  }
  const std::optional<Image> clipped = loadClippedLayer(arguments.probe, probe);
  const ClippedSun sun =
      findClippedSun(probe.latLong, clipped ? &*clipped : nullptr, arguments.probe);
  if (sun.width > kWide)
    warn(
        "{}: what is clipped around the sun is {:.2g} degrees wide, so that its "
        "direction is uncertain; give --direction",
        arguments.probe, sun.width);
  if (sun.rivals > 0)
    warn(
        "{}: {} other clipped region{} half as large as the sun's or larger; give "
        "--direction if the sun is another one",
        arguments.probe, sun.rivals, sun.rivals == 1 ? " is" : "s are");
  return {sun.direction, sun.width};
}

// An .exr holds the residual itself; in a .png 0 is middle grey, and 10% of the mean black or
// white.
void writeResidual(const std::string& path, const SunFromBall& result, const BallSamples& ball) {
  Image image = result.residual;
  if (lowerExtension(path) == ".png") {
    dvec3 sum(0);
    for (const BallSample& sample : ball.samples) sum += sample.radiance;
    const float mean = float((sum.x + sum.y + sum.z) / (3 * double(ball.samples.size())));
    for (float& channel : image.texels)
      channel = srgbToLinear(std::clamp(0.5f + 5 * channel / mean, 0.0f, 1.0f));
  }
  print(writeImage(path, image));
}

JsonValue toJson(const SunFromBall& result, const Direction& direction, const BallSamples& ball) {
  return {{"direction", vectorToJson(result.sun.direction)},
          {"clipped_width", orNull(direction.width)},
          {"angle", result.sun.angle},
          {"alpha", vectorToJson(result.alpha)},
          {"irradiance", vectorToJson(result.sun.irradiance)},
          {"radiance", vectorToJson(result.radiance())},
          {"samples", ball.samples.size()},
          {"pixels_per_sample", ball.block * ball.block},
          {"rms_clipped", result.rmsOfProbe},
          {"rms", result.rms},
          {"explained", result.explained}};
}

void print(const SunFromBall& result, const Direction& direction, const BallSamples& ball) {
  const auto triple = [](const dvec3& v) {
    return fmt::format("{:.5g} {:.5g} {:.5g}", v.x, v.y, v.z);
  };
  const auto width = direction.width
                         ? fmt::format(", clipped {:.3g} degrees wide", *direction.width)
                         : std::string();
  say("direction   {}{}\n", triple(result.sun.direction), width);
  say("alpha       {}, of a sun of irradiance pi\n", triple(result.alpha));
  say("irradiance  {}\n", triple(result.sun.irradiance));
  say("radiance    {}, {:g} degrees wide\n", triple(result.radiance()), result.sun.angle);
  say("samples     {} of {} pixel{}\n", ball.samples.size(), ball.block * ball.block,
      ball.block == 1 ? "" : "s");
  say("residual    {:.3g}% of the mean, RMS; {:.3g}% without the sun\n", 100 * result.rms,
      100 * result.rmsOfProbe);
  say("explained   {:.3g}% of the samples within {:g}% of the mean\n", 100 * result.explained,
      100 * kExplained);
}

void run(const ProbeSunArguments& arguments) {
  const DiffuseBall ball = parseBall(arguments);
  if (!(arguments.angle >= kLeastListedAngle && arguments.angle <= kMaxListedAngle))
    throwInput("--angle: should be {} to {} degrees", kLeastListedAngle, kMaxListedAngle);
  for (const std::string& image : {arguments.output, arguments.residual})
    if (!image.empty()) checkWritable(image);
  if (!arguments.lights.empty() && lightFormat(arguments.lights, "", "") != LightFormat::Json)
    throwInput("--lights: {} should end in .json, which [[light]] and `probe add-sun` read",
               arguments.lights);
  if (!arguments.lights.empty()) checkReplaceable(arguments.lights);
  checkDistinct({arguments.output, arguments.lights, arguments.residual},
                {arguments.probe, arguments.ball, arguments.mask});

  LoadedProbe probe = openProbe(arguments.probe, arguments.mapping, "--probe-mapping");
  const Direction direction = directionOf(arguments, probe);
  const BallSamples samples = readBall(arguments, ball);
  const SunFromBall result = solveSun(probe.latLong, samples, direction.direction, arguments.angle);
  if (result.rms > kSeldomExplained)
    warn(
        "the ball differs by {:.3g}% of its mean from what probe and sun make it, by "
        "{:.3g}% without the sun: check --camera, --direction, --circle and --paint",
        100 * result.rms, 100 * result.rmsOfProbe);
  arguments.json ? printJson(toJson(result, direction, samples))
                 : print(result, direction, samples);
  const Sun& sun = result.sun;
  if (!arguments.residual.empty()) writeResidual(arguments.residual, result, samples);
  if (!arguments.lights.empty())
    writeLights(arguments.lights,
                LightRig{.probe = arguments.probe,
                         .method = "sun",
                         .ambient = {},
                         .lights = {{vec3(sun.direction), Rgb(sun.irradiance), float(sun.angle)}}});
  if (!arguments.output.empty()) {
    addSunDisc(probe.latLong, sun.direction, sun.angle, sun.irradiance);
    writeProbe(arguments.output, probe.latLong);
  }
}

}  // namespace

void addProbeSunCommand(Command probe) {
  auto [command, a] = probe.addCommand<ProbeSunArguments>(
      "sun",
      "Find the irradiance of a sun that a probe's photographs have clipped, from a photograph of "
      "a diffuse ball in the same light and with the same exposure.",
      run);
  command.addRequired("CLIPPED", a.probe, "the probe's image");
  command.addRequired("--diffuse", a.ball, "the photograph of the ball, linear");
  command.addRequired("--circle", a.circle, "X,Y,R: the ball in it, in pixels");
  command.addRequired("--paint", a.paint, "X or R,G,B: the reflectance of the ball");
  command.addRequired("--camera", a.camera,
                      "AZ,EL: where the camera is, seen from the ball, in degrees: 0 is +Z, 90 is "
                      "+X; elevation 90 is +Y");
  command.addOption("--distance", a.distance,
                    "of the camera, in radii of the ball; without it infinite");
  command.addWithDefault("--angle", a.angle, "diameter of the sun in degrees");
  command.addOption("--direction", a.direction,
                    "X,Y,Z: towards the sun; without it the middle of what is clipped: the layer "
                    "`clipped` (`probe merge`), or the brightest texels");
  command.addOption("--mask", a.mask,
                    "an image of the photograph's size, black where the ball does not count");
  command.addOption("-o,--output", a.output,
                    "the lat-long map with the sun to write: .exr, .hdr, .pfm or .png");
  command.addOption("--lights", a.lights,
                    "the sun as a list of lights to write, .json; [[light]] `file` reads it");
  command.addOption("--residual", a.residual,
                    "an image to write of what neither probe nor sun explain: .exr, or .png in "
                    "which black and white are 10% of the mean");
  command.addOption("--probe-mapping", a.mapping, "the mapping of CLIPPED; auto detects it");
  command.addFlag("--json", a.json, "print JSON");
}

}  // namespace chromeball
