// SPDX-License-Identifier: Apache-2.0
#include "description/describe.h"

#include <algorithm>
#include <array>

#include "base/json.h"

namespace chromeball {
namespace {

// The values that decide the light, and the place and size of the picture, under the names of
// describe(). Changes of these, or of the settings of the integrator, need no new scene, unless the
// models decide the view, and it is another one (session/place_models.h).
constexpr std::array kOfProbe = {"probe", "probe-mapping", "probe-rotation", "probe-scale",
                                 "probe-in-memory"};
constexpr std::array kOfLighting = {"strategy",    "mis",        "sun-angle",
                                    "show-lights", "integrator", "aov"};
constexpr std::array kOfCamera = {"camera", "camera-file", "scene-camera", "lens",
                                  "optics", "orbit",       "zoom",         "size",
                                  "crop",   "fov",         "view",         "look-at"};
constexpr std::array kOfPaths = {"samples-limit",
                                 "noise-limit",
                                 "time-limit",
                                 "shard",
                                 "adaptive",
                                 "guide",
                                 "max-depth",
                                 "max-transmission-depth",
                                 "max-diffuse-depth",
                                 "max-specular-depth",
                                 "ao",
                                 "reflection-occlusion",
                                 "ao-distance",
                                 "bent",
                                 "irradiance-cache",
                                 "seed",
                                 "transparent",
                                 "clamp",
                                 "denoise"};

template <size_t N>
bool has(const std::array<const char*, N>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

template <size_t N>
bool hasAny(const std::array<const char*, N>& names, const std::set<std::string>& of) {
  return std::ranges::any_of(of, [&](const std::string& name) { return has(names, name); });
}

// What describe() leaves out: folders of models, and animations that no setting has chosen. Another
// time of an animation is another frame of the same scene.
bool haveSameModels(const RenderDescription& a, const RenderDescription& b) {
  const auto roomOf = [](const RenderDescription& d) {
    return d.surroundings ? d.surroundings->shape.model : std::string();
  };
  const auto isSame = [](const ModelEntry& m, const ModelEntry& n) {
    const auto &x = m.choice.animation, &y = n.choice.animation;
    return m.file == n.file && x.has_value() == y.has_value() &&
           (!x || (x->name == y->name && x->ifAny == y->ifAny));
  };
  return roomOf(a) == roomOf(b) && std::ranges::equal(a.models, b.models, isSame);
}

}  // namespace

Differences::Differences(const RenderDescription& a, const RenderDescription& b) {
  if (a.scene != b.scene) names_.insert("scene-in-memory");
  if (!haveSameModels(a, b)) names_.insert("models");
  if (a.probe.map != b.probe.map) names_.insert("probe-in-memory");
  const auto fromFiles = [](RenderDescription d) {
    d.scene.reset(), d.probe.map.reset();
    return describe(d);
  };
  const nlohmann::ordered_json was = fromFiles(a), is = fromFiles(b);
  for (const auto* one : {&was, &is})
    for (const auto& [name, ignored] : one->items())
      if (was.value(name, nlohmann::ordered_json()) != is.value(name, nlohmann::ordered_json()))
        names_.insert(name);
}

bool Differences::keepScene() const { return std::ranges::all_of(names_, keepsScene); }

bool Differences::keepsScene(const std::string& name) {
  return has(kOfProbe, name) || has(kOfLighting, name) || has(kOfCamera, name) ||
         has(kOfPaths, name);
}

bool Differences::inProbe() const { return hasAny(kOfProbe, names_); }
bool Differences::inLighting() const { return hasAny(kOfLighting, names_); }

}  // namespace chromeball
