// SPDX-License-Identifier: Apache-2.0
// chromeball probe merge 1.jpg 2.jpg ... -o hdr.exr
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "command.h"
#include "commands.h"
#include "front/arguments.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "json_values.h"
#include "messages.h"
#include "probe/capture/merge_photographs.h"

namespace chromeball {
namespace {

struct ProbeMergeArguments {
  std::vector<std::string> files, ratios, filters, flatFields, calibration;
  std::string output, exposures, apertures, response, responseOutput, smoothness, white;
  bool unaligned = false, resizes = false, json = false;
};

// "0.5" or "1/8", above 0.
double parsePositive(std::string_view text, std::string_view location) {
  const size_t slash = text.find('/');
  double number = parseNumbers(text.substr(0, slash), 1, location).front();
  if (slash != std::string_view::npos)
    number /= parseNumbers(text.substr(slash + 1), 1, location).front();
  if (!(number > 0) || !std::isfinite(number))
    throwInput("{}: `{}` should be above 0", location, text);
  return number;
}

// "1/10,1/40": empty if there is no text.
std::vector<double> parsePositives(std::string_view text, std::string_view location) {
  std::vector<double> numbers;
  if (text.empty()) return numbers;
  for (size_t from = 0; from <= text.size();) {
    const size_t comma = std::min(text.find(',', from), text.size());
    numbers.push_back(parsePositive(text.substr(from, comma - from), location));
    from = comma + 1;
  }
  return numbers;
}

// The texts before and after the first `separator`. Throws InputError with `form` if it is missing.
std::pair<std::string, std::string> divided(const std::string& text, char separator,
                                            std::string_view location, std::string_view form) {
  const size_t at = text.find(separator);
  if (at == std::string::npos) throwInput("{}: `{}` should be {}", location, text, form);
  return {text.substr(0, at), text.substr(at + 1)};
}

ApertureRatio parseRatio(const std::string& text) {
  constexpr const char *kOption = "--aperture-ratio", *kForm = "A:B=X, as in 4:16=16.63";
  const auto [apertures, ratio] = divided(text, '=', kOption, kForm);
  const auto [from, to] = divided(apertures, ':', kOption, kForm);
  return {parsePositive(from, kOption), parsePositive(to, kOption), parsePositive(ratio, kOption)};
}

PhotographSeries::Filter parseFilter(const std::string& text, size_t photographs) {
  constexpr const char* kOption = "--filter";
  const auto [index, transmission] = divided(text, '=', kOption, "K=R,G,B or K=X");
  const double k = parseNumbers(index, 1, kOption).front();
  if (!(k >= 1 && k <= double(photographs)) || k != std::floor(k))
    throwInput("--filter: `{}` should be the number of a photograph, 1 to {}", index, photographs);
  std::vector<double> c = parsePositives(transmission, kOption);
  if (c.size() == 1) c.resize(3, c.front());
  if (c.size() != 3) throwInput("--filter: `{}` should be one number or three", transmission);
  return {size_t(k) - 1, {c[0], c[1], c[2]}};
}

// "F.exr" or "4=F.exr"; a name may contain `=` if no number is before it.
PhotographSeries::FlatField parseFlatField(const std::string& text) {
  const size_t at = text.find('=');
  if (at == std::string::npos || text.substr(0, at).find_first_not_of("0123456789.") < at)
    return {std::nullopt, text};
  return {parsePositive(text.substr(0, at), "--flat-field"), text.substr(at + 1)};
}

// Converts the options, without looking at files.
PhotographSeries seriesOf(const ProbeMergeArguments& a) {
  PhotographSeries series;
  series.files = a.files;
  series.times = parsePositives(a.exposures, "--exposures");
  series.apertures = parsePositives(a.apertures, "--apertures");
  for (const std::string& text : a.ratios) series.apertureRatios.push_back(parseRatio(text));
  for (const std::string& text : a.filters)
    series.filters.push_back(parseFilter(text, a.files.size()));
  for (const std::string& text : a.flatFields) series.flatFields.push_back(parseFlatField(text));
  series.response = a.response;
  if (!a.smoothness.empty() && a.response != "solve")
    throwInput("--smoothness: has no effect without --response solve; leave it out");
  if (!a.smoothness.empty()) series.smoothness = parsePositive(a.smoothness, "--smoothness");
  constexpr double kSmoothest = 1e6;  // more leaves a straight line, and rounding errors
  if (!(series.smoothness <= kSmoothest))
    throwInput("--smoothness: `{}` should be at most {:g}", a.smoothness, kSmoothest);
  if (!a.white.empty()) series.white = float(parsePositive(a.white, "--white"));
  series.checkAlignment = !a.unaligned;
  series.resizes = a.resizes;
  return series;
}

JsonValue toJson(const PhotographSeries& series, const MergedPhotographs& merged) {
  JsonValue exposures = JsonValue::array(), agreements = JsonValue::array();
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
    say("exposure {:<3}    {}: {}, factor {}; {:.3g}% used, {:.3g}% saturated\n", i + 1,
        printableName(series.files[i]), settingsText(merged.settings[i]),
        factorText(merged.factors[i]), double(merged.image.uses[i].weighted) / pixels,
        double(merged.image.uses[i].saturated) / pixels);
  for (const ExposureAgreement& a : merged.agreements)
    if (const auto error = a.error())
      say("ratio {:>3} : {:<3}   given {:.5g}, found {} {} {} ({:.2g}% off)\n", a.longer + 1,
          a.shorter + 1, a.factor, ratioText(a.factor * a.found.x), ratioText(a.factor * a.found.y),
          ratioText(a.factor * a.found.z), 100 * *error);
  say("response        {}, white at {:g}\n", merged.responseName, merged.white);
  say("clipped         {} pixels in all exposures, {:.3g}%\n", merged.image.clippedPixels,
      double(merged.image.clippedPixels) / pixels);
  say("under-exposed   {} pixels in all exposures, {:.3g}%\n", merged.image.underexposedPixels,
      double(merged.image.underexposedPixels) / pixels);
}

// Of a merged image, from the channels of its photographs: those that a filter is applied in.
constexpr const char* kToRec709 = "photographsToRec709";

// Of the photographs' metadata only what tells their directions is true of the result.
Metadata metadataOf(const MergedPhotographs& merged, const ProbeMergeArguments& arguments) {
  Metadata ofFirst;
  for (const char* name : {kMappingAttribute, kEnvmapAttribute})
    if (const auto found = merged.metadata.find(name); found != merged.metadata.end())
      ofFirst.insert(*found);
  Metadata kept = keptMetadata(std::move(ofFirst), arguments.files.front(), arguments.output);
  if (merged.toRec709 == glm::dmat3(1)) return kept;
  Matrix44 matrix{};  // rows
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 4; ++k)
      matrix[size_t(4 * i + k)] = i < 3 && k < 3 ? float(merged.toRec709[k][i]) : float(i == k);
  kept[kToRec709] = matrix;
  return kept;
}

void merge(const ProbeMergeArguments& arguments) {
  if (arguments.files.empty()) throwInput("probe merge: give the photographs to merge");
  if (arguments.output.empty()) throwInput("probe merge: give -o, the image to write");
  const PhotographSeries series = seriesOf(arguments);
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
  arguments.json ? printJson(toJson(series, merged)) : print(series, merged);
  if (!arguments.responseOutput.empty()) merged.response.write(arguments.responseOutput);
  Metadata metadata = metadataOf(merged, arguments);
  writeKept(arguments.output,
            OutputImage{{{"", "RGB", std::move(merged.image.radiance)},
                         {"clipped", "", std::move(merged.image.clipped)}},
                        std::move(metadata),
                        {},
                        {}},
            arguments.files.front());
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

void calibrate(const ProbeMergeArguments& arguments, const Command& command) {
  constexpr double kTolerance = 0.02;
  if (!arguments.files.empty() || !arguments.output.empty())
    throwInput("--calibrate-filter: prints a transmission; give no photographs and no -o");
  command.refuse(
      {"--exposures", "--apertures", "--aperture-ratio", "--filter", "--flat-field", "--response",
       "--write-response", "--smoothness", "--white", "--resize", "--unaligned"},
      "has no effect with --calibrate-filter; leave it out");
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
    printJson(JsonValue{{"transmission", vectorToJson(t)},
                        {"median", vectorToJson(filter.median)},
                        {"pixels", filter.pixels}});
  else
    say("transmission    {:.5g},{:.5g},{:.5g} of {} pixels\n", t.x, t.y, t.z, filter.pixels);
}

void run(const ProbeMergeArguments& arguments, const Command& command) {
  arguments.calibration.empty() ? merge(arguments) : calibrate(arguments, command);
}

}  // namespace

void addProbeMergeCommand(Command probe) {
  auto [command, a] = probe.addCommand<ProbeMergeArguments>(
      "merge",
      "Merge photographs of one view that differ in exposure into an image of high dynamic range.",
      run);
  command.addOption("PHOTOGRAPHS", a.files,
                    "photographs of one view, of one size: JPEG, PNG, TIFF, .exr, .hdr or .pfm");
  command.addOption("-o,--output", a.output,
                    "the image to write: .exr (with the layer `clipped`), .hdr or .pfm");
  command.addJoinedOption(
      "--exposures", a.exposures,
      "exposure times in seconds, one for each photograph, as in 1/10,1/40; in place "
      "of EXIF's time, aperture and ISO");
  command.addJoinedOption("--apertures", a.apertures,
                          "f-numbers, one for each photograph, in place of EXIF's");
  command
      .addOption("--aperture-ratio", a.ratios,
                 "A:B=X: f/A lets X times as much light pass as f/B, measured; else (B/A)^2")
      .onePerName();
  command
      .addOption("--filter", a.filters,
                 "K=R,G,B: the K-th photograph was taken through a filter of this transmission")
      .onePerName();
  command
      .addOption("--flat-field", a.flatFields,
                 "F.exr, or N=F.exr for the photographs at f/N: divide by it (`image flat-field`)")
      .onePerName();
  command.addOption(
      "--response", a.response,
      "linear, srgb, solve or a file of --write-response; without it srgb for 8 bits, else linear");
  command.addOption("--write-response", a.responseOutput,
                    "the response as text: 256 levels and their exposures");
  command.addOption(
      "--smoothness", a.smoothness,
      fmt::format("of the solved response, default {:g}", PhotographSeries{}.smoothness));
  command.addOption("--white", a.white,
                    "where floats saturate; without it 1, or the largest number if that is higher. "
                    "The result has the scale of the files");
  command.addFlag("--resize", a.resizes,
                  "accept photographs of several sizes, each cropped to the same ball: resample "
                  "them to the smallest");
  command.addFlag("--unaligned", a.unaligned, "accept photographs that seem shifted");
  command
      .addOption("--calibrate-filter", a.calibration,
                 "WITH WITHOUT: instead, print the transmission of a filter from two merged images "
                 "(.exr, which keeps the photographs' primaries)")
      .words(2);
  command.addFlag("--json", a.json, "print JSON");
}

}  // namespace chromeball
