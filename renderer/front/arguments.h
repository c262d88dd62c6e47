// SPDX-License-Identifier: Apache-2.0
// Values of settings and options from their text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "image/develop/develop.h"
#include "math/rotation.h"
#include "probe/mapping.h"
#include "scene/gltf/load_gltf.h"

namespace chromeball {

// "WxH", both 1 to 65536. Throws InputError, begun by `location`.
ImageSize parseSize(std::string_view text, std::string_view location);

// "photometric" or "radiometric". Throws InputError, begun by the setting's location.
LightUnits parseLightUnits(const NamedSetting& setting);

// "A,B" or "A,B,C": exactly `count` finite numbers. Throws InputError, begun by `location`.
std::vector<double> parseNumbers(std::string_view text, size_t count, std::string_view location);

// The range of positive floats, for messages; and whether a number is in it.
inline constexpr const char* kPositiveFloats = "1.4e-45 to 3.4e38, the range of a float";
bool isPositiveFloat(double number);

// A colour from a number for all channels, or three; and from the text "X" or "R,G,B", each 0 or a
// positive float. Throws InputError, begun by `location`.
glm::dvec3 colorOf(const std::vector<double>& numbers);
Rgb parseColor(std::string_view text, std::string_view location);

// A rotation from a yaw in degrees; from yaw, pitch and roll; or from a quaternion x, y, z, w,
// whose length must be 1 within 1%, so that four angles are not taken for one. Throws InputError,
// begun by `location`.
Rotation parseRotation(const std::vector<double>& numbers, std::string_view location);
// The same from numbers with commas between.
Rotation parseRotation(std::string_view text, std::string_view location);

// The steps of developing (image/develop/develop.h), as options of `chromeball image develop` and
// as the setting `develop` of a render.

// Sets one of
//   clip=X, depth-blur=FOCUS:APERTURE, motion=LENGTH@ANGLE, bloom=WEIGHT:SIGMA,...,
//   glare=spencer, vignette=STRENGTH.
// Precondition: `name` is one of these. The weights of a bloom must sum to 1 within 1%, and are
// made to sum to 1. Throws InputError, begun by `location`.
void setDevelop(DevelopSettings& settings, std::string_view name, std::string_view text,
                std::string_view location);

// Sets all of "bloom=.75:1,.25:32 vignette=.4". Throws InputError, begun by `location`.
DevelopSettings parseDevelop(std::string_view text, std::string_view location);

}  // namespace chromeball
