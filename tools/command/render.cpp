// SPDX-License-Identifier: Apache-2.0
// chromeball render: a scene becomes a picture.
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "commands.h"
#include "image/io/write_image.h"
#include "job/composite_job.h"
#include "job/id_manifest.h"
#include "job/job_description.h"
#include "job/load_scene.h"
#include "job/machine.h"
#include "job/render_job.h"
#include "lighting/methods.h"
#include "progress_bar.h"
#include "render_hints.h"
#include "scene_options.h"

namespace chromeball {
namespace {

std::atomic<bool> interrupted = false;

// Seconds since the last call.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

struct Seconds {
  double load = 0, build = 0, prepare = 0, render = 0, write = 0;
};

struct Report {
  nlohmann::json json;
  Metadata metadata;
};

Report describe(const RenderJob& job, const RenderOptions& options, const LoadedScene& loaded,
                const RenderResult& result, const Seconds& seconds, const PictureNoise& noise) {
  const Scene& scene = loaded.scene;
  const auto description = describeJob(options, job, loaded);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const uint64_t rays = result.rays.camera + result.rays.shadow + result.rays.bounce;
  const std::string strategy = resolveStrategy(job.strategy.name);
  const DepthCut& cut = result.depthCut;
  Report r;
  r.json = {
      {"version", CHROMEBALL_VERSION},
      {"command", commandLine()},
      {"job", description},
      {"scene", options.scene},
      {"strategy", strategy},
      {"samples_per_pixel", result.samples},
      {"width", result.film.width()},
      {"height", result.film.height()},
      {"seed", job.settings.seed},
      {"max_depth", job.settings.maxDepth},
      {"max_transmission_depth", job.settings.maxTransmissionDepth},
      {"threads", tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)},
      {"seconds",
       {{"load", seconds.load},
        {"build", seconds.build},
        {"prepare", seconds.prepare},
        {"render", seconds.render},
        {"write", seconds.write}}},
      {"rays",
       {{"camera", result.rays.camera},
        {"shadow", result.rays.shadow},
        {"bounce", result.rays.bounce}}},
      {"invalid_samples", result.invalid.total()},
      {"invalid",
       {{"nan", result.invalid.of(Defect::Nan)},
        {"infinite", result.invalid.of(Defect::Infinite)},
        {"negative", result.invalid.of(Defect::Negative)}}},
      {"clamped",
       {{"samples", result.clamped.count}, {"light_removed", result.clamped.fractionRemoved()}}},
      {"depth_cut",
       {{"max_depth", cut.fraction(cut.byDepth)},
        {"max_transmission_depth", cut.fraction(cut.byTransmission)}}},
      {"noise", noise.noise},  // NaN becomes null
      {"noise_median", noise.median},
      {"noise_p95", noise.p95},
      {"triangles", scene.triangleCount()},
      {"scene_bytes", scene.byteCount()},
      {"texture_bytes", scene.texelByteCount()},
      {"peak_memory_bytes", uint64_t(usage.ru_maxrss) * 1024},
      {"interrupted", result.interrupted},
  };
  r.metadata = toMetadata(description);
  r.metadata["Software"] = "chromeball " CHROMEBALL_VERSION;
  r.metadata["command"] = commandLine();
  r.metadata["samples"] = int(result.samples);
  r.metadata["seconds"] = float(seconds.render);
  r.metadata["rays"] = std::to_string(rays);
  r.metadata["noise"] = float(noise.noise);
  r.metadata["noise_median"] = float(noise.median);
  r.metadata["noise_p95"] = float(noise.p95);
  if (job.settings.clamp)
    r.metadata["clamp_light_removed"] = float(result.clamped.fractionRemoved());
  return r;
}

Image withAlpha(const Image& color, const Image& alpha) {
  Image image(color.width, color.height, 4);
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) {
      image.setRgb(x, y, color.rgb(x, y));
      image.at(x, y)[3] = *alpha.at(x, y);
    }
  return image;
}

