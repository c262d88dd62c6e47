// SPDX-License-Identifier: Apache-2.0
// The table of settings, and the command line, scene file and manual page that use it.
#include "front/settings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include "base/error.h"
#include "front/plan_render.h"
#include "front/scene_values.h"
#include "front/synonyms.h"
#include "render/render.h"
#include "run_command.h"

namespace chromeball::settings_test {
namespace {

using Words = std::vector<std::string>;

std::vector<const Setting*> scalars() {
  std::vector<const Setting*> rows;
  for (const Setting& setting : settingTable())
    if (setting.type != SettingType::Compound) rows.push_back(&setting);
  return rows;
}

// The text of an option's value, and whether it is valid.
struct OptionValue {
  std::string text;
  bool valid;
};

std::string decimal(double x) {
  return x == std::floor(x) ? fmt::format("{:.0f}", x) : fmt::format("{}", x);
}

std::vector<OptionValue> valuesOf(const Setting& s) {
  std::vector<OptionValue> values;
  const auto limit = [&](double at, bool excluded, double beyond) {
    if (!std::isfinite(at)) return;
    values.push_back({decimal(at), !excluded});
    values.push_back({decimal(at + beyond), false});
  };
  switch (s.type) {
    case SettingType::Integer:
      limit(s.range.min, false, -1);
      limit(s.range.max, false, 1);
      values.push_back({"1.5", false});
      values.push_back({"many", false});
      values.push_back({"2x", false});
      break;
    case SettingType::NumberOrAuto:
      values.push_back({"auto", true});
      values.push_back({"off", false});
      limit(s.range.min, s.range.excludesMin, -0.001);
      limit(s.range.max, s.range.excludesMax, 1);
      break;
    case SettingType::Factor:
      values.push_back({"off", true});
      values.push_back({"on", false});
      [[fallthrough]];
    case SettingType::Number:
      limit(s.range.min, s.range.excludesMin, -0.001);
      limit(s.range.max, s.range.excludesMax, 0.001);
      values.push_back({"0.25", true});
      for (const char* text : {"nan", "inf", "1e300", "much", "", "1 2"})
        values.push_back({text, false});
      break;
    case SettingType::Numbers:
      limit(s.range.min, s.range.excludesMin, -0.001);
      values.push_back({"0.25", true});
      values.push_back({"0.25,0,0.5", true});
      values.push_back({"0,0", std::ranges::count(s.counts, 2) == 1});
      values.push_back({"0,0,0,1", std::ranges::count(s.counts, 4) == 1});
      for (const char* text : {"0,0,0,0,0", "0,0,nan", "1e300", "0,,0", "0,0,", "", "1 2"})
        values.push_back({text, false});
      break;
    case SettingType::Choice:
    case SettingType::Choices:
      for (const std::string_view name : s.choices) values.push_back({std::string(name), true});
      values.push_back({"nonsense", false});
      break;
    case SettingType::Size:
      values = {{"1x1", true},  {"800x600", true}, {"0x9", false},     {"9x-1", false},
                {"800", false}, {"8by6", false},   {"65537x1", false}, {"8x6x", false}};
      break;
    case SettingType::Flag:
      values = {{"true", true}, {"false", true}, {"perhaps", false}};
      break;
    default:
      values = {{"something", true}};
  }
  return values;
}

TEST(Settings, EveryRowIsComplete) {
  std::set<std::string> names, options;
  for (const Setting& s : settingTable()) {
    SCOPED_TRACE(s.name());
    EXPECT_TRUE(names.insert(s.name()).second) << "two rows have this name";
    if (!s.option.empty()) {
      EXPECT_TRUE(options.insert(std::string(s.option)).second);
    }
    EXPECT_TRUE(s.help.ends_with('.'));
    EXPECT_EQ(s.section.empty(), s.key.empty());
    EXPECT_FALSE(s.key.empty() && s.option.empty());
    const bool isNumbers = s.type == SettingType::Numbers;
    EXPECT_EQ(s.type == SettingType::Compound || isNumbers, !s.form.empty());
    EXPECT_EQ(isNumbers, !s.counts.empty());
    if (s.type == SettingType::Choice || s.type == SettingType::Choices) {
      EXPECT_FALSE(s.choices.empty());
    }
    if (!s.option.empty() && s.type != SettingType::Flag) {
      EXPECT_FALSE(s.argument.empty());
    }
    if (s.type != SettingType::Flag) {
      EXPECT_NE(s.fallback.empty(), s.absent.empty());
    }
    bool hasSection = false;
    for (const SettingSection& section : settingSections()) hasSection |= section.name == s.section;
    EXPECT_TRUE(hasSection);
    if (!s.fallback.empty()) {
      EXPECT_EQ(toText(parseSetting(s, {s.fallback}, "")), s.fallback);
    }
  }
}

TEST(Settings, EveryOptionAcceptsExactlyItsRange) {
  for (const Setting* s : scalars())
    for (const auto& [text, valid] : valuesOf(*s)) {
      try {
        const SettingValue value = parseSetting(*s, {text}, "--it");
        EXPECT_TRUE(valid) << s->name() << " took `" << text << "`";
        if (s->type != SettingType::Factor) {
          EXPECT_EQ(toText(value), text) << s->name();
        }
      } catch (const InputError& error) {
        EXPECT_FALSE(valid) << error.what();
        EXPECT_TRUE(std::string(error.what()).starts_with("--it: ")) << error.what();
      }
    }
}

class SettingsInAFile : public testing::Test {
 protected:
  SettingsInAFile() {
    for (const char* name : {"ball.glb", "sky.exr"}) std::ofstream(folder_ / name) << "x";
    std::ofstream(folder_ / "something")  // also a camera's file
        << "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
  }

