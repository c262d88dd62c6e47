// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/merge_photographs.h"

#include <array>
#include <map>

#include "base/error.h"
#include "image/io/read_image.h"
#include "math/cdf.h"
#include "probe/capture/align.h"

namespace chromeball {
namespace {

std::vector<dvec3> factorsOf(const PhotographSeries& series,
                             const std::vector<CameraSettings>& settings) {
  constexpr double kLargest = 1e15;
  std::vector<dvec3> factors;
  for (const double factor : exposureFactors(settings, series.apertureRatios))
    factors.emplace_back(factor);
  for (const auto& filter : series.filters) factors[filter.photograph] *= filter.transmission;
  for (size_t i = 0; i < factors.size(); ++i)
    for (int c = 0; c < 3; ++c)
      if (!(factors[i][c] >= 1 / kLargest && factors[i][c] <= kLargest))
        throwInput("{}: its exposure factor {:g} should be {:g} to {:g}", series.files[i],
                   factors[i][c], 1 / kLargest, kLargest);
  return factors;
}

// Whatever differs in only one channel is a filter, and worth a merge.
void checkFactorsDiffer(const PhotographSeries& series, const std::vector<dvec3>& factors) {
  constexpr double kSame = 0.01;
  const auto isFirst = [&](const dvec3& factor) {
    return glm::all(glm::lessThan(glm::abs(factor / factors.front() - 1.0), dvec3(kSame)));
  };
  if (factors.size() > 1 && std::ranges::all_of(factors, isFirst))
    throwInput(
        "{}: has the same exposure as all others; give different ones, or state the exposures",
        series.files.back());
}

glm::dmat3 toRec709(const std::optional<Chromaticities>& primaries) {
  return primaries ? toRec709(*primaries).value() : glm::dmat3(1);
}

// The flat fields, each read once, and the one that each photograph is divided by.
class FlatFields {
 public:
  FlatFields(const PhotographSeries& series, const std::vector<CameraSettings>& settings,
             const PhotographLevels& photographs)
      : ofPhotograph_(settings.size(), nullptr) {
    for (const auto& [aperture, file] : series.flatFields) {
      if (!images_.contains(file)) images_[file] = read(file, series, photographs);
      const Image& image = images_[file];
      bool isUsed = false;
      for (size_t i = 0; i < settings.size(); ++i) {
        const auto& own = settings[i].aperture;
        if (aperture && !(own && isSameAperture(*own, *aperture))) continue;
        if (ofPhotograph_[i])
          throwInput("flat field: {} has more than one flat field", series.files[i]);
        ofPhotograph_[i] = &image;
        isUsed = true;
      }
      if (!isUsed)
        throwInput("flat field {}: no photograph was taken at f/{:g}", file, aperture.value_or(0));
    }
  }

  const Image* of(size_t photograph) const { return ofPhotograph_[photograph]; }
  const Messages& messages() const { return messages_; }  // of the readers

 private:
  Image read(const std::string& file, const PhotographSeries& series,
             const PhotographLevels& photographs) {
    ImageFile contents = readImageFile(file);
    messages_.insert(messages_.end(), contents.messages.begin(), contents.messages.end());
    auto [image, primaries] = storedColorOf(std::move(contents), file);
    if (primaries != photographs.primaries)
      convertColor(image, glm::inverse(toRec709(photographs.primaries)) * toRec709(primaries));
    const Image& photograph = photographs.levels.front();
    if (image.width != photograph.width || image.height != photograph.height)
      throwInput("{}: is {} x {}, but {} is {} x {}; a flat field has the photographs' size", file,
                 image.width, image.height, series.files.front(), photograph.width,
                 photograph.height);
    for (const float channel : image.texels)
      if (!(channel > 0) || !std::isfinite(channel))
        throwInput("{}: a flat field should be above 0 everywhere, and finite", file);
    return image;
  }

