// SPDX-License-Identifier: Apache-2.0
#include "front/settings.h"

#include <algorithm>
#include <stdexcept>

namespace chromeball {
namespace {

std::string_view usualArgument(SettingType type) {
  return type == SettingType::Choice ? "NAME" : type == SettingType::Integer ? "N" : "";
}

void completeRow(const SettingSection& section, Setting& row) {
  row.section = section.name;
  if (row.argument.empty() && (section.keysAreOptions || !row.option.empty()))
    row.argument = usualArgument(row.type);
  if (!section.keysAreOptions || !row.option.empty()) return;
  if (row.argument.empty() && row.type != SettingType::Flag) return;
  row.option = row.key;
  std::ranges::replace(row.option, '_', '-');
}

}  // namespace

const std::vector<Setting>& settingTable() {
  static const std::vector<Setting> table = [] {
    std::vector<Setting> all;
    for (const SettingSection& section : settingSections())
      for (Setting& row : section.rows()) {
        completeRow(section, row);
        all.push_back(std::move(row));
      }
    return all;
  }();
  return table;
}

std::span<const SettingSection> settingSections() {
  static constexpr SettingSection sections[] = {
      {"model", "model", "Models",
       "One or several glTF files: `model = \"a.glb\"`, `model = [\"a.glb\", \"b.glb\"]`, or "
       "tables `[[model]]` with the keys below. A model is scaled, then rotated, then moved.",
       modelRows, true},
      {"camera", "[camera]", "Camera",
       "A camera of the model by `name`, or one of its own: `position` and `look_at`, and `up`, "
       "`fov` or `orthographic`, here or in a `file`. Without either, the model's first camera "
       "renders, or one that frames the model; `view` and `look_at_node` ask for the latter, and "
       "exclude `name`, `file` and `position`: given as options, they take the place of the scene "
       "file's camera. `fov` applies to any perspective "
       "camera, and `zoom` to any. `aperture` and `focus` go together. "
       "They apply to any perspective camera, as do `principal_point` and `distortion`, which a "
       "`file` has itself.",
       cameraRows, true},
      {"probe", "[probe]", "Probe",
       "The light probe. Without a file, the model's own environment or lights light the scene.",
       probeRows, true},
      {"lighting", "[lighting]", "Lighting", "How the scene's light is sampled.", lightingRows,
       true},
      {"light", "[[light]]", "Lamps",
       "One table for each lamp. A point light has `intensity` or `power`, and perhaps a `range`; "
       "a spot also `direction`, `inner_angle` and `outer_angle`; a disc has `direction`, "
       "`radius`, and `radiance` or `power`, and is a surface like others: a polygon of 128 sides "
       "with its exact area that shines to one side.",
       lightRows},
      {"source", "[[source]]", "Sources",
       "Windows and lamps in the probe that become light sources of their own: one table for each, "
       "or for a file of them. With [surroundings] they are on its walls.",
       sourceRows},
      {"render", "[render]", "Render",
       "The image, and how long to render it. `time` and `noise` end the samples early; if one of "
       "them is given, `samples` is a maximum. On the command line, any of the three replaces all "
       "three of the file.",
       renderRows, true},
      {"output", "[output]", "Output",
       "The files to write. The folder of a file is created if it is missing and its parent "
       "exists.",
       outputRows, true},
      {"composite", "[composite]", "Composite",
       "Differential rendering: composites the model's nodes into a photograph, except those of "
       "the local scene, which model real surfaces in the photograph. With `ground = true` the "
       "model needs none: objects stand on a plane that takes their shadows.",
       compositeRows},
      {"surroundings", "[surroundings]", "Surroundings",
       "The surface at a finite distance that the probe is mapped onto, as seen from `capture`.",
       surroundingsRows},
      {"", "The command line only", "Run", "These settings are options without a key.",
       commandRows},
  };
  return sections;
}

Setting numberRow(std::string_view key, const Range& range, std::string_view unit,
                  std::string_view absent, std::string_view help) {
  return {.key = key,
          .type = SettingType::Compound,
          .form = "a number",
          .range = range,
          .unit = unit,
          .absent = absent,
          .help = help};
}

Setting pointRow(std::string_view key, std::string_view absent, std::string_view help) {
  return {.key = key,
          .type = SettingType::Compound,
          .form = "three numbers",
          .unit = "metres",
          .absent = absent,
          .help = help};
}

void addRenderOnly(std::vector<Setting>& rows, Effect effect, std::vector<Setting> more) {
  for (Setting& row : more) {
    row.effect = effect;
    row.renderOnly = true;
    rows.push_back(std::move(row));
  }
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

int Settings::indexOfChoice(std::string_view name) const {
  const auto& choices = settingNamed(name).choices;
  return int(std::ranges::find(choices, get<std::string>(name)) - choices.begin());
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
