// SPDX-License-Identifier: Apache-2.0
// Real probes and models, stored outside of the source tree; tests skip if they are absent.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

// A path in the folder $CHROMEBALL_DATA or, if that is not set, ../shared/data relative to the
// source tree; nullopt if it does not exist.
std::optional<std::filesystem::path> sharedData(const std::string& relative);
