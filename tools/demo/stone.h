// SPDX-License-Identifier: Apache-2.0
// Stone for the demo's buildings: solid textures, and walls of blocks.
#pragma once

#include <functional>

#include "image/image.h"
#include "probe/mapping.h"
#include "shapes.h"

namespace chromeball::demo {

// The colour at a point in space (metres). Values are reflectances.
using SolidTexture = std::function<Rgb(const vec3&)>;

// Marble: a ground with folded veins, `size` metres apart.
SolidTexture marble(Rgb ground, Rgb vein, float size);

// The texture on a surface whose UVs are its parameters; without a seam, as the stone is solid.
Image carve(const ImageSize& size, const Parametrisation& surface, const SolidTexture& texture);

// Courses of blocks, each of its own tone, half a block apart from course to course; tiles in both
// directions if `columns` and the even `rows` are whole.
Image ashlar(int size, int columns, int rows, Rgb color);

}  // namespace chromeball::demo
