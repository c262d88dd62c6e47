// SPDX-License-Identifier: Apache-2.0
#include "scene_options.h"

#include <algorithm>
#include <array>
#include <span>

#include "front/settings.h"
#include "session/load_scene.h"
#include "session/memory_estimate.h"

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
    "probe",     "probe-mapping", "probe-rotation", "probe-scale",    "samples",
    "seed",      "max-depth",     "ao-distance",    "strategy",       "light-from",
    "sun-angle", "light-units",   "animation",      "animation-time", "variant",
    "camera",    "memory",        "threads",        "texture-memory", "allow-external"};

// Options that decide the picture, and none about its light, which comes from everywhere: at
// vertices, and the further ones at pixels.
constexpr std::string_view kOfVertices[] = {
    "samples",     "seed",      "max-depth",      "glass-shadows", "single-sided",
    "light-units", "animation", "animation-time", "variant",       "camera",
    "memory",      "threads",   "texture-memory", "allow-external"};
constexpr std::string_view kOfPixels[] = {"size",
                                          "max-diffuse-depth",
                                          "max-specular-depth",
                                          "max-transmission-depth",
                                          "mis",
                                          "transparent",
                                          "camera-file",
                                          "view",
                                          "fov",
                                          "zoom",
                                          "look-at"};

// What the brief help shows.
constexpr auto kCommon = std::to_array<const char*>(
    {"output", "probe", "probe-rotation", "probe-scale", "view", "zoom", "ground", "frames",
     "turntable", "shadow-catcher", "size", "quality", "time", "exposure", "aov"});

bool isList(const Setting& setting) {
  return setting.type == SettingType::Choices || setting.type == SettingType::Files;
}

// Of a list in one text, "NODE,..." or "NAME=VALUE ..."; empty for all else.
std::string_view separatorOf(const Setting& setting) {
  if (setting.type != SettingType::Name || setting.argument.find("...") == std::string_view::npos)
    return "";
  return setting.argument.find(",...") == std::string_view::npos ? " " : ",";
}

using Names = std::span<const std::string_view>;

// Keys that a command heeds although it does not have their options.
constexpr std::string_view kKeysOfBake[] = {
    "render.size",         "camera.file",         "camera.view",     "camera.look_at_node",
    "camera.fov",          "camera.zoom",         "lighting.lights", "lighting.mis",
    "render.single_sided", "render.glass_shadows"};
constexpr std::string_view kKeysOfBasis[] = {"lighting.lights", "lighting.from"};
constexpr std::string_view kKeysOfBasisVertices[] = {
    "render.size", "camera.file", "camera.view",     "camera.look_at_node",
    "camera.fov",  "camera.zoom", "lighting.lights", "lighting.from"};
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

bool isOptionOf(SceneCommand command, const Setting& setting) {
  const auto isIn = [&](std::span<const std::string_view> options) {
    return !setting.option.empty() && std::ranges::count(options, setting.option) > 0;
  };
  switch (command) {
    case SceneCommand::Bake:
      return isIn(kOfBake);
    case SceneCommand::Basis:
      return isIn(kOfVertices) || isIn(kOfPixels);
    case SceneCommand::BasisVertices:
      return isIn(kOfVertices);
    case SceneCommand::Compare:
      return !setting.renderOnly;
    default:
      return true;
  }
}

void addSceneOptions(Command app, SceneOptions& options, SceneCommand command,
                     const std::string& examples) {
  app.addRequired("scene", options.scene, "Scene file (.toml) or model (.gltf, .glb)")
      .typeName("SCENE");
  for (const Setting& setting : settingTable())
    if (!setting.option.empty() && isOptionOf(command, setting))
      addSettingOption(app, setting, options.settings);
  app.widerNames();
  app.briefHelp({kCommon.begin(), kCommon.end()}, examples);
}

void addSettingOption(Command app, const Setting& setting, Settings& settings) {
  const std::string name = "--" + setting.option;
  const std::string names = setting.letter ? fmt::format("-{},{}", setting.letter, name) : name;
  const auto set = [&setting, &settings, name](const std::vector<std::string>& words) {
    settings.set(setting.name(), parseSetting(setting, words, name), name);
  };
  const std::string help = helpOf(setting);
  if (setting.type == SettingType::Flag) {  // --denoise=false: not what --quality stands for
    app.addFlagWithValue(
           names, [set](const std::string& word) { set({word}); }, help)
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
  const auto setJoined = [&setting, set](const std::vector<std::string>& words) {
    set({fmt::format("{}", fmt::join(words, separatorOf(setting)))});
  };
  const bool isText = !separatorOf(setting).empty();
  Option option =
      isText ? app.addParsedOption(names, setJoined, help) : app.addParsedOption(names, set, help);
  option.typeName(std::string(setting.argument)).group(titleOf(setting));
  if (isText || isList(setting)) option.takesAll();
}

std::string optionText(const Setting& setting, const std::string& value) {
  const std::string argument = value.empty() ? std::string(setting.argument) : value;
  return fmt::format("--{}{}{}", setting.option,
                     argument.empty()       ? ""
                     : setting.bare.empty() ? " "
                                            : "=",
                     argument);
}

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

void checkMemoryWithScene(const LoadedScene& loaded, double bytes, const std::string& what) {
  const double needed = bytes + estimateMemory(loaded).peak;
  const double limit = memoryLimit(loaded.description);
  if (needed > limit)
    throw InputError(fmt::format("{} {:.3g} GB of memory with all else; the limit is {:.3g} GB",
                                 what, 1e-9 * needed, 1e-9 * limit),
                     Remedy{"memory", {}});
}

std::vector<PlacedMesh> placedWithinMemory(const LoadedScene& loaded) {
  // The placed mesh, its points and their results, and the file's arrays; measured.
  constexpr double kBytesPerTriangle = 72, kBytesPerVertex = 260;
  double triangles = 0, vertices = 0;
  for (const Instance& instance : loaded.scene.instances) {
    const Mesh& mesh = loaded.scene.meshes[size_t(instance.mesh)];
    triangles += double(mesh.triangles.size()), vertices += double(mesh.positions.size());
  }
  checkMemoryWithScene(
      loaded, kBytesPerTriangle * triangles + kBytesPerVertex * vertices,
      fmt::format("{}: {} instances with {} triangles apart take", loaded.description.path,
                  loaded.scene.instances.size(), triangles));
  return placedMeshes(loaded.scene);
}

}  // namespace chromeball
