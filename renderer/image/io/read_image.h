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

#include "base/message.h"
#include "image/chromaticities.h"
#include "image/image.h"

namespace chromeball {

// A transform of row vectors, as in OpenEXR: row by row, with the translation in the last row.
using Matrix44 = std::array<float, 16>;
using Metadata = std::map<std::string, std::variant<std::string, int, float, double, Matrix44>>;

// The number with this name, whatever its type; nullopt if there is none, or a text or a matrix.
std::optional<double> metadataNumber(const Metadata& metadata, const std::string& name);

// The name of a probe's mapping in Metadata: an attribute of .exr, a comment of .hdr.
inline constexpr const char* kMappingAttribute = "mapping";

// OpenEXR's attribute of probes in Metadata, and its values (ImfEnvmap.h).
inline constexpr const char* kEnvmapAttribute = "envmap";
inline constexpr const char* kEnvmapLatLong = "latlong";
inline constexpr const char* kEnvmapCube = "cube";

// The encoding of integer files (8 or 16 bits). Float files are always linear.
enum class IntegerTexels {
  Srgb,    // decoded to linear as the file says, else from sRGB; except alpha
  Linear,  // as stored: a mask, no light
  Levels,  // as stored: a photograph; refuses what Srgb refuses
};

// The encoding that a file of integers states; Other: neither of the two.
enum class Transfer { Srgb, Linear, Other };

// The position of an image's first pixel in another image, and that image's size, which need not
// contain the image.
struct Placement {
  int x, y, width, height;
  bool operator==(const Placement&) const = default;
};

// All contents of a file: its channels, interleaved in `image` in the file's order. Colour is
// associated with alpha (premultiplied, in linear light), however the file stores it. The image is
// turned as its EXIF orientation says. From an .exr with several parts, the part that has the
// colour (color_channels.h) is read.
struct ImageFile {
  Image image;
  std::vector<std::string> channels;
  Metadata metadata;
  std::optional<Placement> placement = {};  // in the display window of an .exr, if it differs
  bool integers = false;  // the file has integers per channel, so no texel is above 1
  int bits = 0;           // of the integers, 8 or 16
  std::string part = {};  // the name of the part that was read, of an .exr with several
  std::optional<Chromaticities> primaries = {};  // of the colour, if these are not Rec. 709's
  std::optional<Transfer> transfer = {};         // of Levels, if the file states one
  Messages messages = {};  // choices, and contents not understood; each "FILE: ..."
};

// How the light of a file of integers was read: "decoded from sRGB", for example.
const char* decodingInWords(const ImageFile& file);

// A warning of a photograph whose brightest light is lost: integers, clipped at white, or pixels
// that are marked in the layer `clipped` of merged photographs.
Messages clippedLight(const ImageFile& file, const std::filesystem::path& path);

// Only the attributes of an .exr.
Metadata readExrMetadata(const std::filesystem::path& path);

ImageFile readImageFile(const std::filesystem::path& path,
                        IntegerTexels integers = IntegerTexels::Srgb);

// The colour in linear Rec. 709, always three channels: those that findColorChannels() finds
// (color_channels.h); grey is repeated. nullopt if there are none.
std::optional<Image> findColor(const ImageFile& file);

// The same, with alpha as a fourth channel if the file has R, G, B and A.
std::optional<Image> findColorAndAlpha(const ImageFile& file);

// The channels NAME.R NAME.G NAME.B or NAME.X NAME.Y NAME.Z (three channels), else NAME or the
// first channel of the layer NAME (one channel); "alpha" also finds channel A. R, G and B of a
// layer of colour (isColorLayer() in color_channels.h) are converted to linear Rec. 709. nullopt if
// the file has no such layer.
std::optional<Image> findLayer(const ImageFile& file, const std::string& name);

// The names of the layers that findLayer() finds.
std::vector<std::string> layerNames(const ImageFile& file);

// The colour of a file read from `path`, as findColor(), in its display window: black where the
// file has no data. Throws InputError if there is none.
Image colorOf(ImageFile&& file, const std::filesystem::path& path);
Image readImage(const std::filesystem::path& path, IntegerTexels integers = IntegerTexels::Srgb,
                Messages* messages = nullptr);  // gets the file's

// The same as colorOf(), but not converted: the channels of a sensor, for example.
struct StoredColor {
  Image image;
  std::optional<Chromaticities> primaries;  // nullopt: Rec. 709's, or grey
};
StoredColor storedColorOf(ImageFile&& file, const std::filesystem::path& path);

// The same as colorOf(), with alpha as a fourth channel if the file has R, G, B and A.
Image colorAndAlphaOf(ImageFile&& file, const std::filesystem::path& path);

// The same as colorOf(), for a file that is no light: its only channel counts whatever its name.
Image maskOf(ImageFile&& file, const std::filesystem::path& path);

// The same as findLayer(), in the display window of the file, which was read from `path`.
std::optional<Image> layerOf(const ImageFile& file, const std::string& name,
                             const std::filesystem::path& path);

// The same as colorOf(), without the display window: only the texels that the file has.
Image colorOfData(ImageFile&& file, const std::filesystem::path& path);
Image colorAndAlphaOfData(ImageFile&& file, const std::filesystem::path& path);

// Texels of the file at `path` in its display window: the data in its place, 0 around it, the rest
// cropped. Throws InputError if the window exceeds the limits, or has no data.
Image inDisplayWindow(Image data, const std::optional<Placement>& placement,
                      const std::filesystem::path& path);

}  // namespace chromeball