  std::map<std::string, Image> images_;
  std::vector<const Image*> ofPhotograph_;
  Messages messages_;
};

// Compares each exposure with the next longer one.
void checkShifts(std::span<const Exposure> exposures) {
  std::vector<const Exposure*> order;
  for (const Exposure& exposure : exposures) order.push_back(&exposure);
  std::ranges::stable_sort(order, std::greater{}, [](const Exposure* e) { return e->factor.y; });
  for (size_t i = 0; i + 1 < order.size(); ++i) {
    const Shift shift = findShift(order[i]->levels, order[i + 1]->levels);
    if (shift.isCertain())
      throw InputError(fmt::format("{}: seems shifted by {},{} pixels against {}; align the "
                                   "photographs first, or take them as they are",
                                   order[i + 1]->name, shift.dx, shift.dy, order[i]->name),
                       Remedy{"unaligned", {}});
  }
}

// The files' own response, if they state one.
std::string defaultResponse(const PhotographSeries& series, const PhotographLevels& photographs) {
  if (photographs.transfer == Transfer::Other)
    throwInput(
        "{}: states that its levels are neither linear nor encoded as sRGB (gAMA, cICP); give the "
        "response",
        series.files.front());
  return photographs.isSrgb() ? "srgb" : "linear";
}

ResponseCurve responseOf(const PhotographSeries& series, const PhotographLevels& photographs,
                         std::span<const Exposure> exposures, std::string& name) {
  name = series.response;
  if (name.empty()) name = defaultResponse(series, photographs);
  if (name == "linear") return ResponseCurve::linear();
  if (name == "srgb") return ResponseCurve::srgb();
  if (name != "solve" && !std::filesystem::exists(name))
    throwInput("response: `{}` is neither linear, srgb or solve nor a file", name);
  if (name != "solve") return ResponseCurve::read(name);
  if (photographs.bits != 8)
    throwInput("response solve: {} has no 8-bit levels; a response is solved from these",
               series.files.front());
  return solveResponse(exposures, series.smoothness);
}

void addWarnings(const PhotographSeries& series, MergedPhotographs& merged) {
  constexpr double kTolerance = 0.03;
  const auto warn = [&](std::string text) {
    merged.messages.push_back({Message::Kind::Warning, std::move(text)});
  };
  for (const ExposureAgreement& agreement : merged.agreements) {
    const std::string &longer = series.files[agreement.longer],
                      &shorter = series.files[agreement.shorter];
    const auto error = agreement.error();
    if (!error)
      warn(fmt::format("{} and {} show too few pixels both well to compare their exposures", longer,
                       shorter));
    else if (*error > kTolerance)
      warn(fmt::format("{} and {} disagree by {:.1f}%: wrong exposures, or another response",
                       longer, shorter, 100 * *error));
  }
  for (size_t i = 0; i < series.files.size(); ++i)
    if (merged.image.uses[i].weighted == 0)
      warn(fmt::format("{}: is not used: all of its pixels are saturated or black",
                       series.files[i]));
}

}  // namespace

MergedPhotographs mergePhotographs(const PhotographSeries& series) {
  MergedPhotographs merged;
  merged.settings = cameraSettings(series.files, series.times, series.apertures);
  merged.factors = factorsOf(series, merged.settings);
  checkFactorsDiffer(series, merged.factors);
  PhotographLevels photographs = readLevels(series.files, series.white, series.resizes);
  merged.white = photographs.white;
  merged.metadata = std::move(photographs.metadata);
  const FlatFields flatFields(series, merged.settings, photographs);
  merged.messages = std::move(photographs.messages);
  merged.messages.insert(merged.messages.end(), flatFields.messages().begin(),
                         flatFields.messages().end());
  std::vector<Exposure> exposures;
  for (size_t i = 0; i < series.files.size(); ++i)
    exposures.push_back(
        {series.files[i], std::move(photographs.levels[i]), merged.factors[i], flatFields.of(i)});
  if (series.checkAlignment) checkShifts(exposures);
  merged.response = responseOf(series, photographs, exposures, merged.responseName);
  merged.image = mergeExposures(exposures, merged.response);
  for (float& texel : merged.image.radiance.texels) texel *= merged.white;  // the files' scale
  // Comes last: exposure, saturation and black refer to the files' channels.
  merged.toRec709 = toRec709(photographs.primaries);
  if (photographs.primaries) convertColor(merged.image.radiance, merged.toRec709);
  merged.agreements = exposureAgreement(exposures, merged.response);

  const size_t pixels = merged.image.clipped.texels.size();
  if (merged.image.clippedPixels == pixels)
    throwInput("{}: all pixels are saturated in all exposures; add shorter ones",
               series.files.front());
  if (merged.image.underexposedPixels == pixels)
    throwInput("{}: all pixels are black in all exposures; add longer ones", series.files.front());
  addWarnings(series, merged);
  for (size_t i = 0; i < series.files.size(); ++i)
    if (photographs.invalid[i] > 0)
      addWarning(merged.messages, "{}: {} channels are NaN or negative; they count as black",
                 series.files[i], photographs.invalid[i]);
  return merged;
}

FilterTransmission filterTransmission(const Image& with, const Image* clippedWith,
                                      const Image& without, const Image* clippedWithout) {
  const auto isMeasured = [](const Image& image, const Image* clipped, int x, int y) {
    const Rgb c = image.rgb(x, y);
    return c.x > 0 && c.y > 0 && c.z > 0 && isFinite(c) && !(clipped && *clipped->at(x, y) != 0);
  };
  dvec3 sumWith(0), sumWithout(0);
  std::array<std::vector<double>, 3> ratios;
  for (int y = 0; y < with.height; ++y)
    for (int x = 0; x < with.width; ++x) {
      if (!isMeasured(with, clippedWith, x, y) || !isMeasured(without, clippedWithout, x, y))
        continue;
      const dvec3 a(with.rgb(x, y)), b(without.rgb(x, y));
      sumWith += a, sumWithout += b;
      for (int c = 0; c < 3; ++c) ratios[size_t(c)].push_back(a[c] / b[c]);
    }
  FilterTransmission result{sumWith / sumWithout, dvec3(0), ratios[0].size()};
  if (result.pixels == 0) throwInput("no pixel is above 0 and not clipped in both images");
  for (int c = 0; c < 3; ++c) result.median[c] = median(std::move(ratios[size_t(c)]));
  return result;
}

}  // namespace chromeball
