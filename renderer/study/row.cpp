// SPDX-License-Identifier: Apache-2.0
#include "study/row.h"

#include <algorithm>

#include "base/error.h"
#include "lighting/methods.h"

namespace chromeball {
namespace {

struct ModeName {
  Mode mode;
  const char* name;
};
constexpr ModeName kModes[] = {{Mode::Adaptive, "adaptive"},
                               {Mode::Guide, "guide"},
                               {Mode::Regularize, "regularize"},
                               {Mode::GlassShadows, "glass-shadows"},
                               {Mode::Denoise, "denoise"}};

Mode modeNamed(const std::string& name, const std::string& location) {
  std::vector<std::string> known;
  for (const auto& [mode, modeName] : kModes) {
    if (name == modeName) return mode;
    known.push_back(modeName);
  }
  throwInput("{}: `{}` is not a mode; modes are {}", location, name, fmt::join(known, ", "));
}

}  // namespace

bool Row::has(Mode mode) const { return std::ranges::count(modes, mode) > 0; }

bool Row::isBiased() const {
  return has(Mode::Regularize) || has(Mode::GlassShadows) || has(Mode::Denoise);
}

std::string Row::name() const {
  std::string name = strategy;
  for (const auto& [mode, modeName] : kModes)
    if (has(mode)) name += std::string("+") + modeName;
  return name;
}

RenderSettings Row::applied(RenderSettings settings) const {
  settings.adaptive = has(Mode::Adaptive);
  settings.guiding = has(Mode::Guide) ? Guiding::On : Guiding::Off;
  settings.regularize = has(Mode::Regularize);
  settings.denoise = has(Mode::Denoise);
  return settings;
}

Row rowNamed(const std::string& name, const std::string& location) {
  size_t end = name.find('+');
  Row row{resolveStrategy(name.substr(0, end)), {}};
  while (end != std::string::npos) {
    const size_t begin = end + 1;
    end = name.find('+', begin);
    const Mode mode = modeNamed(name.substr(begin, end - begin), location);
    if (!row.has(mode)) row.modes.push_back(mode);
  }
  std::ranges::sort(row.modes);
  return row;
}

}  // namespace chromeball
