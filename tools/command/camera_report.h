// SPDX-License-Identifier: Apache-2.0
// The output of `chromeball camera solve`.
#pragma once

#include <string>
#include <vector>

#include "scene/solve/solved_camera.h"

namespace chromeball {

struct CameraReport {
  std::string method;  // "points", "lines" or "fspy"
  const SolvedCamera& camera;
  const CameraFit* fit = nullptr;  // null for fspy
  std::vector<std::string> names;  // of the points or lines
};

// "points      12, RMS 0.43 pixels, worst `lamp` 0.91 pixels", and so on.
std::vector<std::string> reportLines(const CameraReport& report);

// The report as JSON, indented by two spaces.
std::string reportJson(const CameraReport& report);

}  // namespace chromeball
