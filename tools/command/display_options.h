// SPDX-License-Identifier: Apache-2.0
// How a command about images shows one as a .png: the options --exposure, --tonemap and
// --white-balance, from the table of settings.
#pragma once

#include <string>
#include <string_view>

#include "command.h"
#include "front/settings.h"
#include "image/io/read_image.h"
#include "image/tonemap.h"

namespace chromeball {

// `settings` is filled when the command line is parsed; it must outlive `app`.
void addDisplayOptions(Command app, Settings& settings);

// The transform for the picture in a file, as it is in its display window. An exposure that is left
// to the picture is that of its header, which the render wrote; else it is chosen from its
// surfaces, as far as the layers alpha, node or depth tell them (image/tonemap.h); it is
// printed. 0 for a file of integers, which is as it was shown, unless it was asked for.
DisplayTransform displayOf(const Settings& settings, const ImageFile& file,
                           const std::string& path);

// "exposure -1.25 stops (from the parts)"
std::string exposureInWords(float exposure, std::string_view source);

// The exposure in the header of a render; nullopt: none.
std::optional<float> exposureIn(const Metadata& metadata);

}  // namespace chromeball
