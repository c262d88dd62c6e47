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
     "write-every", "preview", "display", "checkpoint", "checkpoint-every", "resume", "shard",
     "progress", "quiet"});

const std::map<std::string, const Setting*, std::less<>>& settingsByKeyword() {
  static const auto found = [] {
    std::map<std::string, const Setting*, std::less<>> all;
    std::map<std::string_view, int> uses;  // of a key
    const auto isFor = [](const Setting& s) {
      return s.type != SettingType::Compound && std::ranges::count(kOfTheCommand, s.name()) == 0;
    };
    for (const Setting& setting : settingTable()) {
      if (!setting.key.empty()) ++uses[setting.key];
      if (setting.option.empty() || !isFor(setting)) continue;
      std::string keyword = setting.option;
      std::ranges::replace(keyword, '-', '_');
      all[keyword] = &setting;
    }
    for (const Setting& setting : settingTable())
      if (uses[setting.key] == 1 && isFor(setting))
        all.try_emplace(std::string(setting.key), &setting);
    return all;
  }();
  return found;
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
    const auto found = settingsByKeyword().find(key.str());
    if (found == settingsByKeyword().end())
      throwInput("{}: unknown keyword `{}`; {}", name, printableName(key.str()),
                 didYouMean(key.str(), keywords()));
    const Entry entry{name, std::string(key.str()), &value, found->second};
    settings.set(found->second->name(), entry.value(), fmt::format("{}: {}", name, key.str()));
  }
  return settings;
}

std::string keywordOf(std::string_view setting) {
  for (const auto& [keyword, found] : settingsByKeyword())
    if (found->name() == setting) return keyword;
  return std::string(setting);
}

}  // namespace chromeball