OutputImage assemble(const RenderResult& result, const RenderSettings& settings,
                     const Image& variance) {
  OutputImage output;
  if (settings.hideProbe)
    output.layers.push_back(
        {"", "RGBA", withAlpha(result.film.mean(), result.aovs.finished(Aov::Alpha))});
  else
    output.layers.push_back({"", "RGB", result.film.mean()});
  for (Aov aov : settings.aovs) {
    const AovInfo& info = aovInfo(aov);
    output.layers.push_back({info.name, info.channels,
                             aov == Aov::Variance  ? variance
                             : aov == Aov::Samples ? result.film.sampleCounts()
                                                   : result.aovs.finished(aov)});
  }
  return output;
}

Rendered renderPlain(const RenderJob& job, const LoadedScene& loaded, const World& world,
                     const LightingStrategy& lighting, const Progress& progress) {
  RenderResult result = render(world, loaded.camera, lighting, job.settings, progress, interrupted);
  PictureNoise noise(result.film.errors());
  OutputImage output = assemble(result, job.settings, noise.variance);
  return {std::move(result), std::move(output), std::move(noise)};
}

// A picture that lacks pixels does not replace one that may have them all.
void nameAsPartial(std::vector<std::string>& outputs) {
  for (std::string& output : outputs) {
    std::filesystem::path path = output;
    path.replace_extension(".partial" + path.extension().string());
    output = path.string();
  }
}

std::string inWords(const PictureNoise& n) {
  if (!std::isfinite(n.noise)) return "unknown";
  return fmt::format("{:.2f}% (median of the pixels {:.2f}%, 95% of them below {:.2f}%)",
                     100 * n.noise, 100 * n.median, 100 * n.p95);
}

