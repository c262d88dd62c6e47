// SPDX-License-Identifier: Apache-2.0
// The presets of `quality`: each stands for other settings.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "front/settings.h"

namespace chromeball {

// The limits that end a render (samples, time and noise) are one decision.
bool givesLimit(const Settings& settings);
void eraseLimits(Settings& settings);

std::vector<std::string_view> qualityNames();

// What they stand for: "draft: samples 16, denoise, ...; good: ...". It does not use the table of
// settings, whose help has it.
std::string qualitiesInWords();

// Sets what the setting `render.quality` stands for, except what the settings have already; of the
// limits none if they have one. Returns what it set, as qualitiesInWords() has
// it; empty without a quality.
std::string applyQuality(Settings& settings);

}  // namespace chromeball
