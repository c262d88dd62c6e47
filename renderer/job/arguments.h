// SPDX-License-Identifier: Apache-2.0
// Values of settings and options from their text.
#pragma once

#include <string>
#include <string_view>

#include "base/named_setting.h"
#include "probe/mapping.h"
#include "scene/gltf/load_gltf.h"

namespace chromeball {

// "WxH", both 1 to 65536. Throws InputError, begun by `location`.
ImageSize parseSize(std::string_view text, std::string_view location);

// "photometric" or "radiometric". Throws InputError, begun by the setting's location.
LightUnits parseLightUnits(const NamedSetting& setting);

// "A,B" or "A,B,C": exactly `count` finite numbers. Throws InputError, begun by `location`.
std::vector<double> parseNumbers(std::string_view text, size_t count, std::string_view location);

}  // namespace chromeball