  // The error message, or "" without an error.
  std::string errorOf(const std::string& toml) const {
    std::ofstream(path_) << toml;
    try {
      readSceneFile(path_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  // A scene file whose only possible error is `value`, on the last line.
  static std::string sceneWith(const Setting& s, const std::string& value) {
    const std::string key = fmt::format("{} = {}\n", s.key, value);
    const bool isModel = s.section == "model";
    std::string toml = isModel ? "[[model]]\n" : "model = 'ball.glb'\n";
    if (isModel && s.key != "file") toml += "file = 'ball.glb'\n";
    if (isModel) return toml + key;
    const bool isOneOfMany = s.section == "light" || s.section == "source";
    toml +=
        fmt::format("{0}{1}{2}\n", isOneOfMany ? "[[" : "[", s.section, isOneOfMany ? "]]" : "]");
    const auto add = [&](const char* other, const char* line) {
      if (s.key != other) toml += fmt::format("{} = {}\n", other, line);
    };
    const bool isAlone =
        s.key == "name" || s.key == "file" || s.key == "view" || s.key == "look_at_node";
    if (s.section == "camera" && !isAlone) {
      add("position", "[0, 0, 5]"), add("look_at", "[0, 0, 0]");
      if (s.key == "aperture" || s.key == "focus") add("aperture", "1"), add("focus", "1");
    }
    const bool sun = s.key == "irradiance" || s.key == "angle" || s.key == "visible";
    if (s.section == "light" && sun) {
      add("direction", "[0, 1, 0]"), add("irradiance", "1");
    } else if (s.section == "light" && s.key == "rotation") {
      add("file", "'lights.json'");
    } else if (s.section == "light" && s.key != "file") {
      const bool spot = s.key.ends_with("_angle"), disc = s.key == "radius" || s.key == "radiance";
      add("type", spot ? "'spot'" : disc || s.key == "direction" ? "'disc'" : "'point'");
      add("position", "[0, 1, 0]");
      if (spot || disc) add("direction", "[0, -1, 0]");
      if (disc || s.key == "direction") add("radius", "1");
      if (!disc && s.key != "intensity" && s.key != "direction") add("power", "1");
      if (s.key == "radius" || s.key == "direction") add("power", "1");
    }
    if (s.section == "source" && s.key != "file") add("probe_polygon", "[[0, 0], [1, 0], [0, 1]]");
    if (s.section == "composite") add("plate", "'sky.exr'"), add("local_scene", "'ground'");
    if (s.section == "composite" && s.key.starts_with("ground_")) add("ground", "true");
    if (s.section == "surroundings") {
      const bool sphere = s.key == "radius" || s.key == "center", room = s.key == "file";
      add("shape", sphere ? "'sphere'" : room ? "'model'" : "'box'");
      if (sphere) add("center", "[0, 0, 0]"), add("radius", "1");
      if (room) add("capture", "[0, 0, 0]");
      if (!sphere && !room) add("min", "[-1, -1, -1]"), add("max", "[1, 1, 1]");
    }
    return toml + key;
  }

  TemporaryFolder folder_;
  const std::string path_ = folder_ / "scene.toml";
};

std::string asToml(const Setting& s, const std::string& text) {
  switch (s.type) {
    case SettingType::Size:
      return text == "1x1" ? "[1, 1]" : text == "800x600" ? "[800, 600]" : "'" + text + "'";
    case SettingType::Numbers:
      if (text.find(',') != std::string::npos && text.find(",,") == std::string::npos &&
          !text.ends_with(','))
        return '[' + text + ']';
      [[fallthrough]];
    case SettingType::Flag:
      if (text == "true" || text == "false") return text;
      [[fallthrough]];
    case SettingType::Integer:
    case SettingType::Number:
    case SettingType::Factor:
      if (!text.empty() && text.find_first_not_of("0123456789.-+einfa") == std::string::npos &&
          text.find("ff") == std::string::npos)
        return text;
      [[fallthrough]];
    default:
      return "'" + text + "'";
  }
}

TEST_F(SettingsInAFile, EveryKeyAcceptsExactlyItsRange) {
  for (const Setting* s : scalars()) {
    if (s->key.empty() || s->key == "shape" || (s->section == "light" && s->key == "type"))
      continue;
    for (const auto& [text, valid] : valuesOf(*s)) {
      const std::string toml = sceneWith(*s, asToml(*s, text)), error = errorOf(toml);
      EXPECT_EQ(error.empty(), valid) << s->name() << " with " << text << ": " << error << toml;
    }
  }
}

TEST_F(SettingsInAFile, WrongTypesNameLineAndKey) {
  for (const Setting& s : settingTable()) {
    if (s.key.empty()) continue;
    const std::string toml = sceneWith(s, "1979-05-27");
    const auto line = std::count(toml.begin(), toml.end(), '\n');
    const std::string error = errorOf(toml);
    EXPECT_TRUE(error.starts_with(fmt::format("{}:{}: `{}` must be ", path_, line, s.key)))
        << s.name() << ": " << error;
  }
}

TEST_F(SettingsInAFile, CompoundsAcceptTheirRange) {
  for (const Setting& s : settingTable()) {
    const bool isNumber = s.form.starts_with("a number");
    if (s.type != SettingType::Compound || !isNumber || !std::isfinite(s.range.min)) continue;
    { EXPECT_EQ(errorOf(sceneWith(s, "0.5")), "") << s.name(); }
    EXPECT_NE(errorOf(sceneWith(s, decimal(s.range.min - 0.5))), "") << s.name();
    if (s.range.excludesMin) {
      EXPECT_NE(errorOf(sceneWith(s, decimal(s.range.min))), "") << s.name();
    }
    if (std::isfinite(s.range.max)) {
      EXPECT_NE(errorOf(sceneWith(s, decimal(s.range.max + 0.5))), "") << s.name();
    }
  }
}

TEST_F(SettingsInAFile, OptionsOverrideTheFileAndTheFileOverridesDefaults) {
  std::ofstream(path_)
      << "model = 'ball.glb'\n[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n"
         "[render]\nsamples = 5\nnoise = 2\nmax_depth = 3\nseed = 9\n";
  const RenderDescription byFile = planRender(openScene(path_));
  EXPECT_EQ(byFile.settings.samples, 5u);
  EXPECT_EQ(byFile.settings.noiseLimit, 0.02);
  EXPECT_TRUE(byFile.camera.placed);
  EXPECT_EQ(byFile.origins.of("render.seed"), path_ + ":9");

  Settings over;
  over.set("render.seed", uint64_t(7));
  over.parse("render.time", "1.5");
  over.set("camera.name", std::string("Front"), "--camera");
  const RenderDescription description = planRender(openScene(path_), over);
  EXPECT_EQ(description.settings.seed, 7u);
  EXPECT_EQ(description.settings.maxDepth, 3);
  EXPECT_EQ(description.settings.timeLimit, 1.5);
  EXPECT_FALSE(description.settings.noiseLimit) << "--time replaces the limits of the file";
  EXPECT_EQ(description.settings.samples, kMaxSamples);
  EXPECT_FALSE(description.camera.placed);
}

TEST_F(SettingsInAFile, ViewsHaveNames) {
  const std::pair<const char*, std::vector<double>> kViews[] = {
      {"front", {0, 0}},  {"back", {180, 0}}, {"left", {-90, 0}},  {"right", {90, 0}},
      {"above", {0, 90}}, {"top", {0, 90}},   {"below", {0, -90}}, {"bottom", {0, -90}}};
  const Setting& view = settingNamed("camera.view");
  for (const auto& [name, angles] : kViews) {
    EXPECT_EQ(std::get<std::vector<double>>(parseSetting(view, {name}, "")), angles) << name;
    std::ofstream(path_) << sceneWith(view, fmt::format("'{}'", name));
    EXPECT_EQ(readSceneFile(path_).settings.get<std::vector<double>>("camera.view"), angles);
    toml::table keywords;
    keywords.insert("view", name);
    EXPECT_EQ(keywordSettings(keywords, "render()").get<std::vector<double>>("camera.view"),
              angles);
  }
  EXPECT_NE(errorOf(sceneWith(view, "'topp'")).find("must be one angle, two or three, or front"),
            std::string::npos);
  EXPECT_EQ(numbersCalled(settingNamed("probe.rotation"), "front"), nullptr);
}

// An option of the command that is no setting was looked for in the table, and read from its end.
TEST(Settings, WordsOfOthersNameSettingsOrOptions) {
  EXPECT_EQ(settingCalled("--spp"), &settingNamed("render.samples"));
  EXPECT_EQ(settingCalled("--verbose"), nullptr);
  EXPECT_EQ(optionCalled("--verbose"), "progress");
  EXPECT_EQ(optionCalled("--spp"), "");
}

TEST(Settings, DefaultsEqualThoseOfRenderSettings) {
  SceneFile scene;
  scene.models.push_back({"a.glb", {}, {}});
  const RenderSettings planned = planRender(scene).settings, defaults;
  EXPECT_EQ(planned.samples, defaults.samples);
  EXPECT_EQ(planned.maxDepth, defaults.maxDepth);
  EXPECT_EQ(planned.maxTransmissionDepth, defaults.maxTransmissionDepth);
  EXPECT_EQ(planned.seed, defaults.seed);
  EXPECT_EQ(planned.mis, defaults.mis);
  EXPECT_EQ(planned.hideProbe, defaults.hideProbe);
  EXPECT_EQ(planned.clamp, defaults.clamp);
  EXPECT_TRUE(planned.aovs.empty());
}

TEST(Settings, MisuseByProgramsThrows) {
  Settings settings;
  EXPECT_THROW(settings.has("render.sampels"), std::logic_error);
  EXPECT_THROW(settings.get<double>("render.samples"), std::logic_error);
  EXPECT_THROW(settings.get<std::string>("probe.file"), std::logic_error) << "it has no default";
  EXPECT_THROW(settings.set("render.samples", uint64_t(0)), InputError);
  EXPECT_THROW(settings.set("render.samples", 1.0), InputError);
  EXPECT_THROW(settings.parse("lighting.mis", "powr"), InputError);
}

TEST(Settings, EveryMappingNameIsParsed) {
  for (const std::string_view name : settingNamed("probe.mapping").choices) {
    const ImageSize size = name == "cube-strip"   ? ImageSize{6, 1}
                           : name == "cube-cross" ? ImageSize{4, 3}
                           : name == "cube-3x2"   ? ImageSize{3, 2}
                           : name == "lat-long"   ? ImageSize{4, 2}
                                                  : ImageSize{4, 4};
    EXPECT_EQ(parseMapping(name, size.width, size.height, "").has_value(), name != "auto") << name;
  }
}

TEST(Settings, TheReferencePageIsUpToDate) {
  EXPECT_EQ(fileContents(std::string(kSourceDir) + "/docs/scene-file.md"), settingsPage())
      << "run: build/chromeball reference > docs/scene-file.md";
}

TEST(CommandSettings, HelpShowsEveryOptionWithItsDefaultAndNames) {
  std::string help = runCommand({"render", "--help", "all"}).out;
  const auto isSpace = [](char a, char b) { return a == ' ' && b == ' '; };
  std::replace(help.begin(), help.end(), '\n', ' ');
  help.erase(std::unique(help.begin(), help.end(), isSpace), help.end());
  for (const Setting& s : settingTable()) {
    if (s.option.empty()) continue;
    const std::string argument =
        s.bare.empty() ? std::string(s.argument) : fmt::format("[={}]", s.argument);
    EXPECT_NE(help.find(fmt::format("--{} {}", s.option, argument)), std::string::npos) << s.option;
    EXPECT_NE(help.find(s.help), std::string::npos) << s.option;
    if (s.type != SettingType::Flag) {
      EXPECT_NE(help.find(fmt::format("(default: {})", defaultText(s))), std::string::npos)
          << s.option;
    }
    if (!s.choices.empty()) {
      EXPECT_NE(help.find(fmt::format("{}", fmt::join(s.choices, ", "))), std::string::npos)
          << s.option;
    }
  }
}

}  // namespace
}  // namespace chromeball::settings_test
