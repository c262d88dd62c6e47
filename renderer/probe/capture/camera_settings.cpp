// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/camera_settings.h"

#include "base/error.h"
#include "image/io/exif.h"

namespace chromeball {
namespace {

void checkCount(const std::vector<double>& numbers, size_t files, const char* option) {
  if (!numbers.empty() && numbers.size() != files)
    throwInput("{}: has {} numbers for {} photographs; give one for each", option, numbers.size(),
               files);
}

// What one photograph states and another does not makes their ratio unknown.
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
