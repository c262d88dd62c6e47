// SPDX-License-Identifier: Apache-2.0
// Reads image files: EXR, Radiance .hdr, PFM, PNG, JPEG, TIFF. The first bytes of a file decide its
// format, not its name. Functions that take a path throw InputError ("FILE: reason").
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "image/image.h"

namespace chromeball {

// A transform of row vectors, as in OpenEXR: row by row, with the translation in the last row.
using Matrix44 = std::array<float, 16>;
using Metadata = std::map<std::string, std::variant<std::string, int, float, Matrix44>>;

// OpenEXR's attribute of probes in Metadata, and its values (ImfEnvmap.h).
inline constexpr const char* kEnvmapAttribute = "envmap";
inline constexpr const char* kEnvmapLatLong = "latlong";
inline constexpr const char* kEnvmapCube = "cube";

// The encoding of integer files (8 or 16 bits). Float files are always linear.
enum class IntegerTexels { Srgb, Linear };  // Srgb: decoded to linear, except alpha

// The position of an image's first pixel in a larger image, and the size of that.
struct Placement {
  int x, y, width, height;
};

// All contents of a file: its channels, interleaved in `image` in the file's order. Colour is
// associated with alpha (premultiplied, in linear light), however the file stores it.
struct ImageFile {
  Image image;
  std::vector<std::string> channels;
  Metadata metadata;
  std::optional<Placement> placement;  // of an .exr whose pixels are part of its display window
  bool integers = false;               // the file has integers per channel, so no texel is above 1
  int bits = 0;                        // of these, 8 or 16
};

// The attributes alone, of an .exr.
Metadata readExrMetadata(const std::filesystem::path& path);

ImageFile readImageFile(const std::filesystem::path& path,
                        IntegerTexels integers = IntegerTexels::Srgb);

// The colour, always three channels: the channels R, G and B; else those of the first layer that
// has them; else grey repeated (Y, or the first of one or two channels). nullopt if there is none
// of these.
std::optional<Image> findColor(const ImageFile& file);

// The same, with alpha as a fourth channel if the file has R, G, B and A.
std::optional<Image> findColorAndAlpha(const ImageFile& file);

// The channels NAME.R NAME.G NAME.B or NAME.X NAME.Y NAME.Z (three channels), else NAME or the
// first channel of the layer NAME (one channel); "alpha" also finds channel A. nullopt if the file
// has no such layer.
std::optional<Image> findLayer(const ImageFile& file, const std::string& name);

// The names of the layers that findLayer() finds.
std::vector<std::string> layerNames(const ImageFile& file);

// The colour of a file read from `path`. Throws InputError if findColor() finds none.
Image colorOf(ImageFile&& file, const std::filesystem::path& path);
Image readImage(const std::filesystem::path& path, IntegerTexels integers = IntegerTexels::Srgb);

}  // namespace chromeball
