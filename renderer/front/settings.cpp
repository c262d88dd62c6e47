// SPDX-License-Identifier: Apache-2.0
#include "front/settings.h"

namespace chromeball {

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
