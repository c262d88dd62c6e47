// SPDX-License-Identifier: Apache-2.0
// chromeball basis SCENE --directions lat-long:32x16 -o STAGE.exr: a light stage of a scene.
// chromeball basis MODEL --at vertices --basis sh:4 -o MODEL_PRT.glb: transfer at its vertices.
// Both for `chromeball relight`.
#include "base/error.h"
#include "base/stopwatch.h"
#include "basis_job.h"
#include "basis_vertices.h"
#include "commands.h"
#include "image/io/write_image.h"
#include "job/job.h"
#include "job/memory_estimate.h"
#include "job/output_file.h"
#include "messages.h"
#include "progress_bar.h"
#include "relight/render_basis.h"
#include "scene_options.h"
#include "thread_limit.h"

namespace chromeball {
namespace {

struct Arguments : SceneOptions {
  std::string at = "pixels", out;
  std::string directions, functions;  // at pixels; at vertices
  bool halves = false, isGlossy = false;
  std::optional<uint64_t> clusters, vectors;
};

void checkStageMemory(const RenderJob& job, const LoadedScene& loaded,
                      const DirectionBasis& basis) {
  const RenderSettings& s = job.settings;
  checkStageSize(basis, s.width, s.height, "--directions");
  const double elements = 3. * sizeof(float) * basis.size() * s.width * s.height;
  const double needed = elements + estimateMemory(job, loaded).peak;
  if (needed > memoryLimit(job))
    throw InputError(fmt::format("--directions: {} elements of {} x {} pixels take {:.3g} GB of "
                                 "memory, with all else {:.3g} GB; the limit is {:.3g} GB",
                                 basis.size(), s.width, s.height, 1e-9 * elements, 1e-9 * needed,
                                 1e-9 * memoryLimit(job)),
                     Remedy{"memory", {}});
}

Metadata metadataOf(const Arguments& a, const RenderJob& job) {
  return {{"Software", std::string("chromeball " CHROMEBALL_VERSION)},
          {"scene", a.scene},
          {"samples", int(job.settings.samples)},
          {"seed", std::to_string(job.settings.seed)},
          {"max_depth", job.settings.maxDepth}};
}

void runPixels(const Arguments& a) {
  const Stopwatch watch;
  const DirectionBasis basis(a.directions.empty() ? "lat-long:32x16" : a.directions,
                             "--directions");
  checkOutputFile(a.out, {".exr"});
  const ThreadLimit threads(a.settings);
  RenderJob job = basisJob(a, "light stage");
  const LoadedScene loaded = loadBasisScene(job);
  checkDistinct({a.out}, loaded.files);
  checkStageMemory(job, loaded, basis);
  const World world(loaded.scene, {}, BsdfTables(loaded.scene.materials, false));
  print(loaded.messages, a.quiet());  // after the last error that input can cause
  ProgressBar bar(a.showsProgress());
  const BasisRender render = renderBasis(world, loaded.camera, basis, job.settings,
                                         [&](double fraction) { bar.update(fraction); });
  loaded.scene.checkTexels();
  if (render.invalid.total() > 0)
    warn(fmt::format("{} invalid samples were left out; the first is in pixel {}, {}",
                     render.invalid.total(), render.invalid.x, render.invalid.y));
  writeStage(a.out, render.stage, render.color, metadataOf(a, job), a.halves);
  if (!a.quiet())
    fmt::print("{} x {} pixels, {} samples, {} elements ({}){} in {:.2f} s: {}\n",
               render.color.width, render.color.height, job.settings.samples, basis.size(),
               basis.name(), render.stage.own.empty() ? "" : " and the scene's own light",
               watch.seconds(), a.out);
}

void run(const Arguments& a) {
  if (!a.isGlossy && (a.clusters || a.vectors)) throwInput("--clusters, --vectors: need --glossy");
  if (a.at == "pixels") {
    if (!a.functions.empty()) throwInput("--basis: needs --at vertices; see --directions");
    if (a.isGlossy) throwInput("--glossy: needs --at vertices");
    return runPixels(a);
  }
  if (a.at != "vertices") throwInput("--at: `{}` is not pixels or vertices", a.at);
  if (!a.directions.empty())
    throwInput("--directions: has no effect with --at vertices; see --basis");
  if (a.halves) throwInput("--half: has no effect with --at vertices; leave it out");
  runBasisVertices(a, {a.functions.empty() ? "sh:4" : a.functions, a.out, a.isGlossy,
                       a.clusters.value_or(16), a.vectors.value_or(8)});
}

}  // namespace

void addBasisCommand(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "basis",
      "Render a light stage, a scene under light from each of many directions; or the same "
      "at a model's vertices");
  addSceneOptions(*command, *arguments, SceneCommand::Basis);
  command->add_option("--at", arguments->at, "pixels, or vertices: precomputed radiance transfer")
      ->capture_default_str();
  command->add_option("--directions", arguments->directions,
                      "of pixels: lat-long:WxH or cube:N (boxes of a map), icosphere:SUBDIVISIONS "
                      "(triangles), sh:ORDER (spherical harmonics); else lat-long:32x16");
  command->add_option("--basis", arguments->functions,
                      "of vertices: sh:ORDER (spherical harmonics) or haar:N (wavelets on a cube "
                      "of N x N cells a face); else sh:4");
  command->add_flag("--glossy", arguments->isGlossy,
                    "of vertices: matrices for surfaces that look different from each side; "
                    "compressed");
  command
      ->add_option("--clusters", arguments->clusters, "of matrices with principal components: 16")
      ->check(CLI::Range(1, 1024));
  command->add_option("--vectors", arguments->vectors, "of each cluster: 8")
      ->check(CLI::Range(0, 256));
  command->add_flag("--half", arguments->halves,
                    "write 16 bits per number: half the file, to 0.05%");
  command
      ->add_option("-o,--output", arguments->out,
                   "the light stage to write, .exr; of vertices the model, .glb or .gltf")
      ->required();
  command->callback([arguments] { run(*arguments); });
}

}  // namespace chromeball
