// SPDX-License-Identifier: Apache-2.0
// The packages of tests/npm, if tools/scripts/test_needs.sh has installed them.
#pragma once

#include <string>

constexpr const char* kNoNpmPackages = "no build/npm; see tools/scripts/test_needs.sh";

// Links them into `folder`, where programs of Node.js and pages find them; false if there are none.
bool linkNpmPackages(const std::string& folder);
