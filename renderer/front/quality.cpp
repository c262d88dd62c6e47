// SPDX-License-Identifier: Apache-2.0
#include "front/quality.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace chromeball {
namespace {

struct Preset {
  std::string_view quality, setting, value;
};

// They are one decision.
constexpr std::array<std::string_view, 3> kLimitSettings = {"render.samples", "render.time",
                                                            "render.noise"};

// Measured: docs/methods.md#quality.
constexpr Preset kPresets[] = {
    {"draft", "render.samples", "16"},   {"draft", "render.denoise", "true"},
    {"draft", "render.max_depth", "5"},  {"good", "render.samples", "256"},
    {"good", "render.noise", "2%"},      {"good", "render.denoise", "true"},
    {"good", "render.max_depth", "8"},   {"final", "render.samples", "4096"},
    {"final", "render.noise", "0.5%"},   {"final", "render.denoise", "true"},
    {"final", "render.max_depth", "16"},
};

// "samples 16", "noise 2%", "denoise"
std::string inWords(const Preset& preset) {
  const std::string_view key = preset.setting.substr(preset.setting.find('.') + 1);
  return preset.value == "true" ? std::string(key) : fmt::format("{} {}", key, preset.value);
}

}  // namespace

bool givesLimit(const Settings& settings) {
  return std::ranges::any_of(kLimitSettings,
                             [&](std::string_view name) { return settings.has(name); });
}

void eraseLimits(Settings& settings) {
  for (const std::string_view name : kLimitSettings) settings.erase(name);
}

std::vector<std::string_view> qualityNames() {
  std::vector<std::string_view> names;
  for (const Preset& preset : kPresets)
    if (names.empty() || names.back() != preset.quality) names.push_back(preset.quality);
  return names;
}

std::string qualitiesInWords() {
  std::string text;
  std::string_view last;
  for (const Preset& preset : kPresets) {
    if (preset.quality != last)
      text += fmt::format("{}{}: ", last.empty() ? "" : "; ", preset.quality);
    else
      text += ", ";
    text += inWords(preset);
    last = preset.quality;
  }
  return text;
}

std::string applyQuality(Settings& settings) {
  const auto quality = settings.getIfGiven<std::string>("render.quality");
  if (!quality) return "";
  const std::string location = settings.location("render.quality");
  const bool hasLimits = givesLimit(settings);
  std::vector<std::string> words;
  for (const Preset& preset : kPresets) {
    if (preset.quality != *quality || settings.has(preset.setting)) continue;
    if (hasLimits && std::ranges::count(kLimitSettings, preset.setting) > 0) continue;
    const Setting& setting = settingNamed(preset.setting);
    settings.set(preset.setting, parseSetting(setting, {std::string(preset.value)}, location),
                 location);
    words.push_back(inWords(preset));
  }
  return fmt::format("{}: {}", *quality, fmt::join(words, ", "));
}

}  // namespace chromeball
