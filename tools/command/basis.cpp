// SPDX-License-Identifier: Apache-2.0
// chromeball basis SCENE --directions lat-long:32x16 -o STAGE.exr: a light stage of a scene.
// chromeball basis MODEL --at vertices --basis sh:4 -o MODEL_PRT.glb: transfer at its vertices.
// Both for `chromeball relight`.
#include "basis.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "commands.h"
#include "scene_options.h"

namespace chromeball {
namespace {

void run(const BasisArguments& a) {
  if (!a.isGlossy && (a.clusters || a.vectors)) throwInput("--clusters, --vectors: need --glossy");
  if (a.at == "pixels") {
    if (!a.functions.empty()) throwInput("--basis: needs --at vertices; see --directions");
    if (a.isGlossy) throwInput("--glossy: needs --at vertices");
    return runBasisPixels(a);
  }
  if (a.at != "vertices") throwInput("--at: `{}` is not pixels or vertices", a.at);
  if (!a.directions.empty())
    throwInput("--directions: has no effect with --at vertices; see --basis");
  if (a.halves) throwInput("--half: has no effect with --at vertices; leave it out");
  runBasisVertices(a);
}

}  // namespace

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

void addBasisCommand(Command app) {
  auto [command, a] =
      app.addCommand<BasisArguments>("basis",
                                     "Render a light stage, a scene under light from each of many "
                                     "directions; or the same at a model's vertices",
                                     run);
  addSceneOptions(command, a, SceneCommand::Basis);
  command.addWithDefault("--at", a.at, "pixels, or vertices: precomputed radiance transfer");
  command.addOption("--directions", a.directions,
                    "of pixels: lat-long:WxH or cube:N (boxes of a map), icosphere:SUBDIVISIONS "
                    "(triangles), sh:ORDER (spherical harmonics); else lat-long:32x16");
  command.addOption("--basis", a.functions,
                    "of vertices: sh:ORDER (spherical harmonics) or haar:N (wavelets on a cube of "
                    "N x N cells a face); else sh:4");
  command.addFlag(
      "--glossy", a.isGlossy,
      "of vertices: matrices for surfaces that look different from each side; compressed");
  command.addOption("--clusters", a.clusters, "of matrices with principal components: 16")
      .inRange(1, 1024);
  command.addOption("--vectors", a.vectors, "of each cluster: 8").inRange(0, 256);
  command.addFlag("--half", a.halves,
                  "write 16 bits per number: half the file, to 0.05% from 6e-5 to 65504");
  command.addRequired("-o,--output", a.out,
                      "the light stage to write, .exr; of vertices the model, .glb or .gltf");
}

}  // namespace chromeball
