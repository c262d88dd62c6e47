// SPDX-License-Identifier: Apache-2.0
#include "front/settings.h"

#include <stdexcept>

namespace chromeball {

const std::vector<Setting>& settingTable() {
  static const std::vector<Setting> table = [] {
    std::vector<Setting> all = sceneRows();
    for (const auto rows : {lightRows, sourceRows, renderRows, compositeRows, commandRows})
      for (Setting& row : rows()) all.push_back(std::move(row));
    return all;
  }();
  return table;
}

std::span<const SettingSection> settingSections() {
  static constexpr SettingSection sections[] = {
      {"model", "model", "Models",
       "One or several glTF files: `model = \"a.glb\"`, `model = [\"a.glb\", \"b.glb\"]`, or "
       "tables `[[model]]` with the keys below. A model is scaled, then rotated, then moved."},
      {"camera", "[camera]", "Camera",
       "A camera of the model by `name`, or one of its own: `position` and `look_at`, and `up`, "
       "`fov` or `orthographic`, here or in a `file`. Without either, the model's first camera "
       "renders, or one that frames the model. `aperture` and `focus` go together; these, "
       "`principal_point` and `distortion` apply to any perspective camera."},
      {"probe", "[probe]", "Probe",
       "The light probe. Without a file, the model's own environment or lights light the scene."},
      {"lighting", "[lighting]", "Lighting", "How the scene's light is sampled."},
      {"light", "[[light]]", "Lamps",
       "One table for each lamp. A point light has `intensity` or `power`, and perhaps a `range`; "
       "a spot also `direction`, `inner_angle` and `outer_angle`; a disc has `direction`, "
       "`radius`, "
       "and `radiance` or `power`, and is a surface like others: a polygon of 128 sides with its "
       "exact area that shines to one side."},
      {"source", "[[source]]", "Sources",
       "Windows and lamps in the probe that become light sources of their own: one table for each, "
       "or for a file of them. With [surroundings] they are on its walls."},
      {"render", "[render]", "Render",
       "The image, and how long to render it. `time` and `noise` end the samples early; if one of "
       "them is given, `samples` is a maximum. On the command line, any of the three replaces all "
       "three of the file."},
      {"output", "[output]", "Output",
       "The files to write. The folder of a file is created if it is missing and its parent "
       "exists."},
      {"composite", "[composite]", "Composite",
       "Differential rendering: composites the model's nodes into a photograph, except those of "
       "the local scene, which model real surfaces in the photograph. With `ground = true` the "
       "model needs none: objects stand on a plane that takes their shadows."},
      {"surroundings", "[surroundings]", "Surroundings",
       "The surface at a finite distance that the probe is mapped onto, as seen from `capture`."},
      {"", "The command line only", "Run", "These settings are options without a key."},
  };
  return sections;
}

std::vector<std::string_view> keysOf(std::string_view section) {
  std::vector<std::string_view> keys;
  for (const Setting& setting : settingTable())
    if (setting.section == section && !setting.key.empty()) keys.push_back(setting.key);
  return keys;
}

const Setting& settingNamed(std::string_view name) {
  for (const Setting& setting : settingTable())
    if (setting.name() == name) return setting;
  throw std::logic_error("no setting is named " + std::string(name));
}

const Setting* findSetting(std::string_view section, std::string_view key) {
  for (const Setting& setting : settingTable())
    if (setting.section == section && setting.key == key && !key.empty()) return &setting;
  return nullptr;
}

void Settings::set(std::string_view name, SettingValue value, std::string location) {
  const Setting& setting = settingNamed(name);
  checkSetting(setting, value, location.empty() ? std::string(name) : location);
  given_.insert_or_assign(std::string(name), Given{std::move(value), std::move(location)});
}

void Settings::parse(std::string_view name, const std::string& text) {
  const Setting& setting = settingNamed(name);
  set(name, parseSetting(setting, {text}, std::string(name)));
}

void Settings::erase(std::string_view name) {
  if (const auto found = given_.find(name); found != given_.end()) given_.erase(found);
}

void Settings::merge(const Settings& over) {
  for (const auto& [name, given] : over.given_) given_.insert_or_assign(name, given);
}

const Settings::Given* Settings::find(std::string_view name) const {
  const auto found = given_.find(name);
  if (found == given_.end()) {
    settingNamed(name);  // throws for a name that does not exist
    return nullptr;
  }
  return &found->second;
}

std::optional<SettingValue> Settings::value(std::string_view name) const {
  if (const Given* given = find(name)) return given->value;
  const Setting& setting = settingNamed(name);
  const bool hasDefault = setting.type == SettingType::Flag || !setting.fallback.empty();
  return hasDefault ? std::optional(defaultOf(name)) : std::nullopt;
}

std::string Settings::location(std::string_view name) const {
  const Given* given = find(name);
  return given && !given->location.empty() ? given->location : std::string(name);
}

SettingValue Settings::defaultOf(std::string_view name) {
  const Setting& setting = settingNamed(name);
  if (setting.type == SettingType::Flag) return false;
  if (setting.type == SettingType::Choices || setting.type == SettingType::Files)
    return std::vector<std::string>{};
  if (setting.fallback.empty())
    throw std::logic_error("setting " + std::string(name) + " has no default");
  return parseSetting(setting, {setting.fallback}, std::string(name));
}

bool isShadowCatcher(const Settings& settings) {
  return settings.get<std::string>("composite.mode") == "shadow-catcher";
}

}  // namespace chromeball
