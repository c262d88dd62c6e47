// SPDX-License-Identifier: Apache-2.0
// The option --rotation of commands about probes.
#pragma once

#include <string>
#include "command.h"

#include "front/arguments.h"

namespace chromeball {

// `rotation` is set when the command line is parsed; it must outlive the command. `more` ends the
// sentence of the help.
inline void addRotationOption(Command command, Rotation& rotation, const std::string& more = "") {
  command
      .addParsedOption(
          "--rotation",
          [&rotation](const Command::Words& words) {
            rotation = parseRotation(words.front(), "--rotation");
          },
          "YAW[,PITCH,ROLL] in degrees, or a quaternion X,Y,Z,W: turn the environment as render's "
          "--probe-rotation" +
              more)
      .typeName("TEXT");
}

}  // namespace chromeball
