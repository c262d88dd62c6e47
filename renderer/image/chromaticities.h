// SPDX-License-Identifier: Apache-2.0
// The primaries and the white of an RGB space, and its conversion to linear Rec. 709, the space of
// all our radiance.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include <filesystem>
#include <optional>

#include "base/message.h"
#include "image/image.h"

namespace chromeball {

// CIE 1931 xy; the default is Rec. 709 with D65.
struct Chromaticities {
  glm::dvec2 red{0.64, 0.33}, green{0.3, 0.6}, blue{0.15, 0.06}, white{0.3127, 0.329};
  bool operator==(const Chromaticities&) const = default;
};

// Compares to three decimals, as files state chromaticities.
bool isRec709(const Chromaticities& space);

// The matrix that converts linear RGB to linear Rec. 709, with the white adapted to D65 by
// Bradford's transform (Lam, "Metamerism and Colour Constancy", 1985), but for CIE XYZ. nullopt if
// the chromaticities are degenerate: primaries on a line, a white without luminance or without one
// of the primaries.
std::optional<glm::dmat3> toRec709(const Chromaticities& space);

// Converts the first three channels.
void convertColor(Image& image, const glm::dmat3& matrix);

// The note that the colour of a file is converted to Rec. 709 from these primaries.
Message conversionNote(const std::filesystem::path& path, const Chromaticities& from);

}  // namespace chromeball
