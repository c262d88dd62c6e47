// SPDX-License-Identifier: Apache-2.0
#include "scene_options.h"

#include <algorithm>
#include <span>

#include "front/settings_page.h"
#include "progress_bar.h"

namespace chromeball {
namespace {

// Breaks lines before `width` characters.
std::string wrapped(const std::string& text, size_t width) {
  std::string lines;
  size_t column = 0;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find(' ', begin), text.size());
    const size_t length = end - begin;
    if (column > 0) {
      const bool fits = column + 1 + length <= width;
      lines += fits ? ' ' : '\n';
      column = fits ? column + 1 : 0;
    }
    lines.append(text, begin, length);
    column += length;
    begin = end + 1;
  }
  return lines;
}

// The setting's help, its choices and its default.
std::string helpOf(const Setting& setting) {
  constexpr size_t kWidth = 68;
  std::string text(setting.help);
  if (!setting.choices.empty())
    text += fmt::format(" Names: {}.", fmt::join(setting.choices, ", "));
  if (setting.type != SettingType::Flag)
    text += fmt::format(" (default: {})", defaultText(setting));
  return wrapped(text, kWidth);
}

std::string titleOf(const Setting& setting) {
  // Options without a key join the sections of related keys.
  const std::string_view title = setting.section.empty() && setting.effect == Effect::Image
                                     ? "Render"
                                 : setting.effect == Effect::Display ? "Output"
                                                                     : "";
  if (!title.empty()) return std::string(title);
  for (const SettingSection& section : settingSections())
    if (section.name == setting.section) return std::string(section.title);
  throw std::logic_error("a setting has no section");
}

// Options that decide the light on surfaces, and none that need an image.
constexpr std::string_view kOfBake[] = {
    "probe",          "probe-mapping",  "probe-rotation", "probe-scale", "samples",   "seed",
    "max-depth",      "ao-distance",    "strategy",       "light-from",  "sun-angle", "light-units",
    "animation",      "animation-time", "variant",        "camera",      "memory",    "threads",
    "texture-memory", "allow-external", "progress",       "quiet"};

// Options that decide the picture, and none about its light, which comes from everywhere.
constexpr std::string_view kOfBasis[] = {"size",
                                         "samples",
                                         "seed",
                                         "max-depth",
                                         "max-diffuse-depth",
                                         "max-specular-depth",
                                         "max-transmission-depth",
                                         "mis",
                                         "glass-shadows",
                                         "single-sided",
                                         "transparent",
                                         "light-units",
                                         "animation",
                                         "animation-time",
                                         "variant",
                                         "camera",
                                         "camera-file",
                                         "memory",
                                         "threads",
                                         "texture-memory",
                                         "allow-external",
                                         "progress",
                                         "quiet"};

// The options among these that vertices do not need.
constexpr std::string_view kOfPixels[] = {
    "size", "max-diffuse-depth", "max-specular-depth", "max-transmission-depth",
    "mis",  "transparent",       "camera-file"};

bool isList(const Setting& setting) {
  return setting.type == SettingType::Choices || setting.type == SettingType::Files;
}

void addSettingOption(Command app, const Setting& setting, Settings& settings) {
  const std::string name = "--" + setting.option;
  const std::string names = setting.letter ? fmt::format("-{},{}", setting.letter, name) : name;
  const auto set = [&setting, &settings, name](const std::vector<std::string>& words) {
    settings.set(setting.name(), parseSetting(setting, words, name), name);
  };
  const std::string help = helpOf(setting);
  if (setting.type == SettingType::Flag) {
    app.addFlag(
           names, [set] { set({"true"}); }, help)
        .group(titleOf(setting));
    return;
  }
  if (!setting.bare.empty()) {
    const auto setOrBare = [&setting, set](const std::string& word) {
      set({word == "true" ? std::string(setting.bare) : word});
    };
    app.addFlagWithValue(names, setOrBare, help)
        .typeName(fmt::format("[={}]", setting.argument))
        .group(titleOf(setting));
    return;
  }
  Option option = app.addParsedOption(names, set, help);
  option.typeName(std::string(setting.argument)).group(titleOf(setting));
  if (isList(setting)) option.takesAll();
}

}  // namespace

bool isOptionOf(SceneCommand command, const Setting& setting) {
  const auto isIn = [&](std::span<const std::string_view> options) {
    return !setting.option.empty() && std::ranges::count(options, setting.option) > 0;
  };
  switch (command) {
    case SceneCommand::Bake:
      return isIn(kOfBake);
    case SceneCommand::Basis:
      return isIn(kOfBasis);
    case SceneCommand::BasisVertices:
      return isIn(kOfBasis) && !isIn(kOfPixels);
    case SceneCommand::Compare:
      return !setting.renderOnly;
    default:
      return true;
  }
}

bool SceneOptions::showsProgress() const {
  return settings.get<bool>("progress") || (ProgressBar::isTerminal() && !quiet());
}

void addSceneOptions(Command app, SceneOptions& options, SceneCommand command) {
  app.addOption("scene", options.scene, "Scene file (.toml) or model (.gltf, .glb)")
      .typeName("SCENE")
      .required();
  for (const Setting& setting : settingTable())
    if (!setting.option.empty() && isOptionOf(command, setting))
      addSettingOption(app, setting, options.settings);
  app.widerNames();
}

std::string optionText(const Setting& setting, const std::string& value) {
  const std::string argument = value.empty() ? std::string(setting.argument) : value;
  return fmt::format("--{}{}{}", setting.option, argument.empty() ? "" : " ", argument);
}

}  // namespace chromeball
