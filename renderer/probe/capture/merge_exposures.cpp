// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/merge_exposures.h"

#include <mutex>

#include "base/error.h"
#include "base/parallel.h"
#include "image/io/exif.h"
#include "image/tonemap.h"

namespace chromeball {
namespace {

struct Channel {
  enum class State { Measured, Clipped, Underexposed } state = State::Measured;
  double radiance = 0;
};

using Exposures = std::span<const Exposure>;

double logRadiance(const Exposure& exposure, const ResponseCurve& response, int x, int y,
                   int channel, float level) {
  const double flat = exposure.flatField ? exposure.flatField->at(x, y)[channel] : 1;
  return response.logExposure(channel, level) - std::log(exposure.factor[channel] * flat);
}

// The highest bound is the shortest exposure's.
Channel boundOf(Exposures exposures, const ResponseCurve& response, int x, int y, int channel) {
  Channel bound{Channel::State::Underexposed, 0};
  for (const Exposure& exposure : exposures)
    if (exposure.levels.at(x, y)[channel] >= kSaturated)
      bound = {Channel::State::Clipped,
               std::max(bound.radiance,
                        std::exp(logRadiance(exposure, response, x, y, channel, kSaturated)))};
  return bound;
}

Channel mergedAt(Exposures exposures, const ResponseCurve& response, int x, int y, int channel) {
  double sum = 0, weights = 0;
  for (const Exposure& exposure : exposures) {
    const float level = exposure.levels.at(x, y)[channel], weight = hatWeight(level);
    if (weight == 0) continue;
    sum += weight * logRadiance(exposure, response, x, y, channel, level);
    weights += weight;
  }
  if (weights > 0) return {Channel::State::Measured, std::exp(sum / weights)};
  return boundOf(exposures, response, x, y, channel);
}

// Adds the counts of one row.
void count(Exposures exposures, int y, std::vector<MergedExposures::Use>& uses) {
  for (size_t i = 0; i < exposures.size(); ++i)
    for (int x = 0; x < exposures[i].levels.width; ++x) {
      const Rgb levels = exposures[i].levels.rgb(x, y);
      uses[i].saturated += maxComponent(levels) >= kSaturated;
      uses[i].weighted += hatWeight(levels.x) + hatWeight(levels.y) + hatWeight(levels.z) > 0;
    }
}

std::string kindOf(int bits) {
  return bits > 0 ? fmt::format("integers of {} bits", bits) : std::string("floats");
}

float largestTexel(const std::vector<Image>& images) {
  float largest = 0;
  for (const Image& image : images)
    for (const float texel : image.texels)
      if (std::isfinite(texel)) largest = std::max(largest, texel);
  return largest;
}

// Levels of the means of linear light. A pixel that covers a saturated one is saturated: the light
// of that is unknown.
Image levelsOfMeans(const Image& levels, int width, int height, bool isSrgb) {
  Image light = levels, saturated = levels;
  for (size_t i = 0; i < levels.texels.size(); ++i) {
    if (isSrgb) light.texels[i] = srgbToLinear(levels.texels[i]);
    saturated.texels[i] = levels.texels[i] >= kSaturated;
  }
  light = resampled(light, width, height);
  saturated = resampled(saturated, width, height);
  for (size_t i = 0; i < light.texels.size(); ++i) {
    if (isSrgb) light.texels[i] = linearToSrgb(light.texels[i]);
    if (saturated.texels[i] > 0) light.texels[i] = 1;
  }
  return light;
}

void toSmallestSize(PhotographLevels& photographs) {
  std::vector<Image>& images = photographs.levels;
  int width = images.front().width, height = images.front().height;
  for (const Image& image : images)
    width = std::min(width, image.width), height = std::min(height, image.height);
  for (Image& image : images)
    if (image.width != width || image.height != height)
      image = levelsOfMeans(image, width, height, photographs.isSrgb());
}

void checkCount(const std::vector<double>& numbers, size_t files, const char* option) {
  if (!numbers.empty() && numbers.size() != files)
    throwInput("{}: has {} numbers for {} photographs; give one for each", option, numbers.size(),
               files);
}

// A property that one photograph states and another does not makes their ratio unknown.
void checkAllOrNone(const std::vector<std::string>& files,
                    const std::vector<CameraSettings>& settings,
                    std::optional<double> CameraSettings::*member, const char* name) {
  for (size_t i = 1; i < files.size(); ++i)
    if ((settings[i].*member).has_value() != (settings[0].*member).has_value()) {
      const bool first = (settings[0].*member).has_value();
      throwInput("{}: has no {} in its EXIF block, but {} has one; give the exposures",
                 files[first ? i : 0], name, files[first ? 0 : i]);
    }
}

}  // namespace

MergedExposures mergeExposures(std::span<const Exposure> exposures, const ResponseCurve& response) {
  const int width = exposures.front().levels.width, height = exposures.front().levels.height;
  MergedExposures merged{.radiance = Image(width, height, 3),
                         .clipped = Image(width, height, 1),
                         .uses = std::vector<MergedExposures::Use>(exposures.size())};
  std::mutex mutex;  // of the counts
  forRows(width, height, [&](int y) {
    size_t clipped = 0, underexposed = 0;
    for (int x = 0; x < width; ++x) {
      bool isClipped = false, isUnderexposed = false;
      for (int c = 0; c < 3; ++c) {
        const Channel channel = mergedAt(exposures, response, x, y, c);
        merged.radiance.at(x, y)[c] = float(channel.radiance);
        isClipped |= channel.state == Channel::State::Clipped;
        isUnderexposed |= channel.state == Channel::State::Underexposed;
      }
      *merged.clipped.at(x, y) = isClipped ? 1 : 0;
      clipped += isClipped;
      underexposed += isUnderexposed;
    }
    const std::lock_guard lock(mutex);
    merged.clippedPixels += clipped;
    merged.underexposedPixels += underexposed;
    count(exposures, y, merged.uses);
  });
  return merged;
}

PhotographLevels readLevels(const std::vector<std::string>& files, std::optional<float> white,
                            bool resizes) {
  PhotographLevels result;
  for (const std::string& file : files) {
    ImageFile read = readImageFile(file, IntegerTexels::Levels);
    const int bits = read.bits;
    const std::optional<Transfer> transfer = read.transfer;
    Metadata metadata = std::move(read.metadata);
    result.messages.insert(result.messages.end(), read.messages.begin(), read.messages.end());
    auto [image, primaries] = storedColorOf(std::move(read), file);
    if (result.levels.empty()) {
      result.metadata = std::move(metadata);
      result.bits = bits;
      result.primaries = primaries;
      result.transfer = transfer;
    } else {
      const Image& first = result.levels.front();
      if (!resizes && (image.width != first.width || image.height != first.height))
        throw InputError(
            fmt::format("{}: is {} x {}, but {} is {} x {}; photographs of a series have one size, "
                        "or, for crops of a ball, are resized",
                        file, image.width, image.height, files.front(), first.width, first.height),
            Remedy{"resize", {}});
      if (bits != result.bits)
        throwInput("{}: has {}, but {} has {}; photographs of a series are of one kind", file,
                   kindOf(bits), files.front(), kindOf(result.bits));
      if (primaries != result.primaries)
        throwInput("{}: its primaries are not those of {}; photographs of a series have the same",
                   file, files.front());
      if (transfer != result.transfer)
        throwInput(
            "{}: the encoding of its levels that it states (gAMA, sRGB, cICP) is not that of {}; "
            "photographs of a series have the same",
            file, files.front());
    }
    result.levels.push_back(std::move(image));
  }
  for (Image& image : result.levels) {
    size_t& invalid = result.invalid.emplace_back(0);
    for (float& texel : image.texels)
      if (!(texel >= 0)) ++invalid, texel = 0;
  }
  if (result.bits > 0 && white)
    throwInput("white: {} has {}, which are white at 1; it is for floats, leave it out",
               files.front(), kindOf(result.bits));
  if (result.bits == 0) result.white = white.value_or(std::max(1.0f, largestTexel(result.levels)));
  for (Image& image : result.levels)
    forRanges(image.texels.size(), [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) image.texels[i] /= result.white;
    });
  if (resizes) toSmallestSize(result);
  return result;
}

std::vector<CameraSettings> cameraSettings(const std::vector<std::string>& files,
                                           const std::vector<double>& times,
                                           const std::vector<double>& apertures) {
  checkCount(times, files.size(), "exposures");
  checkCount(apertures, files.size(), "apertures");
  std::vector<CameraSettings> all;
  for (size_t i = 0; i < files.size(); ++i) {
    CameraSettings settings;
    if (times.empty()) {
      const Exif exif = readExif(files[i]);
      if (!exif.exposureTime)
        throwInput("{}: has no exposure time in an EXIF block; give the exposures", files[i]);
      settings = {*exif.exposureTime, exif.aperture, exif.iso};
    } else {
      settings.time = times[i];
    }
    if (!apertures.empty()) settings.aperture = apertures[i];
    all.push_back(settings);
  }
  checkAllOrNone(files, all, &CameraSettings::aperture, "aperture");
  checkAllOrNone(files, all, &CameraSettings::iso, "ISO");
  return all;
}

}  // namespace chromeball
