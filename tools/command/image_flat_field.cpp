// SPDX-License-Identifier: Apache-2.0
// chromeball image flat-field SERIES... -o F.exr

#include "base/error.h"
#include "commands.h"
#include "front/arguments.h"
#include "image/flat_field.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "json_values.h"
#include "messages.h"

namespace chromeball {
namespace {

struct ImageFlatFieldArguments {
  std::vector<std::string> files, positions;
  std::string output, centre;
  double radius = 3;
  bool json = false;
};

dvec2 parsePoint(const std::string& text, std::string_view option) {
  const std::vector<double> point = parseNumbers(text, 2, option);
  return {point[0], point[1]};
}

struct Series {
  std::vector<SourceSample> samples;
  ImageSize size{};
};

// Whether a pixel of the source is one that `probe merge` marks as clipped.
bool isMarkedNear(const Image& clipped, const dvec2& position, double radius) {
  for (int y = 0; y < clipped.height; ++y)
    for (int x = 0; x < clipped.width; ++x)
      if (*clipped.at(x, y) > 0 && glm::distance(dvec2(x + 0.5, y + 0.5), position) <= radius + 1)
        return true;
  return false;
}

Series measure(const ImageFlatFieldArguments& arguments) {
  constexpr float kSaturated = 0.98f;
  Series series;
  for (size_t i = 0; i < arguments.files.size(); ++i) {
    const std::string& file = arguments.files[i];
    ImageFile read = openImageFile(file);
    const bool hasWhite = read.integers;
    const std::optional<Image> clipped = layerOf(read, "clipped", file);
    const Image image = colorOf(std::move(read), file);
    if (i == 0) series.size = {image.width, image.height};
    if (image.width != series.size.width || image.height != series.size.height)
      throwInput("{}: is {} x {}, but {} is {} x {}; photographs of a series have one size", file,
                 image.width, image.height, arguments.files.front(), series.size.width,
                 series.size.height);
    const dvec2 position = arguments.positions.empty() ? findSource(image)
                                                       : parsePoint(arguments.positions[i], "--at");
    series.samples.push_back(measureSource(image, position, arguments.radius, file));
    const bool isWhite = hasWhite && maxComponent(Rgb(series.samples.back().radiance)) > kSaturated;
    if (isWhite || (clipped && isMarkedNear(*clipped, position, arguments.radius)))
      throwInput("{}: the source at {:.1f},{:.1f} is saturated; expose less", file, position.x,
                 position.y);
  }
  return series;
}

JsonValue toJson(const FlatField& field, const Series& series) {
  JsonValue samples = JsonValue::array();
  for (const SourceSample& sample : series.samples)
    samples.push_back({{"position", {sample.position.x, sample.position.y}},
                       {"radiance", vectorToJson(sample.radiance)}});
  return {{"centre", {field.centre.x, field.centre.y}},
          {"unit", field.unit},
          {"a2", vectorToJson(field.a2)},
          {"a4", vectorToJson(field.a4)},
          {"a6", vectorToJson(field.a6)},
          {"largest_r", field.largest},
          {"rms_error", vectorToJson(field.rmsError)},
          {"samples", samples}};
}

void print(const FlatField& field, const Series& series) {
  for (const auto& [name, a] : {std::pair{"a2", field.a2}, {"a4", field.a4}, {"a6", field.a6}})
    say("{:<12}{:.5g} {:.5g} {:.5g}\n", name, a.x, a.y, a.z);
  const dvec3 corner = field.at(field.centre + dvec2(field.unit, 0));
  say("r = 1       at {:.5g} pixels from {:.5g},{:.5g}: response {:.4g} {:.4g} {:.4g}\n",
      field.unit, field.centre.x, field.centre.y, corner.x, corner.y, corner.z);
  say("samples     {}, r up to {:.3g}\n", series.samples.size(), field.largest);
  const dvec3 error = 100.0 * field.rmsError;
  say("error       {:.2g}% {:.2g}% {:.2g}% of the samples, RMS\n", error.x, error.y, error.z);
}

void run(const ImageFlatFieldArguments& arguments) {
  constexpr double kReaches = 0.9, kPoorFit = 0.02;
  checkWritable(arguments.output);
  checkDistinct({arguments.output}, arguments.files);
  if (!arguments.positions.empty() && arguments.positions.size() != arguments.files.size())
    throwInput("--at: {} positions for {} photographs; give one for each, or none",
               arguments.positions.size(), arguments.files.size());
  if (!(arguments.radius >= 0 && std::isfinite(arguments.radius)))
    throwInput("--radius: {} should be at least 0", arguments.radius);
  const Series series = measure(arguments);
  const auto [width, height] = series.size;
  const dvec2 centre = arguments.centre.empty() ? dvec2(width, height) / 2.0
                                                : parsePoint(arguments.centre, "--centre");
  if (!(centre.x >= -width && centre.x <= 2 * width && centre.y >= -height &&
        centre.y <= 2 * height))
    throwInput(
        "--centre: ({:g}, {:g}) is more than a picture's size outside of the picture, {} x {}",
        centre.x, centre.y, width, height);
  const FlatField field = fitFlatField(series.samples, width, height, centre);
  if (field.largest < kReaches)
    warn(
        "the source is never further from the centre than {:.2g} of half the diagonal: "
        "far beyond, the response stays constant",
        field.largest);
  if (const double error = std::max({field.rmsError.x, field.rmsError.y, field.rmsError.z});
      error > kPoorFit)
    warn(
        "the samples differ from the fit by {:.2g}%: is the source constant, and of "
        "even radiance within --radius?",
        100 * error);
  arguments.json ? printJson(toJson(field, series)) : print(field, series);
  print(writeImage(arguments.output, field.image(width, height)));
}

}  // namespace

void addImageFlatFieldCommand(Command image) {
  auto [command, a] = image.addCommand<ImageFlatFieldArguments>(
      "flat-field",
      "Fit how a lens darkens the image towards the corners, 1 + a2 r^2 + a4 r^4 + a6 r^6, to "
      "photographs that show one constant source at different places.",
      run);
  command.addRequired("SERIES", a.files,
                      "linear photographs with equal exposure, at least four, each with the source "
                      "at another distance from the centre");
  command.addRequired("-o,--output", a.output,
                      "the response to write, 1 in the centre: .exr, .hdr, .pfm or .png");
  command
      .addOption("--at", a.positions,
                 "X,Y: where the source is, in pixels; one for each photograph, in order. Without "
                 "it the brightest spot of each")
      .onePerName();
  command.addWithDefault("--radius", a.radius, "of the disc that is averaged, in pixels");
  command.addOption("--centre", a.centre,
                    "X,Y: of the lens, in pixels; without it the middle of the image");
  command.addFlag("--json", a.json, "print JSON");
}

}  // namespace chromeball
