// SPDX-License-Identifier: Apache-2.0
// What JPEG, PNG and TIFF files state besides their texels: how a photograph was taken, by its EXIF
// block (CIPA DC-008, section 4.6.5: a TIFF directory with a pointer to another one); profiles;
// resolutions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace chromeball {

// Values are above 0 and finite; nullopt if the file does not state them.
struct Exif {
  std::optional<double> exposureTime;  // seconds
  std::optional<double> aperture;      // f-number
  std::optional<double> iso;
  std::optional<double> focalLength35;  // mm, of the same diagonal field of view on 35 mm film
};

// Reads the EXIF of a JPEG, PNG or TIFF, or the attributes expTime, aperture and isoSpeed of an
// .exr (ImfStandardAttributes.h). Empty for other files and for damaged blocks. Throws InputError
// if the file cannot be read.
Exif readExif(const std::filesystem::path& path);

// How the image of a JPEG, PNG or TIFF is stored (image.h), 1 to 8; 1 if the file does not state
// it.
int exifOrientation(std::span<const uint8_t> file);

// Whether the EXIF of a JPEG, PNG or TIFF states a colour space other than sRGB: cameras that are
// set to Adobe RGB do, often without a profile.
bool exifStatesOtherColors(std::span<const uint8_t> file);

// The ICC profile. nullopt if there is none, empty if a PNG's cannot be inflated to a megabyte.
std::optional<std::vector<uint8_t>> jpegProfile(std::span<const uint8_t> file);
std::optional<std::vector<uint8_t>> pngProfile(std::span<const uint8_t> file);

// The data of the first chunk of this type, such as "gAMA"; empty if there is none.
std::span<const uint8_t> pngChunk(std::span<const uint8_t> file, std::string_view type);

// The width of a pixel over its height, from the resolutions of a TIFF's first image (TIFF 6.0,
// XResolution), a JPEG's JFIF header or a PNG's pHYs. 1 if the file states none, or if they differ
// by less than a percent, as through rounding. Refers to the image as it is to be seen (EXIF
// orientation).
double pixelAspectRatio(std::span<const uint8_t> file);

}  // namespace chromeball
