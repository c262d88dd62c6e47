// SPDX-License-Identifier: Apache-2.0
// chromeball render: renders a scene to image files.
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "base/error.h"
#include "base/json.h"
#include "base/json_text.h"
#include "base/progress.h"
#include "base/text.h"
#include "commands.h"
#include "front/plan_render.h"
#include "front/sequence.h"
#include "image/io/output_file.h"
#include "interrupt.h"
#include "lighting/methods.h"
#include "messages.h"
#include "noise_in_words.h"
#include "parts/checkpoint.h"
#include "progress_bar.h"
#include "render_hints.h"
#include "scene_options.h"
#include "session/develop_image.h"
#include "session/image_header.h"
#include "session/meter_exposure.h"
#include "session/render_loaded.h"
#include "session/render_report.h"
#include "viewers/viewers.h"

namespace chromeball {
namespace {

// Reports the image so far after each pass.
class PassReport {
 public:
  std::string of(const RenderResult& result) {
    const RayCounts& counts = result.rays;
    const uint64_t rays = counts.camera + counts.shadow + counts.bounce;
    std::string text = fmt::format("{} samples", result.samples);
    if (const Noise noise = result.film.noise(); !std::isnan(noise.noise))
      text += fmt::format(", noise {:.2g}%", 100 * noise.noise);
    if (rays_ > 0)  // a render that was resumed has rays of other times
      text += fmt::format(", {:.1f} M rays/s", 1e-6 * double(rays - rays_) / watch_.seconds());
    rays_ = rays;
    watch_ = Stopwatch();
    return text;
  }

 private:
  uint64_t rays_ = 0;
  Stopwatch watch_;
};

// Renders one image, with a progress bar, and writes and shows it meanwhile.
class ImageRender {
 public:
  // All references must outlive this. Throws InputError for a checkpoint that does not fit.
  ImageRender(const LoadedScene& loaded, ProgressStyle style, std::vector<Viewer*> viewers)
      : loaded_(loaded),
        viewers_(std::move(viewers)),
        bar_(style),
        control_(
            loaded,
            [this, style](const RenderState& state) {
              if (style != ProgressStyle::None) bar_.describe(report_.of(state.result));
            },
            viewers_) {}

  // The image, ready to be written except for its state. Ends early if `stop` says so.
  // `fractionOfAll`: maps the fraction done of this image to the fraction of all work.
  FinishedRender run(const PreparedScene& prepared,
                     const std::function<double(double)>& fractionOfAll, const Stop& stop) {
    const RenderDescription& description = loaded_.description;
    for (Viewer* viewer : viewers_) viewer->begin(description.output.files.front());
    const auto progress = [&](double fraction) {
      bar_.update(fractionOfAll(fraction));
      for (Viewer* viewer : viewers_) viewer->update(fraction);
    };
    const bool isReference = description.composite && description.composite->passes == Passes::Two;
    FinishedRender result =
        renderLoaded(loaded_, prepared, progress, stop, isReference ? nullptr : &control_);
    result.image.metadata = imageMetadata(loaded_, result, result.render, result.seconds);
    const Messages& more = control_.messages();
    result.messages.insert(result.messages.end(), more.begin(), more.end());
    if (!viewers_.empty()) {
      auto last = std::make_shared<ImageSoFar>(imageSoFar(result, result.render));
      last->isLast = true;
      for (Viewer* viewer : viewers_) viewer->show(last);
    }
    return result;
  }

