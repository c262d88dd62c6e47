// SPDX-License-Identifier: Apache-2.0
#include "heeded_settings.h"

#include <algorithm>
#include <span>

#include "front/settings.h"

namespace chromeball {
namespace {

using Names = std::span<const std::string_view>;

// Keys that a command heeds although it does not have their options.
constexpr std::string_view kKeysOfBake[] = {"render.size",         "camera.file",
                                            "lighting.lights",     "lighting.mis",
                                            "render.single_sided", "render.glass_shadows"};
constexpr std::string_view kKeysOfBasis[] = {"lighting.lights", "lighting.from"};
constexpr std::string_view kKeysOfBasisVertices[] = {"render.size", "camera.file",
                                                     "lighting.lights", "lighting.from"};
// Keys that the command takes out itself where it heeds them.
constexpr std::string_view kTakenByBake[] = {"render.ao_distance"};
// The radiance is baked as it is, not as a camera would show it.
constexpr std::string_view kOfCameras[] = {"output.develop"};
// The subjects of a comparison, which its own options set.
constexpr std::string_view kVariedByCompare[] = {"lighting.strategy", "render.samples",
                                                 "render.time", "render.noise"};

bool isIn(Names names, const Setting& setting) {
  return std::ranges::count(names, setting.name()) > 0;
}

Names keysOf(SceneCommand command) {
  switch (command) {
    case SceneCommand::Bake:
      return kKeysOfBake;
    case SceneCommand::Basis:
      return kKeysOfBasis;
    case SceneCommand::BasisVertices:
      return kKeysOfBasisVertices;
    default:
      return {};
  }
}

bool heeds(SceneCommand command, const Setting& setting) {
  if (command == SceneCommand::Bake && isIn(kTakenByBake, setting)) return false;
  return isOptionOf(command, setting) || isIn(keysOf(command), setting);
}

// Whether an image of `render` would differ without the setting.
bool changesImages(const Setting& setting, const SettingValue& value) {
  if (setting.effect != Effect::Image && setting.effect != Effect::Limit &&
      !isIn(kOfCameras, setting))
    return false;
  const std::string text = toText(value);
  const bool isDefault = text == setting.fallback && text != "on";  // nothing is on by itself
  return text != "off" && text != "false" && !isDefault;
}

}  // namespace

void dropUnheeded(SceneFile& scene, SceneCommand command) {
  std::vector<std::string> names;
  std::string location;
  for (const Setting& setting : settingTable()) {
    const auto* given = scene.settings.find(setting.name());
    if (!given || heeds(command, setting)) continue;
    const bool isVaried = command == SceneCommand::Compare && isIn(kVariedByCompare, setting);
    if (changesImages(setting, given->value) && !isVaried) {
      if (names.empty()) location = given->location;
      names.push_back(setting.name());
    }
    scene.settings.erase(setting.name());
  }
  if (!names.empty())
    scene.warnings.push_back(fmt::format(
        "{}: {} {} no effect here; `chromeball render` heeds {}", location, fmt::join(names, ", "),
        names.size() == 1 ? "has" : "have", names.size() == 1 ? "it" : "them"));
}

void dropLight(SceneFile& scene, Settings& options) {
  std::vector<std::string> names;
  for (const Setting& setting : settingTable()) {
    const std::string name = setting.name();
    if (!name.starts_with("probe.") && !name.starts_with("lighting.") && name != "render.max_depth")
      continue;
    if (const auto* given = options.find(name)) names.push_back(given->location);
    scene.settings.erase(name);
    options.erase(name);
  }
  scene.sources.clear();
  scene.surroundings.reset();
  scene.probeTurns.clear();
  scene.lamps = {{.ambient = AmbientLamp{}}};  // black: no scene needs a light of its own
  if (!names.empty())
    scene.warnings.push_back(fmt::format("{} {} no effect on occlusion", fmt::join(names, ", "),
                                         names.size() == 1 ? "has" : "have"));
}

}  // namespace chromeball
