// SPDX-License-Identifier: Apache-2.0
#include "probe_merge_options.h"

#include "base/error.h"
#include "front/arguments.h"

namespace chromeball {
namespace {

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

}  // namespace

void MergeArguments::addTo(Command command) {
  command.addOption("PHOTOGRAPHS", files,
                    "photographs of one view, of one size: JPEG, PNG, TIFF, .exr, .hdr or .pfm");
  command.addOption("-o,--output", output,
                    "the image to write: .exr (with the layer `clipped`), .hdr or .pfm");
  command.addOption("--exposures", exposures,
                    "exposure times in seconds, one for each photograph, as in 1/10,1/40; in place "
                    "of EXIF's time, aperture and ISO");
  command.addOption("--apertures", apertures,
                    "f-numbers, one for each photograph, in place of EXIF's");
  command
      .addOption("--aperture-ratio", ratios,
                 "A:B=X: f/A lets X times as much light pass as f/B, measured; else (B/A)^2")
      .onePerName();
  command
      .addOption("--filter", filters,
                 "K=R,G,B: the K-th photograph was taken through a filter of this transmission")
      .onePerName();
  command
      .addOption("--flat-field", flatFields,
                 "F.exr, or N=F.exr for the photographs at f/N: divide by it (`image flat-field`)")
      .onePerName();
  command.addOption(
      "--response", response,
      "linear, srgb, solve or a file of --write-response; without it srgb for 8 bits, else linear");
  command.addOption("--write-response", responseOutput,
                    "the response as text: 256 levels and their exposures");
  command.addOption(
      "--smoothness", smoothness,
      fmt::format("of the solved response, default {:g}", PhotographSeries{}.smoothness));
  command.addOption("--white", white,
                    "where floats saturate; without it 1, or the largest number if that is higher. "
                    "The result has the scale of the files");
  command.addFlag("--resize", resizes,
                  "accept photographs of several sizes, each cropped to the same ball: resample "
                  "them to the smallest");
  command.addFlag("--unaligned", unaligned, "accept photographs that seem shifted");
  command
      .addOption("--calibrate-filter", calibration,
                 "WITH WITHOUT: instead, print the transmission of a filter from two merged images "
                 "(.exr, which keeps the photographs' primaries)")
      .words(2);
  command.addFlag("--json", json, "print JSON");
}

void MergeArguments::checkCalibration() const {
  if (!files.empty() || !output.empty())
    throwInput("--calibrate-filter: prints a transmission; give no photographs and no -o");
  const std::pair<const char*, bool> others[] = {{"--exposures", !exposures.empty()},
                                                 {"--apertures", !apertures.empty()},
                                                 {"--aperture-ratio", !ratios.empty()},
                                                 {"--filter", !filters.empty()},
                                                 {"--flat-field", !flatFields.empty()},
                                                 {"--response", !response.empty()},
                                                 {"--write-response", !responseOutput.empty()},
                                                 {"--smoothness", !smoothness.empty()},
                                                 {"--white", !white.empty()},
                                                 {"--resize", resizes},
                                                 {"--unaligned", unaligned}};
  for (const auto& [option, isGiven] : others)
    if (isGiven) throwInput("{}: has no effect with --calibrate-filter; leave it out", option);
}

PhotographSeries MergeArguments::series() const {
  PhotographSeries series;
  series.files = files;
  series.times = parsePositives(exposures, "--exposures");
  series.apertures = parsePositives(apertures, "--apertures");
  for (const std::string& text : ratios) series.apertureRatios.push_back(parseRatio(text));
  for (const std::string& text : filters) series.filters.push_back(parseFilter(text, files.size()));
  for (const std::string& text : flatFields) series.flatFields.push_back(parseFlatField(text));
  series.response = response;
  if (!smoothness.empty() && response != "solve")
    throwInput("--smoothness: has no effect without --response solve; leave it out");
  if (!smoothness.empty()) series.smoothness = parsePositive(smoothness, "--smoothness");
  constexpr double kSmoothest = 1e6;  // more leaves a straight line, and rounding errors
  if (!(series.smoothness <= kSmoothest))
    throwInput("--smoothness: `{}` should be at most {:g}", smoothness, kSmoothest);
  if (!white.empty()) series.white = float(parsePositive(white, "--white"));
  series.checkAlignment = !unaligned;
  series.resizes = resizes;
  return series;
}

}  // namespace chromeball
