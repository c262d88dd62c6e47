// SPDX-License-Identifier: Apache-2.0
// The attributes of an OpenEXR header that are metadata.
#pragma once

#include <OpenEXR/ImfForward.h>

#include "image/io/read_image.h"

namespace chromeball {

// Those of type string, int, float, double and m44f, and `envmap`, by their names in the file;
// without those that say how the image is stored.
Metadata metadataOf(const Imf::Header& header);
std::optional<Chromaticities> chromaticitiesOf(const Imf::Header& header);
void setMetadata(const Metadata& metadata, Imf::Header& header);

}  // namespace chromeball
