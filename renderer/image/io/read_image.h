// SPDX-License-Identifier: Apache-2.0
// Reading images: EXR, Radiance .hdr, PFM, PNG, JPEG, TIFF. A file is known by its first bytes, not
// by its name. All of these throw InputError ("FILE: reason").
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

// For row vectors, as OpenEXR's: row after row, the translation in the last.
using Matrix44 = std::array<float, 16>;
using Metadata = std::map<std::string, std::variant<std::string, int, float, Matrix44>>;

// What the texels of integer files (8 or 16 bits) mean. Float files are linear whatever is asked.
enum class IntegerTexels { Srgb, Linear };  // Srgb: decoded to linear; alpha never is

// Everything in a file: all channels, interleaved in `image`, in the file's order. Colour is
// associated with alpha (premultiplied, in linear light), whichever way the file states it.
struct ImageFile {
  Image image;
  std::vector<std::string> channels;
  Metadata metadata;
  bool integers = false;  // texels of 8 or 16 bits: nothing is brighter than 1
};

ImageFile readImageFile(const std::filesystem::path& path,
                        IntegerTexels integers = IntegerTexels::Srgb);

// The colour, always three channels: R, G and B by name, else of the first layer that has them,
// else grey (Y, or the first of one or two channels) repeated. nullopt where there is none of
// these.
std::optional<Image> findColor(const ImageFile& file);

// The same, with alpha as a fourth channel where the file has R, G, B and A.
std::optional<Image> findColorAndAlpha(const ImageFile& file);

// The channels NAME.R NAME.G NAME.B or NAME.X NAME.Y NAME.Z (three channels), else NAME or the
// first of NAME's channels (one channel); "alpha" is also the colour's A. nullopt where the file
// has no such layer.
std::optional<Image> findLayer(const ImageFile& file, const std::string& name);

// The names findLayer knows.
std::vector<std::string> layerNames(const ImageFile& file);

// The colour of the file at `path`; throws where findColor() finds none.
Image colorOf(ImageFile&& file, const std::filesystem::path& path);
Image readImage(const std::filesystem::path& path, IntegerTexels integers = IntegerTexels::Srgb);

}  // namespace chromeball
