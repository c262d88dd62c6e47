// SPDX-License-Identifier: Apache-2.0
// Where the build put things.
#pragma once

extern const char kSourceDir[];  // the project
extern const char kBuildDir[];   // this build
extern const char kCommand[];    // the executable
