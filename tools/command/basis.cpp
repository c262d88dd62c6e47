// SPDX-License-Identifier: Apache-2.0
// chromeball basis SCENE --directions lat-long:32x16 -o STAGE.exr: a light stage of a scene.
// chromeball basis MODEL --at vertices --basis sh:4 -o MODEL_PRT.glb: transfer at its vertices.
// Both for `chromeball relight`.
#include "base/error.h"
#include "basis_pixels.h"
#include "basis_vertices.h"
#include "commands.h"
#include "scene_options.h"

namespace chromeball {
namespace {

struct BasisArguments : SceneOptions {
  std::string at = "pixels", out;
  std::string directions, functions;  // at pixels; at vertices
  bool halves = false, isGlossy = false;
  std::optional<uint64_t> clusters, vectors;
};

void run(const BasisArguments& a) {
  if (!a.isGlossy && (a.clusters || a.vectors)) throwInput("--clusters, --vectors: need --glossy");
  if (a.at == "pixels") {
    if (!a.functions.empty()) throwInput("--basis: needs --at vertices; see --directions");
    if (a.isGlossy) throwInput("--glossy: needs --at vertices");
    return runBasisPixels(
        a, {a.directions.empty() ? "lat-long:32x16" : a.directions, a.out, a.halves});
  }
  if (a.at != "vertices") throwInput("--at: `{}` is not pixels or vertices", a.at);
  if (!a.directions.empty())
    throwInput("--directions: has no effect with --at vertices; see --basis");
  if (a.halves) throwInput("--half: has no effect with --at vertices; leave it out");
  runBasisVertices(a, {a.functions.empty() ? "sh:4" : a.functions, a.out, a.isGlossy,
                       a.clusters.value_or(16), a.vectors.value_or(8)});
}

}  // namespace

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
