// SPDX-License-Identifier: Apache-2.0
// chromeball render: renders a scene to image files.
#include <atomic>
#include <csignal>
#include <filesystem>

#include "base/error.h"
#include "base/stopwatch.h"
#include "commands.h"
#include "image_noise_text.h"
#include "job/checkpoint.h"
#include "job/job.h"
#include "job/job_description.h"
#include "job/job_outputs.h"
#include "job/job_report.h"
#include "job/output_file.h"
#include "lighting/methods.h"
#include "messages.h"
#include "progress_bar.h"
#include "render_hints.h"
#include "scene_options.h"
#include "thread_limit.h"

namespace chromeball {
namespace {

std::atomic<bool> interrupted = false;

// An image without samples in some pixels must not overwrite one that may be complete.
void nameAsPartial(std::vector<std::string>& outputs) {
  for (std::string& output : outputs) {
    std::filesystem::path path = output;
    path.replace_extension(".partial" + path.extension().string());
    output = path.string();
  }
}

std::string guidedInWords(const RenderResult& render) {
  const bool lights = render.guidedRegions > 0, bounces = render.causticFraction > 0;
  if (!lights && !bounces) return "";
  return fmt::format(", {} guided,", !bounces  ? "light samples"
                                     : !lights ? "bounces"
                                               : "light samples and bounces");
}

void printOutcome(const RenderJob& job, const JobResult& result, bool quiet) {
  const RenderResult& render = result.render;
  if (render.interrupted && render.samples == 0)
    throw Interrupted(fmt::format("interrupted before every pixel had a sample; saved as {}",
                                  fmt::join(job.outputs, ", ")));
  const auto checkpoint = job.file.settings.getIfGiven<std::string>("checkpoint");
  if (render.interrupted)
    throw Interrupted(fmt::format("interrupted; the image so far is saved{}{}",
                                  job.settings.denoise ? ", not denoised" : "",
                                  checkpoint && std::filesystem::exists(*checkpoint)
                                      ? fmt::format("; --resume goes on from {}", *checkpoint)
                                      : ""));
  if (!quiet)
    fmt::print("{} samples per pixel{} in {:.2f} s, noise {}{}: {}\n", render.samples,
               guidedInWords(render), result.seconds, inWords(result.noise),
               inWords(result.denoised), fmt::join(job.outputs, ", "));
}

void render(const SceneOptions& options) {
  RenderJob job = planJob(openScene(options.scene), options.settings);
  const Messages outputMessages = checkOutputs(job);
  const ThreadLimit threads(options.settings);

  Stopwatch watch;
  PhaseSeconds seconds;
  const LoadedScene loaded = loadScene(job);
  seconds.load = watch.lap();
  const PreparedScene prepared = prepareScene(job, loaded);
  seconds.build = prepared.buildSeconds;
  seconds.prepare = prepared.prepareSeconds;
  prepareOutputs(job, loaded.files);
  JobControl control(job, loaded);
  RenderPart part;
  if (job.settings.isPart()) part.identity = renderIdentity(job, loaded);  // of the files loaded
  print(outputMessages, options.quiet());  // after the last error that input can cause
  print(loaded.messages, options.quiet());

  std::signal(SIGINT, [](int) { interrupted = true; });
  std::signal(SIGTERM, [](int) { interrupted = true; });
  JobResult result = [&] {
    ProgressBar bar(options.showsProgress());
    return renderJob(
        job, loaded, prepared, [&](double fraction) { bar.update(fraction); }, interrupted,
        job.composite && job.composite->passes == Passes::Two ? nullptr : &control);
  }();
  seconds.render = result.seconds;

  watch.lap();
  result.image.metadata = imageMetadata(job, loaded, result, result.render, result.seconds);
  if (job.settings.isPart()) {
    part.plan = finishPlan(job, loaded);
    result.image.state = partState(part, result.render);
  }
  if (result.render.samples == 0) nameAsPartial(job.outputs);
  for (const std::string& path : job.outputs) writeImage(path, result.image, job.display);
  seconds.write = watch.lap();
  if (const auto stats = options.settings.getIfGiven<std::string>("stats"))
    writeText(*stats, statistics(job, loaded, result, seconds).dump(2) + "\n");

  print(resultMessages(job, loaded, prepared, result), options.quiet());
  printOutcome(job, result, options.quiet());
}

}  // namespace

void addRenderCommand(CLI::App& app) {
  const auto options = std::make_shared<SceneOptions>();
  CLI::App* command = app.add_subcommand("render", "Render a scene file or a model to an image");
  addSceneOptions(*command, *options, SceneCommand::Render);
  command->footer(strategyHelp());
  command->callback([options] { render(*options); });
}

}  // namespace chromeball
