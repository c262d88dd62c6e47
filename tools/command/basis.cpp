// SPDX-License-Identifier: Apache-2.0
// chromeball basis SCENE --directions lat-long:32x16 -o STAGE.exr: a light stage of a scene, for
// `chromeball relight`.
#include "base/error.h"
#include "base/stopwatch.h"
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
  std::string directions = "lat-long:32x16", out;
  bool halves = false;
};

// The light comes from everywhere, in place of the scene's probe.
RenderJob plannedJob(const Arguments& a) {
  SceneFile scene = openScene(a.scene);
  if (scene.composite)
    throwInput("{}: a composite has no light stage; take its model", scene.composite->location);
  if (scene.surroundings)
    throwInput("{}: [surroundings] are not at infinity, as the light of a light stage is",
               scene.path);
  for (const char* name : {"probe.file", "probe.mapping", "probe.rotation", "probe.scale"})
    scene.settings.erase(name);
  scene.sources.clear();
  scene.probeTurns.clear();
  scene.lamps.push_back({.ambient = AmbientLamp{}});  // black: no scene needs a light of its own
  RenderJob job = planJob(std::move(scene), a.settings);
  job.settings.crop.reset();
  return job;
}

LoadedScene loadedScene(RenderJob& job) {
  LoadedScene loaded = loadScene(job);
  std::erase_if(loaded.scene.ambient, [](const auto& lamp) { return isBlack(lamp.radiance); });
  return loaded;
}

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

void run(const Arguments& a) {
  const Stopwatch watch;
  const DirectionBasis basis(a.directions, "--directions");
  checkOutputFile(a.out, {".exr"});
  const ThreadLimit threads(a.settings);
  RenderJob job = plannedJob(a);
  const LoadedScene loaded = loadedScene(job);
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

}  // namespace

void addBasisCommand(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "basis", "Render a light stage: a scene under light from each of many directions");
  addSceneOptions(*command, *arguments, SceneCommand::Basis);
  command
      ->add_option("--directions", arguments->directions,
                   "lat-long:WxH or cube:N (boxes of a map), icosphere:SUBDIVISIONS (triangles), "
                   "sh:ORDER (spherical harmonics)")
      ->capture_default_str();
  command->add_flag("--half", arguments->halves,
                    "write 16 bits per number: half the file, to 0.05%");
  command->add_option("-o,--output", arguments->out, "the light stage to write, .exr")->required();
  command->callback([arguments] { run(*arguments); });
}

}  // namespace chromeball
