// SPDX-License-Identifier: Apache-2.0
// The models of the gallery's scenes; each is a .glb with a camera named View. They throw RunError.
#pragma once

#include <string>

namespace chromeball::demo {

// Ball, cone, cube, ring and cylinder of different materials on a slab of stone (HDRI figure 9.1).
void writeFiveShapes(const std::string& path);

// Balls of glass, metal and plastic on stands about a pedestal of marble (HDRI figure 9.3).
void writePedestal(const std::string& path);

// A Doric temple on a hill; its columns are instances (HDRI figures 9.22 to 9.28).
void writeTemple(const std::string& path);

}  // namespace chromeball::demo
