// SPDX-License-Identifier: Apache-2.0
// Paths of the source tree and of this build.
#pragma once

extern const char kSourceDir[];  // the project
extern const char kBuildDir[];   // this build
extern const char kCommand[];    // the executable
extern const char kCommandServer[];
