// SPDX-License-Identifier: Apache-2.0
// The subcommands of `chromeball image`.
#pragma once

#include <CLI/CLI.hpp>

namespace chromeball {

void addImageDenoiseCommand(CLI::App& image);
void addImageDevelopCommand(CLI::App& image);
void addImageDivideCommand(CLI::App& image);
void addImageErrorCommand(CLI::App& image);
void addImageFlatFieldCommand(CLI::App& image);
void addImageRelightCommand(CLI::App& image);
void addImageViewCommand(CLI::App& image);

}  // namespace chromeball