 private:
  const LoadedScene& loaded_;
  std::vector<Viewer*> viewers_;
  ProgressBar bar_;
  PassReport report_;
  CheckpointControl control_;
};

std::string guidedInWords(const RenderResult& render) {
  const bool lights = render.guidedRegions > 0, bounces = render.causticFraction > 0;
  if (!lights && !bounces) return "";
  return fmt::format(", {} guided,", !bounces  ? "light samples"
                                     : !lights ? "bounces"
                                               : "light samples and bounces");
}

// `exposure`: the one that was chosen; nullopt: none was.
void printOutcome(const RenderDescription& description, const FinishedRender& result,
                  std::optional<float> exposure, bool quiet) {
  const RenderResult& render = result.render;
  if (render.interrupted && render.samples == 0)
    throw Interrupted(fmt::format("interrupted before every pixel had a sample; saved as {}",
                                  fmt::join(description.output.files, ", ")));
  const auto& checkpoint = description.run.checkpoint;
  if (render.interrupted)
    throw Interrupted(fmt::format("interrupted; the image so far is saved{}{}",
                                  result.denoised                ? ", denoised"
                                  : description.settings.denoise ? ", not denoised"
                                                                 : "",
                                  checkpoint && std::filesystem::exists(*checkpoint)
                                      ? fmt::format("; --resume goes on from {}", *checkpoint)
                                      : ""));
  if (!quiet)
    fmt::print("{} samples per pixel{} in {:.2f} s, noise {}{}: {}\n", render.samplesPerPixel(),
               guidedInWords(render), result.seconds, noiseInWords(result),
               exposure ? ", " + chosenInWords(*exposure) : "",
               printable(fmt::format("{}", fmt::join(description.output.files, ", "))));
}

void writeImages(const RenderDescription& description, const LoadedScene& loaded,
                 const FinishedRender& result, PhaseSeconds seconds) {
  Stopwatch watch;
  print(writeOutputs(description, result.image));
  if (const auto& map = description.output.noiseMap) writeNoiseMap(*map, result);
  seconds.render = result.seconds;
  seconds.write = watch.lap();
  if (const auto& stats = description.output.stats)
    writeText(*stats, jsonText(statistics(loaded, result, seconds), 2) + "\n");
}

// The identity of a part of a render, from the files that were loaded; empty for a whole render.
std::optional<RenderPart> identified(const LoadedScene& loaded) {
  if (!loaded.description.settings.isPart()) return {};
  return RenderPart{renderIdentity(loaded), {}};
}

// Adds the state of a part to its image. To be called after the render, which solves the
// reflectance of a local scene.
void addState(const LoadedScene& loaded, std::optional<RenderPart>& part, FinishedRender& result) {
  if (!part) return;
  part->plan = finishPlan(loaded, result.render);
  result.image.state = partState(*part, result.render);
}

void renderStill(const SceneFile& scene, const SceneOptions& options) {
  RenderDescription description = planRender(scene, options.settings);
  const Messages outputMessages = checkOutputs(description);
  const ThreadLimit threads = threadLimit(options.settings);
  const Viewers viewers(options.settings, [] { interrupted = true; });

  Stopwatch watch;
  PhaseSeconds seconds;
  LoadedScene loaded = loadScene(description);
  seconds.load = watch.lap();
  const PreparedScene prepared = prepareScene(loaded);
  seconds.build = prepared.buildSeconds;
  seconds.prepare = prepared.prepareSeconds;
  prepareOutputs(loaded.description, loaded.files);
  catchInterrupts(description.settings.denoisesAtEnd()
                      ? "interrupted: denoising what there is; Ctrl-C again leaves without"
                      : "");
  watch.lap();
  std::optional<float> exposure;
  if (needsExposure(loaded.description)) {
    exposure = meteredExposure(loaded, prepared, interrupted);
    loaded.description.output.expose(*exposure);
  }
  seconds.prepare += watch.lap();
  description = loaded.description;
  std::optional<RenderPart> part = identified(loaded);
  FinishedRender result = [&] {
    ImageRender render(loaded, options.progress(), viewers.all());
    print(viewers.messages(), options.quiet());  // after the last error that input can cause
    print(outputMessages, options.quiet());
    print(loaded.messages, options.quiet());
    return render.run(prepared, [](double fraction) { return fraction; }, {interrupted, leaving});
  }();
  addState(loaded, part, result);
  if (result.render.samples == 0)  // must not overwrite an image that may be complete
    for (std::string& file : description.output.files) file = partialName(file);
  writeImages(description, loaded, result, seconds);

  print(resultMessages(loaded, prepared, result), options.quiet());
  printOutcome(description, result, exposure, options.quiet());
}

// Whether all files of a frame exist.
bool isFinished(const SequenceFrame& frame) {
  Settings all = frame.scene.settings;
  all.merge(frame.given);
  const auto files = all.get<std::vector<std::string>>("output.file");
  const auto exists = [](const std::string& path) { return std::filesystem::exists(path); };
  const auto isThere = [&](const char* name) {
    const auto file = all.getIfGiven<std::string>(name);
    return !file || exists(*file);
  };
  return std::ranges::all_of(files, exists) && isThere("stats") && isThere("noise-map");
}

// What a frame writes is no other frame's, and not read by any.
void checkFiles(const Sequence& sequence) {
  std::vector<std::string> outputs, inputs;
  for (const int number : sequence.numbers()) {
    const SequenceFrame frame = sequence.frame(number);
    Settings all = frame.scene.settings;
    all.merge(frame.given);
    for (const std::string& file : all.get<std::vector<std::string>>("output.file"))
      outputs.push_back(file);
    for (const char* name : {"stats", "noise-map", "checkpoint"})
      if (const auto file = all.getIfGiven<std::string>(name)) outputs.push_back(*file);
    if (const auto probe = all.getIfGiven<std::string>("probe.file")) inputs.push_back(*probe);
  }
  checkDistinct(outputs, inputs);
}

// The probes of all frames that are to be rendered: so a render of hours does not end at the first
// missing one.
void checkProbes(const Sequence& sequence, bool overwrites) {
  std::vector<std::string> missing;
  std::string location;
  for (const int number : sequence.numbers()) {
    const SequenceFrame frame = sequence.frame(number);
    const auto probe = frame.given.getIfGiven<std::string>("probe.file");
    if (!probe || std::filesystem::exists(*probe) || (!overwrites && isFinished(frame))) continue;
    missing.push_back(*probe);
    location = frame.given.location("probe.file");
  }
  if (missing.empty()) return;
  const size_t rest = missing.size() - 1;
  throwInput("{}: {}: no such file{}", location, missing.front(),
             rest > 0 ? fmt::format("; {} more of the frames' probes {} missing", rest,
                                    rest == 1 ? "is" : "are")
                      : "");
}

// Messages that an earlier frame has not printed.
void printNew(const Messages& messages, std::set<std::string>& printed, bool quiet) {
  for (const Message& message : messages)
    if (printed.insert(message.text).second) print(Messages{message}, quiet);
}

void renderFrames(const Sequence& sequence, const SceneOptions& options) {
  const std::vector<int>& frames = sequence.numbers();
  const bool overwrites = options.settings.get<bool>("overwrite");
  checkFiles(sequence);
  if (options.settings.has("probe-sequence")) checkProbes(sequence, overwrites);
  const ThreadLimit threads = threadLimit(options.settings);
  const Viewers viewers(options.settings, [] { interrupted = true; });
  catchInterrupts();
  FrameScene scene;
  std::set<std::string> printed;
  std::optional<float> exposure;  // of all frames
  size_t kept = 0;
  for (size_t i = 0; i < frames.size() && !interrupted; ++i) {
    const SequenceFrame frame = sequence.frame(frames[i]);
    RenderDescription description = planRender(frame.scene, frame.given);
    const Messages outputMessages = checkOutputs(description);
    if (!overwrites && isFinished(frame)) {
      ++kept;
      continue;
    }
    Stopwatch watch;
    if (needsExposure(description)) {
      if (!exposure) {
        const SequenceFrame first = sequence.frame(sequence.first());
        scene.show(planRender(first.scene, first.given));
        exposure = meteredExposure(scene.loaded(), scene.prepared(), interrupted);
      }
      description.output.expose(*exposure);
    }
    scene.show(description);
    description = scene.loaded().description;
    const PhaseSeconds seconds{.load = watch.lap()};
    prepareOutputs(description, scene.loaded().files);
    std::optional<RenderPart> part = identified(scene.loaded());
    const double before = double(i - kept), count = double(frames.size() - kept);
    FinishedRender result = [&] {
      ImageRender render(scene.loaded(), options.progress(), viewers.all());
      printNew(viewers.messages(), printed, options.quiet());
      printNew(sequence.messages(), printed, options.quiet());
      printNew(outputMessages, printed, options.quiet());
      printNew(scene.loaded().messages, printed, options.quiet());
      return render.run(
          scene.prepared(), [&](double fraction) { return (before + fraction) / count; },
          interrupted);
    }();
    if (result.render.interrupted) break;  // an image that exists is a finished one
    addState(scene.loaded(), part, result);
    writeImages(description, scene.loaded(), result, seconds);
    printNew(resultMessages(scene.loaded(), scene.prepared(), result), printed, options.quiet());
    if (!options.quiet()) fmt::print("frame {}: ", frame.number);
    printOutcome(description, result, exposure, options.quiet());
  }
  if (interrupted)
    throw Interrupted("interrupted; the same command goes on with the frames that are missing");
  if (kept > 0 && !options.quiet())
    fmt::print("{} of {} frames existed before; --overwrite renders them again\n", kept,
               frames.size());
}

void render(const SceneOptions& options) {
  const SceneFile scene = openScene(options.scene);
  const Sequence sequence(scene, options.settings);
  sequence.numbers().empty() ? renderStill(scene, options) : renderFrames(sequence, options);
}

}  // namespace

void addRenderCommand(Command app) {
  auto [command, a] =
      app.addCommand<SceneOptions>("render", "Render a scene file or a model to an image", render);
  addSceneOptions(
      command, a, SceneCommand::Render,
      "  chromeball render helmet.glb --probe studio.hdr --quality draft -o helmet.png\n"
      "  chromeball render scene.toml --time 60 --denoise -o scene.exr -o scene.png\n");
  command.footer(strategyHelp());
}

}  // namespace chromeball
