// SPDX-License-Identifier: Apache-2.0
#include "probe_options.h"

#include <charconv>

#include "base/error.h"
#include "base/text.h"
#include "front/arguments.h"
#include "image_files.h"
#include "messages.h"
#include "probe/edit.h"

namespace chromeball {

void LightsProbe::checkMask() const {
  if (mask != "none" && mask != "below-horizon")
    throwInput("--probe-mask: unknown mask `{}`; {}", mask,
               didYouMean(mask, {"none", "below-horizon"}));
}

LoadedProbe LightsProbe::loadWithFile() const {
  LoadedProbe probe = openProbe(file, mapping, "--probe-mapping");
  if (mask == "below-horizon") {
    replaceBelowHorizon(probe.latLong, Rgb(0));
    if (probe.maximum > 0 && meanRadiance(probe.latLong) == glm::dvec3(0))
      warn("--probe-mask: {} leaves no light; {} is black above the horizon", mask, file);
  }
  return probe;
}

uint64_t parseSeed(const std::string& text) {
  uint64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, seed);
  if (error != std::errc() || rest != end)
    throwInput("--seed: `{}` should be a whole number from 0 to 2^64 - 1", text);
  return seed;
}

void addRotationOption(Command command, Rotation& rotation, const std::string& more) {
  command
      .addParsedOption(
          "--probe-rotation",
          [&rotation](const Command::Words& words) {
            rotation = parseRotation(words.front(), "--probe-rotation");
          },
          "YAW[,PITCH,ROLL] in degrees, or a quaternion X,Y,Z,W: turn the environment" + more)
      .typeName("TEXT");
}

}  // namespace chromeball
