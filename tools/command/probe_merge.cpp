// SPDX-License-Identifier: Apache-2.0
// chromeball probe merge 1.jpg 2.jpg ... -o hdr.exr

#include "base/error.h"
#include "base/file.h"
#include "base/json.h"
#include "base/json_text.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "input_image.h"
#include "json_values.h"
#include "messages.h"
#include "probe/capture/merge_photographs.h"
#include "probe_commands.h"
#include "probe_merge_options.h"

namespace chromeball {
namespace {

using Json = nlohmann::ordered_json;

Json orNull(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }
Json orNull(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

Json toJson(const PhotographSeries& series, const MergedPhotographs& merged) {
  Json exposures = Json::array(), agreements = Json::array();
  for (size_t i = 0; i < series.files.size(); ++i)
    exposures.push_back({{"file", series.files[i]},
                         {"time", merged.settings[i].time},
                         {"aperture", orNull(merged.settings[i].aperture)},
                         {"iso", orNull(merged.settings[i].iso)},
                         {"factor", vectorToJson(merged.factors[i])},
                         {"used_pixels", merged.image.uses[i].weighted},
                         {"saturated_pixels", merged.image.uses[i].saturated}});
  for (const ExposureAgreement& a : merged.agreements)
    agreements.push_back(
        {{"longer", a.longer + 1},
         {"shorter", a.shorter + 1},
         {"given", a.factor},
         {"found_over_given", {orNull(a.found.x), orNull(a.found.y), orNull(a.found.z)}},
         {"pixels", a.pixels}});
  return {{"exposures", exposures},
          {"response", merged.responseName},
          {"white", merged.white},
          {"agreement", agreements},
          {"pixels", merged.image.clipped.texels.size()},
          {"clipped_in_all", merged.image.clippedPixels},
          {"underexposed_in_all", merged.image.underexposedPixels}};
}

std::string timeText(double seconds) {
  return seconds < 0.4 ? fmt::format("1/{:.4g} s", 1 / seconds) : fmt::format("{:.4g} s", seconds);
}

std::string factorText(const dvec3& f) {
  const bool isGrey = f.x == f.y && f.y == f.z;
  return isGrey ? fmt::format("{:.4g}", f.x) : fmt::format("{:.4g} {:.4g} {:.4g}", f.x, f.y, f.z);
}

std::string ratioText(double ratio) {
  return std::isfinite(ratio) ? fmt::format("{:.5g}", ratio) : "unknown";
}

std::string settingsText(const CameraSettings& settings) {
  std::string text = timeText(settings.time);
  if (settings.aperture) text += fmt::format(", f/{:g}", *settings.aperture);
  if (settings.iso) text += fmt::format(", ISO {:g}", *settings.iso);
  return text;
}

void print(const PhotographSeries& series, const MergedPhotographs& merged) {
  const double pixels = double(merged.image.clipped.texels.size()) / 100;
  for (size_t i = 0; i < series.files.size(); ++i)
    fmt::print("exposure {:<3}    {}: {}, factor {}; {:.3g}% used, {:.3g}% saturated\n", i + 1,
               series.files[i], settingsText(merged.settings[i]), factorText(merged.factors[i]),
               double(merged.image.uses[i].weighted) / pixels,
               double(merged.image.uses[i].saturated) / pixels);
  for (const ExposureAgreement& a : merged.agreements)
    if (const auto error = a.error())
      fmt::print("ratio {:>3} : {:<3}   given {:.5g}, found {} {} {} ({:.2g}% off)\n", a.longer + 1,
                 a.shorter + 1, a.factor, ratioText(a.factor * a.found.x),
                 ratioText(a.factor * a.found.y), ratioText(a.factor * a.found.z), 100 * *error);
  fmt::print("response        {}, white at {:g}\n", merged.responseName, merged.white);
  fmt::print("clipped         {} pixels in all exposures, {:.3g}%\n", merged.image.clippedPixels,
             double(merged.image.clippedPixels) / pixels);
  fmt::print("under-exposed   {} pixels in all exposures, {:.3g}%\n",
             merged.image.underexposedPixels, double(merged.image.underexposedPixels) / pixels);
}

// Of a merged image, from the channels of its photographs: those that a filter is applied in.
constexpr const char* kToRec709 = "photographsToRec709";

Metadata metadataOf(const MergedPhotographs& merged) {
  if (merged.toRec709 == glm::dmat3(1)) return {};
  Matrix44 matrix{};  // rows
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 4; ++k)
      matrix[size_t(4 * i + k)] = i < 3 && k < 3 ? float(merged.toRec709[k][i]) : float(i == k);
  return {{kToRec709, matrix}};
}

void merge(const MergeArguments& arguments) {
  if (arguments.files.empty()) throwInput("probe merge: give the photographs to merge");
  if (arguments.output.empty()) throwInput("probe merge: give -o, the image to write");
  const PhotographSeries series = arguments.series();
  checkWritable(arguments.output);
  if (lowerExtension(arguments.output) == ".png")
    throwInput("{}: a .png cannot hold the range; give an .exr, .hdr or .pfm", arguments.output);
  if (!arguments.responseOutput.empty()) checkReplaceable(arguments.responseOutput);
  std::vector<std::string> inputs = series.files;
  for (const auto& flatField : series.flatFields) inputs.push_back(flatField.file);
  inputs.push_back(series.response);
  checkDistinct({arguments.output, arguments.responseOutput}, inputs);

  MergedPhotographs merged = mergePhotographs(series);
  print(merged.messages);
  if (arguments.json)
    fmt::print("{}\n", jsonText(toJson(series, merged), 2));
  else
    print(series, merged);
  if (!arguments.responseOutput.empty()) merged.response.write(arguments.responseOutput);
  print(writeImage(arguments.output, OutputImage{{{"", "RGB", std::move(merged.image.radiance)},
                                                  {"clipped", "", std::move(merged.image.clipped)}},
                                                 metadataOf(merged),
                                                 {},
                                                 {}}));
}

glm::dmat3 photographsToRec709(const ImageFile& file, const std::string& path) {
  glm::dmat3 result = file.primaries ? toRec709(*file.primaries).value() : glm::dmat3(1);
  const auto found = file.metadata.find(kToRec709);
  if (found == file.metadata.end()) return result;
  const auto* matrix = std::get_if<Matrix44>(&found->second);
  if (matrix)
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) result[k][i] = (*matrix)[size_t(4 * i + k)];
  if (!matrix || !(std::abs(glm::determinant(result)) > 0))
    throwInput("{}: its {} is no matrix that can be inverted", path, kToRec709);
  return result;
}

struct View {
  Image channels;  // of the photographs
  std::optional<Image> clipped;
  glm::dmat3 toRec709;
};

View readView(const std::string& path) {
  ImageFile file = openImageFile(path);
  View view{{}, layerOf(file, "clipped", path), photographsToRec709(file, path)};
  view.channels = colorOf(std::move(file), path);
  if (view.toRec709 != glm::dmat3(1)) convertColor(view.channels, glm::inverse(view.toRec709));
  return view;
}

void calibrate(const MergeArguments& arguments) {
  constexpr double kTolerance = 0.02;
  arguments.checkCalibration();
  const auto [with, clippedWith, space] = readView(arguments.calibration[0]);
  const auto [without, clippedWithout, otherSpace] = readView(arguments.calibration[1]);
  if (space != otherSpace)
    throwInput("{}: its photographs' primaries are not those of {}; give two images of one camera",
               arguments.calibration[0], arguments.calibration[1]);
  if (with.width != without.width || with.height != without.height)
    throwInput("{}: is {} x {}, but {} is {} x {}; give two images of one view",
               arguments.calibration[0], with.width, with.height, arguments.calibration[1],
               without.width, without.height);
  const FilterTransmission filter =
      filterTransmission(with, clippedWith ? &*clippedWith : nullptr, without,
                         clippedWithout ? &*clippedWithout : nullptr);
  const dvec3& t = filter.transmission;
  for (int c = 0; c < 3; ++c)
    if (!(std::abs(filter.median[c] / t[c] - 1) <= kTolerance)) {
      warn(
          "the median of the pixels' ratios, {:.4g} {:.4g} {:.4g}, differs from that "
          "of their sums: is the light or the scene another, or dark noise strong?",
          filter.median.x, filter.median.y, filter.median.z);
      break;
    }
  if (arguments.json)
    fmt::print("{}\n", jsonText(Json{{"transmission", vectorToJson(t)},
                                     {"median", vectorToJson(filter.median)},
                                     {"pixels", filter.pixels}},
                                2));
  else
    fmt::print("transmission    {:.5g},{:.5g},{:.5g} of {} pixels\n", t.x, t.y, t.z, filter.pixels);
}

}  // namespace

void addProbeMergeCommand(Command probe) {
  const auto arguments = std::make_shared<MergeArguments>();
  Command command = probe.addCommand(
      "merge",
      "Merge photographs of one view that differ in exposure into an image of high dynamic range.");
  arguments->addTo(command);
  command.callback([arguments] {
    if (arguments->calibration.empty())
      merge(*arguments);
    else
      calibrate(*arguments);
  });
}

}  // namespace chromeball
