// SPDX-License-Identifier: Apache-2.0
// Opens pages in Chromium, if it is installed.
#pragma once

#include <string>

#include "temporary_folder.h"

constexpr const char* kNoChromium = "no Chromium; see tools/scripts/test_needs.sh";

std::string findChromium();

// The page's document after its scripts have run for a while. `folder` takes the browser's files.
std::string dumpedPage(const std::string& chromium, const TemporaryFolder& folder,
                       const std::string& address, const std::string& options = "",
                       int virtualSeconds = 20);

// The option for an extension that runs `script` in pages of this machine: the pages themselves
// have no test code.
std::string extensionIn(const TemporaryFolder& folder, const std::string& script);
