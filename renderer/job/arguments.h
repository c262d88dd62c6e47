// SPDX-License-Identifier: Apache-2.0
// Arguments that several subcommands take.
#pragma once

#include <string>
#include <string_view>

#include "job/scene_file.h"
#include "probe/convert.h"

namespace chromeball {

// "WxH", both 1 to 65536. Throws InputError that begins with `option`.
ImageSize parseSize(std::string_view text, std::string_view option = "--size");

// "photometric" or "radiometric". Throws InputError that begins with the setting's place.
LightUnits parseLightUnits(const NamedSetting& setting);

// "A,B" or "A,B,C": exactly `count` finite numbers. Throws InputError that begins with `option`.
std::vector<double> parseNumbers(std::string_view text, size_t count, std::string_view option);

}  // namespace chromeball
