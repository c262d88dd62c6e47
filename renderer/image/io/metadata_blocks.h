// SPDX-License-Identifier: Apache-2.0
// Where JPEG and PNG files keep metadata, which their readers skip.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace chromeball {

// Comes before the EXIF block in its segment of a JPEG.
inline constexpr std::string_view kExifName("Exif\0\0", 6);

// The EXIF block (exif.h), a part of `file`; empty if there is none.
std::span<const uint8_t> jpegExif(std::span<const uint8_t> file);
std::span<const uint8_t> pngExif(std::span<const uint8_t> file);

// The ICC profile. nullopt if there is none, empty if a PNG's cannot be inflated to a megabyte.
std::optional<std::vector<uint8_t>> jpegProfile(std::span<const uint8_t> file);
std::optional<std::vector<uint8_t>> pngProfile(std::span<const uint8_t> file);

// A JPEG's JFIF header, after its name (JFIF 1.02); empty if there is none.
std::span<const uint8_t> jpegJfif(std::span<const uint8_t> file);

// The data of the first chunk of this type, such as "gAMA"; empty if there is none.
std::span<const uint8_t> pngChunk(std::span<const uint8_t> file, std::string_view type);

// The width of a pixel over its height, from the resolutions of a TIFF's first image (TIFF 6.0,
// XResolution), a JPEG's JFIF header or a PNG's pHYs. 1 if the file states none, or if they differ
// by less than a percent, as through rounding. Refers to the image as it is to be seen (EXIF
// orientation).
double pixelAspectRatio(std::span<const uint8_t> file);

}  // namespace chromeball
