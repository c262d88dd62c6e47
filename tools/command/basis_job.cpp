// SPDX-License-Identifier: Apache-2.0
#include "basis_job.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"

namespace chromeball {

RenderDescription basisJob(const SceneOptions& options, SceneCommand command) {
  const char* what = command == SceneCommand::Basis ? "light stage" : "transfer";
  SceneFile scene = openScene(options.scene);
  if (scene.composite)
    throwInput("{}: a composite has no {}; take its model", scene.origins.of("composite.entry"),
               what);
  if (scene.surroundings)
    throwInput("{}: [surroundings] are not at infinity, as the light of a {} is", scene.path, what);
  // Without the probe, and suns of their own, no part of the light is left to choose.
  if (const auto from = scene.settings.find("lighting.from");
      from &&
      std::ranges::none_of(scene.lamps, [](const Lamp& lamp) { return lamp.sun.has_value(); })) {
    scene.warnings.push_back(
        fmt::format("{}: lighting.from has no effect on a {} without suns of the scene file",
                    from->location, what));
    scene.settings.erase("lighting.from");
  }
  for (const char* name : {"probe.file", "probe.mapping", "probe.rotation", "probe.scale"})
    scene.settings.erase(name);
  dropUnheeded(scene, command);
  scene.sources.clear();
  scene.probeTurns.clear();
  scene.lamps.push_back({.ambient = AmbientLamp{}});  // black: no scene needs a light of its own
  RenderDescription description = planRender(std::move(scene), options.settings);
  description.settings.crop.reset();
  return description;
}

LoadedScene loadBasisScene(const RenderDescription& description) {
  LoadedScene loaded = loadScene(description);
  std::erase_if(loaded.scene.ambient, [](const auto& lamp) { return isBlack(lamp.radiance); });
  return loaded;
}

}  // namespace chromeball
