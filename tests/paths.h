// SPDX-License-Identifier: Apache-2.0
// Where the build put things.
#pragma once

extern const char kSourceDir[];  // of the project
extern const char kCommand[];    // the executable