void writeStats(const std::string& path, const nlohmann::json& json) {
  const std::string text = json.dump(2) + "\n";
  writeFile(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

void sayDepthCut(const char* option, int depth, double fraction) {
  constexpr double kWorthSaying = 0.01;
  if (fraction > kWorthSaying)
    warn(fmt::format("{} {} cut about {:.2g}% of the light; a higher one finds it", option, depth,
                     100 * fraction));
}

// Light that the picture lacks is never passed over in silence.
void sayWhatIsMissing(const RenderResult& result, const RenderSettings& settings) {
  if (const InvalidSamples& invalid = result.invalid; invalid.total())
    warn(fmt::format(
        "{} invalid samples were left out ({} with a NaN, {} infinite, {} negative), the "
        "first at pixel ({}, {}); --aov invalid shows where",
        invalid.total(), invalid.of(Defect::Nan), invalid.of(Defect::Infinite),
        invalid.of(Defect::Negative), invalid.x, invalid.y));
  if (result.clamped.count)
    warn(fmt::format("--clamp scaled {} samples down, and removed {:.3g}% of the picture's light",
                     result.clamped.count, 100 * result.clamped.fractionRemoved()));
  const DepthCut& cut = result.depthCut;
  sayDepthCut("--max-depth", settings.maxDepth, cut.fraction(cut.byDepth));
  sayDepthCut("--max-transmission-depth", settings.maxTransmissionDepth,
              cut.fraction(cut.byTransmission));
}

void render(const RenderOptions& options) {
  RenderJob job = planJob(options);
  planOutputs(job, options);
  std::optional<tbb::global_control> threads;
  if (options.threads > 0)
    threads.emplace(tbb::global_control::max_allowed_parallelism, options.threads);

  Seconds seconds;
  Stopwatch watch;
  std::optional<CompositeJob> composite;
  if (job.file.composite) composite = planComposite(job, options.twoPass);
  LoadedScene loaded = loadScene(job);
  const Scene& scene = loaded.scene;
  if (composite) prepareLocalScene(*composite, job, loaded);
  seconds.load = watch.lap();
  const World world(scene, composite ? rayMasks(composite->isObject) : std::vector<RayMask>());
  seconds.build = watch.lap();
  const auto lighting = makeLighting(job.strategy, job.settings.mis, loaded);
  prepareOutputs(job, options, loaded.files);
  seconds.prepare = watch.lap();
  sayNotes(job, loaded, options.quiet);
  if (composite && !options.quiet) sayPlateNotes(*job.file.composite);

  std::signal(SIGINT, [](int) { interrupted = true; });
  std::signal(SIGTERM, [](int) { interrupted = true; });
  Rendered rendered = [&] {
    ProgressBar bar(options.progress || (ProgressBar::isTerminal() && !options.quiet));
    const auto progress = [&](double fraction) { bar.update(fraction); };
    return composite
               ? renderComposite(*composite, job, loaded, world, *lighting, progress, interrupted)
               : renderPlain(job, loaded, world, *lighting, progress);
  }();
  const RenderResult& result = rendered.result;
  seconds.render = watch.lap();

  OutputImage& output = rendered.output;
  output.metadata = describe(job, options, loaded, result, seconds, rendered.noise).metadata;
  output.metadata.merge(idManifests(output, scene));
  if (result.samples == 0) nameAsPartial(job.outputs);
  for (const std::string& path : job.outputs) writeImage(path, output, job.display);
  seconds.write = watch.lap();
  Report report = describe(job, options, loaded, result, seconds, rendered.noise);
  report.json.update(rendered.details);
  if (!options.stats.empty()) writeStats(options.stats, report.json);

  sayWhatIsMissing(result, job.settings);
  for (const std::string& note : rendered.notes) warn(note);
  if (!composite) {
    if (const auto why = whyBlack(loaded, world.accel, result)) warn(*why);
    if (const auto hint = whyWhite(job, loaded, result); hint && !options.quiet) note(*hint);
  }
  if (result.interrupted && result.samples == 0)
    throw Interrupted(fmt::format("interrupted before every pixel had a sample; what there is: {}",
                                  fmt::join(job.outputs, ", ")));
  if (result.interrupted) throw Interrupted("interrupted; the picture so far is saved");
  if (!options.quiet)
    fmt::print("{} samples a pixel in {:.2f} s, noise {}: {}\n", result.samples, seconds.render,
               inWords(rendered.noise), fmt::join(job.outputs, ", "));
}

}  // namespace

void addRenderCommand(CLI::App& app) {
  auto options = std::make_shared<RenderOptions>();
  RenderOptions& o = *options;
  CLI::App* command = app.add_subcommand("render", "Render a scene file or a model to a picture");
  addSceneOptions(*command, o);
  command->add_option("-o,--output", o.outputs, ".exr, .hdr, .pfm or .png; may be given repeatedly")
      ->take_all();
  command->add_option("--samples", o.samples, "Samples a pixel (256)");
  command->add_option("--time", o.time, "Stop after about this many seconds");
  command->add_option("--noise", o.noise, "Stop at this noise, in percent")
      ->transform([](std::string percent) {
        if (percent.ends_with('%')) percent.pop_back();
        return percent;
      });
  command->footer(strategyHelp());
  command->add_option("--strategy", o.strategy,
                      "How the probe is sampled: NAME or NAME:COUNT; see below");
  command->add_option("--aov", o.aovs, "Layers of the .exr: albedo, normal, depth, ...")
      ->delimiter(',');
  command->add_option("--clamp", o.clamp,
                      "Scale samples down whose largest channel exceeds this (none is clamped)");
  command->add_option("--stats", o.stats, "Write times, rays and noise to this .json");
  command->add_flag("--two-pass", o.twoPass,
                    "Of a composite: two renders, subtracted; slow, to check the one pass by");
  command->add_flag("--transparent", o.transparent, "Hide the probe from the camera; write alpha");
  command->callback([options] { render(*options); });
}

}  // namespace chromeball
