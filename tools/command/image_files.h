// SPDX-License-Identifier: Apache-2.0
// Reads the images of a command, and prints their readers' messages: channels chosen, fields of the
// header applied, colours converted. Writes the map that a command about probes makes.
#pragma once

#include <string>
#include <string_view>

#include "image/image.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "probe/load.h"
#include "probe/mapping.h"

namespace chromeball {

// The same as readImageFile(), readImage() and loadProbe().
ImageFile openImageFile(const std::filesystem::path& path,
                        IntegerTexels integers = IntegerTexels::Srgb);
Image openImage(const std::filesystem::path& path, IntegerTexels integers = IntegerTexels::Srgb);
// The metadata of an image file, `in`, for the image `out` that is made of it: without `envmap`,
// which says how a map is turned and which no image of ours has. Warns if that turns the map in
// `out`.
Metadata keptMetadata(Metadata metadata, const std::string& in, const std::string& out);

// The same as writeImage(), for an image made from the data of the file `in`, with keptMetadata():
// all formats but .exr get its display window (inDisplayWindow(), read_image.h). A mapping that is
// none of parseMapping() for this size stays in an .exr alone. Warns of a mapping that a .pfm
// loses.
void writeKept(const std::string& out, OutputImage output, const std::string& in,
               const DisplayTransform& transform = {});

// Warns of channels above 1 if the file to write is a .png.
void warnOfClipping(const std::string& file, const Image& image);

LoadedProbe openProbe(const std::string& path, std::string_view mapping, std::string_view option);

// Returns the size of a map to make for `file`. Throws InputError if it exceeds the limit of an
// image, or if `copies` of it, including those for writing, take more memory than the process may
// use.
ImageSize checkedSize(const std::string& file, const ImageSize& size, double copies = 3);

// Copies of a map of irradiance: the direction and the horizon of each texel are kept.
inline constexpr double kIrradianceCopies = 8;

// The same as writeImage(); an .exr or .hdr stores the name of its mapping, which loadProbe()
// reads. Warns of a mapping that other files lose, of channels above 1 that a .png clips, and of
// channels below 0 that become 0 in a .png and an .hdr.
void writeProbe(const std::string& file, const Image& map, Mapping mapping = Mapping::LatLong);

}  // namespace chromeball
