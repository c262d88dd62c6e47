// SPDX-License-Identifier: Apache-2.0
// The option --rotation of commands about probes.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "job/arguments.h"

namespace chromeball {

// `rotation` is set when the command line is parsed; it must outlive the command. `more` ends the
// sentence of the help.
inline void addRotationOption(CLI::App& command, Rotation& rotation, const std::string& more = "") {
  command
      .add_option_function<std::string>(
          "--rotation",
          [&rotation](const std::string& text) { rotation = parseRotation(text, "--rotation"); },
          "YAW[,PITCH,ROLL] in degrees, or a quaternion X,Y,Z,W: turn the environment as render's "
          "--probe-rotation" +
              more)
      ->type_name("TEXT");
}

}  // namespace chromeball
