// SPDX-License-Identifier: Apache-2.0
#include "front/scene_values.h"

#include <algorithm>
#include <array>
#include <map>

#include "base/text.h"
#include "front/scene_file_camera.h"

namespace chromeball {
namespace {

// Files, frames and displays of the command, which a program has means of its own for.
constexpr auto kOfTheCommand = std::to_array<std::string_view>(
    {"output.file", "stats", "frames", "frame", "overwrite", "seed-per-frame", "probe-sequence",
     "write-every", "preview", "display", "checkpoint", "checkpoint-every", "resume", "shard"});

using Keywords = std::map<std::string, const Setting*, std::less<>>;

Keywords allKeywords() {
  std::map<std::string_view, int> uses;  // of a key
  for (const Setting& setting : settingTable()) ++uses[setting.key];
  Keywords all;
  for (const Setting& setting : settingTable()) {
    if (setting.type == SettingType::Compound ||
        std::ranges::count(kOfTheCommand, setting.name()) > 0)
      continue;
    std::string keyword = setting.option;
    std::ranges::replace(keyword, '-', '_');
    if (setting.name() == "output.aovs") keyword = "layers";
    if (keyword.empty() && uses[setting.key] == 1) keyword = setting.key;
    if (!keyword.empty()) all[keyword] = &setting;
  }
  return all;
}

const Keywords& settingsByKeyword() {
  static const Keywords all = allKeywords();
  return all;
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
                 didYouMean(key.str(), keywords()));
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
