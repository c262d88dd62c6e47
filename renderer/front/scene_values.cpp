// SPDX-License-Identifier: Apache-2.0
#include "front/scene_values.h"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/ranges.h>

#include "base/text.h"
#include "front/scene_file_sections.h"

namespace chromeball {
namespace {

// Files, frames and displays of the command, which a program has means of its own for; and the name
// of a camera, which replaceCamera() takes.
constexpr auto kOfTheCommand = std::to_array<std::string_view>(
    {"camera.name", "output.file", "stats", "noise-map", "frames", "frame", "overwrite",
     "seed-per-frame", "probe-sequence", "write-every", "preview", "display", "checkpoint",
     "checkpoint-every", "resume", "shard"});

using Keywords = std::map<std::string, const Setting*, std::less<>>;

std::string withUnderscores(std::string option) {
  std::ranges::replace(option, '-', '_');
  return option;
}

bool isOfTheCommand(const Setting& setting) {
  return std::ranges::count(kOfTheCommand, setting.name()) > 0;
}

Keywords allKeywords() {
  Keywords all;
  for (const Setting& setting : settingTable()) {
    if (setting.option.empty() || setting.type == SettingType::Compound || isOfTheCommand(setting))
      continue;
    const bool isLayers = setting.name() == "output.aovs";
    all[isLayers ? "layers" : withUnderscores(setting.option)] = &setting;
  }
  return all;
}

const Keywords& settingsByKeyword() {
  static const Keywords all = allKeywords();
  return all;
}

// What an unknown keyword is: a key of the scene, an option of the command, or a mistake.
std::string meaningOf(std::string_view keyword) {
  std::vector<std::string_view> headings;
  for (const SettingSection& section : settingSections()) {
    const Setting* key = findSetting(section.name, keyword);
    if (!section.name.empty() && key && key->option.empty()) headings.push_back(section.heading);
  }
  if (!headings.empty())
    return fmt::format("it is a key of {}: give it in the scene", fmt::join(headings, " and "));
  for (const Setting& setting : settingTable())
    if (isOfTheCommand(setting) && withUnderscores(setting.option) == keyword)
      return "it is an option of the command alone";
  return didYouMean(keyword, keywords());
}

}  // namespace

void replaceCamera(SceneFile& scene, const toml::table& camera, const std::string& name) {
  for (const std::string_view key : keysOf("camera"))
    scene.settings.erase("camera." + std::string(key));
  scene.camera.reset();
  scene.lens.reset();
  scene.optics.reset();
  const Section section(name, "camera", camera);
  section.read(scene.settings);
  readCamera(section, scene);
}

std::vector<std::string_view> keywords() {
  std::vector<std::string_view> names;
  for (const auto& [keyword, setting] : settingsByKeyword()) names.push_back(keyword);
  return names;
}

Settings keywordSettings(const toml::table& values, const std::string& name) {
  Settings settings;
  for (const auto& [key, value] : values) {
    const Setting* setting = findKeyword(key.str());
    if (!setting)
      throwInput("{}: unknown keyword `{}`; {}", name, printableName(key.str()),
                 meaningOf(key.str()));
    const Entry entry{name, std::string(key.str()), &value, setting};
    settings.set(setting->name(), entry.value(), fmt::format("{}: {}", name, key.str()));
  }
  return settings;
}

const Setting* findKeyword(std::string_view keyword) {
  const auto found = settingsByKeyword().find(keyword);
  return found == settingsByKeyword().end() ? nullptr : found->second;
}

std::string keywordOf(std::string_view setting) {
  for (const auto& [keyword, found] : settingsByKeyword())
    if (found->name() == setting) return keyword;
  return std::string(setting);
}

}  // namespace chromeball
