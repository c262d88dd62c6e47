// SPDX-License-Identifier: Apache-2.0
#include "front/settings.h"

#include <fmt/format.h>

#include <cmath>

#include "description/capabilities.h"
#include "lighting/methods.h"

namespace chromeball {
namespace {

constexpr std::string_view kIntroduction =
    R"(# The scene file

A scene file (TOML) describes an image: models, camera, light probe, lamps and settings.
`chromeball render SCENE.toml` renders it; the options of the command line override its settings.

    model = "models/still-life.glb"

    [camera]
    name = "Front"

    [probe]
    file = "../probes/dusk.exr"
    rotation = 30

    [[light]]
    type = "disc"
    position = [0, 3, 0]
    direction = [0, -1, 0]
    radius = 0.3
    radiance = [30, 28, 25]

    [render]
    size = [960, 640]
    samples = 128

    [output]
    file = ["../out/demo.exr", "../out/demo.png"]
    aovs = ["albedo", "normal", "depth"]

Paths are relative to the scene file. An unknown key, a wrong type, a value out of range or a missing
file is an error that names the line, and suggests the nearest known key.

`chromeball reference` prints this page, from the program's own table of settings.
)";

std::string rangeText(const Setting& s) {
  if (!s.choices.empty()) return fmt::format("`{}`", fmt::join(s.choices, "`, `"));
  const Range& r = s.range;
  const bool hasMin = std::isfinite(r.min), hasMax = std::isfinite(r.max);
  if (hasMin && hasMax)
    return fmt::format("{:.10g} {} {:.10g}", r.min,
                       r.excludesMin ? (r.excludesMax ? "< x <" : "< x <=") : "to", r.max);
  if (hasMin) return fmt::format("{} {:.10g}", r.excludesMin ? ">" : ">=", r.min);
  return "";
}

std::string optionText(const Setting& s) {
  if (s.option.empty()) return "";
  const std::string letter = s.letter ? fmt::format("`-{}`, ", s.letter) : "";
  const std::string argument = !s.bare.empty()      ? fmt::format("[={}]", s.argument)
                               : s.argument.empty() ? ""
                                                    : fmt::format(" {}", s.argument);
  return fmt::format("{}`--{}{}`", letter, s.option, argument);
}

std::string row(const Setting& s, bool hasKey) {
  const std::string_view form = infoOf(s.type).form;
  std::string cells;
  if (hasKey) cells = fmt::format("| `{}` ", s.key);
  const std::string option = hasKey ? "" : fmt::format("| {} ", optionText(s));
  cells += fmt::format("{}| {} | {} | {} | {} |", option, form.empty() ? s.form : form,
                       rangeText(s), s.unit, defaultText(s));
  if (hasKey) cells += fmt::format(" {} |", optionText(s));
  return fmt::format("{} {} |\n", cells, s.help);
}

}  // namespace

std::string defaultText(const Setting& s) {
  if (!s.fallback.empty()) return s.fallback;
  return s.type == SettingType::Flag ? "off" : std::string(s.absent);
}

std::string settingsPage() {
  std::string page(kIntroduction);
  for (const SettingSection& section : settingSections()) {
    const bool hasKeys = !section.name.empty();
    page +=
        fmt::format("\n## {}\n\n{}\n\n",
                    hasKeys ? fmt::format("`{}`", section.heading) : std::string(section.heading),
                    section.about);
    page += hasKeys ? "| Key | Type | Range | Unit | Default | Option | Meaning |\n| --- | --- | "
                      "--- | --- | --- | --- | --- |\n"
                    : "| Option | Type | Range | Unit | Default | Meaning |\n| --- | --- | --- | "
                      "--- | --- | --- |\n";
    for (const Setting& setting : settingTable())
      if (setting.section == section.name) page += row(setting, hasKeys);
  }
  page += "\n## Lighting strategies\n\nSee [methods](methods.md#lighting-strategies).\n\n" +
          strategyTable();
  page +=
      "\n## What does not go together\n\nOther pairs of these features may be combined. Settings "
      "that contradict each other (`--frames` and `--animation-time`, reflectance \"flat\" and "
      "lamps) are refused with the reason.\n\n| This | and | |\n| --- | --- | --- |\n";
  for (const Conflict& conflict : conflicts())
    page +=
        fmt::format("| {} | {} | {} |\n", conflict.feature.name, conflict.with.name, conflict.why);
  page +=
      "\n## What has no effect alone\n\nA warning names a setting that is given in vain.\n\n| "
      "Setting | has no effect without |\n| --- | --- |\n";
  for (const Dependence& dependence : dependences())
    page += fmt::format("| `{}` | {} |\n", dependence.setting, dependence.needs);
  return page;
}

}  // namespace chromeball
