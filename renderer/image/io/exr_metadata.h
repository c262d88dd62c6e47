// SPDX-License-Identifier: Apache-2.0
// The attributes of an OpenEXR header that are metadata.
#pragma once

#include <OpenEXR/ImfForward.h>

#include <filesystem>

#include "image/io/read_image.h"
#include "image/size_limits.h"

namespace chromeball {

std::string exrVersion();  // of the OpenEXR that this was built with

// The attributes of type string, int, float, double and m44f, and `envmap`, by their names in the
// file; without the ones that say how the image is stored.
Metadata metadataOf(const Imf::Header& header);
std::optional<Chromaticities> chromaticitiesOf(const Imf::Header& header);

// All but `capDate`: the date of the file that an image is made of is not that of the file written.
inline constexpr const char* kCaptureDate = "capDate";
void setMetadata(const Metadata& metadata, Imf::Header& header);

// Checks the headers of an OpenEXR file before the library reads them.

// Throws InputError if an attribute is longer than the file or of the wrong length for its type, or
// if a part exceeds the limits (size_limits.h): its image `maxNumbers`, its tiles or the rows that
// are compressed together kMaxImageFloats. Returns the largest number of rows that are compressed
// together.
int checkExrHeaders(const std::filesystem::path& path, uint64_t maxNumbers = kMaxImageFloats);

// Lets OpenEXR compress on all cores, unless the process has chosen a number of threads for it.
void useExrThreads();

}  // namespace chromeball
