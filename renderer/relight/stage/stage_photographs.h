// SPDX-License-Identifier: Apache-2.0
// A light stage from photographs: pictures of a subject under a lamp in each of many directions
// (HDRI book, section 9.9.1, Figure 9.42).
#pragma once

#include <filesystem>

#include "base/message.h"
#include "relight/stage/light_stage.h"

namespace chromeball {

struct StagePhotograph {
  std::string file;  // relative to the photographs' folder
  vec3 direction;    // unit, towards the lamp
};

// Lines `FILE,X,Y,Z` (a direction of any length) or `FILE,AZIMUTH,ELEVATION` (degrees:
// directionAt(), probe/mapping.h), all of one kind. A first line with names, empty lines and lines
// that begin with # are skipped. Throws InputError ("CSV:LINE: reason") for other lines, and for a
// file or a direction that occurs twice.
std::vector<StagePhotograph> readPhotographs(const std::filesystem::path& csv);

// Each image shows the subject under distant light that puts `irradiance` on a surface that faces
// it. It stands for the light of its Voronoi cell on the sphere: the element is the image x the
// cell's solid angle / irradiance. Images are linear; files with integers are decoded as sRGB.
// `messages` gets the readers'. Throws InputError for images of different size or with values that
// are not finite, and if the stage takes more than `memory` bytes.
LightStage stageOf(const std::filesystem::path& folder,
                   const std::vector<StagePhotograph>& photographs, float irradiance, double memory,
                   Messages& messages);

}  // namespace chromeball
