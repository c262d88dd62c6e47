// SPDX-License-Identifier: Apache-2.0
// Options that commands about probes and lights share: the rotation, the number of faces of an
// icosphere, and the part of the probe that gives no light.
#pragma once

#include <cstdint>
#include <string>

#include "base/error.h"
#include "command.h"
#include "front/arguments.h"
#include "probe/load.h"

namespace chromeball {

inline constexpr const char* kMaskHelp = "directions that give no light: none or below-horizon";

// The probe of a command about lights.
struct LightsProbe {
  std::string file, mapping = "auto", mask = "none";

  // Throws InputError.
  void checkMask() const;
  // The probe as a lat-long map; prints warnings, also if the mask leaves no light. Throws
  // InputError.
  Image load() const { return loadWithFile().latLong; }
  // The same, with the properties of the file.
  LoadedProbe loadWithFile() const;
};

// Throws InputError.
inline int subdivisionsFor(int normals) {
  constexpr int kMax = 8;
  for (int i = 0, faces = 20; i <= kMax; ++i, faces *= 4)
    if (faces == normals) return i;
  throwInput(
      "--normals: {} should be 20 times a power of 4, up to 1310720: 20, 80, 320, 1280, 5120, "
      "20480, ...",
      normals);
}

// A seed from its text: std::stoull and the like take -1 for 2^64 - 1. Throws InputError.
uint64_t parseSeed(const std::string& text);

// --probe-rotation. `rotation` is set when the command line is parsed; it must outlive the command.
// `more` ends the sentence of the help.
void addRotationOption(Command command, Rotation& rotation, const std::string& more = "");

}  // namespace chromeball
