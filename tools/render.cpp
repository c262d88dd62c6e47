// chromeball render: a scene becomes a picture.
#include <sys/resource.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "image/file.h"
#include "image/write.h"
#include "math/error.h"
#include "math/suggest.h"
#include "probe/load.h"
#include "progress.h"
#include "render_job.h"
#include "scene/framing.h"
#include "scene/gltf.h"

namespace chromeball {
namespace {

std::atomic<bool> interrupted = false;

void warn(const std::string& message) { fmt::print(stderr, "chromeball: warning: {}\n", message); }

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

Scene loadModels(const SceneFile& file) {
  Scene scene;
  for (const ModelEntry& model : file.models)
    append(scene, loadGltf(model.file, model.placement, warn));
  if (scene.instances.empty())
    throwInput("{}: the model has no triangles to render", file.models.front().file);
  return scene;
}

// The probe as a lat-long map; black where the scene lights itself.
LoadedProbe loadProbeOf(const RenderJob& job, const Scene& scene) {
  const SceneFile& file = job.file;
  if (!file.probe) {
    const bool lit = std::any_of(scene.materials.begin(), scene.materials.end(),
                                 [](const Material& m) { return m.unlit || !isBlack(m.emission); });
    if (!lit) throwInput("{}: nothing lights the scene; give --probe FILE", file.models[0].file);
    LoadedProbe black;
    black.latLong = Image(2, 1, 3);
    return black;
  }
  const NamedSetting mapping = file.probeMapping.value_or(NamedSetting{"auto", "--probe-mapping"});
  return loadProbe(*file.probe, mapping.name, mapping.place);
}

void sayNotes(const LoadedProbe& probe, const std::string& path, bool quiet) {
  for (const std::string& line : warnings(probe, path)) warn(line);
  if (!probe.guessed || quiet) return;
  const std::string_view mapping = mappingName(probe.mapping);
  fmt::print(stderr, "chromeball: {}: taken for {} {} probe, since {}\n", path,
             mapping.starts_with('a') ? "an" : "a", mapping, probe.reason);
}

Camera chooseCamera(const RenderJob& job, const Scene& scene) {
  if (job.file.camera) return *job.file.camera;
  if (const auto& wanted = job.file.cameraName) {
    std::vector<std::string_view> names;
    for (const Camera& camera : scene.cameras) {
      if (camera.name == wanted->name) return camera;
      names.push_back(camera.name);
    }
    throwInput("{}: the model has no camera `{}`; {}", wanted->place, wanted->name,
               names.empty() ? "it has none at all" : didYouMean(wanted->name, names));
  }
  if (!scene.cameras.empty()) return scene.cameras.front();
  const RenderSettings& s = job.settings;
  return framingCamera(scene, float(s.width) / float(s.height));
}

// The size asked for; else the default height, as wide as the model's camera would have it.
void chooseSize(RenderJob& job, const Scene& scene) {
  RenderSettings& settings = job.settings;
  if (job.size) {
    settings.width = job.size->width;
    settings.height = job.size->height;
  } else if (!job.file.camera && !scene.cameras.empty()) {
    const float aspect = chooseCamera(job, scene).aspect;
    if (aspect > 0.05f && aspect < 20)
      settings.width = std::max(1, int(std::lround(aspect * float(settings.height))));
  }
  const double needed = double(settings.width) * settings.height *
                        (Film::bytesPerPixel() + 16.0 * double(settings.aovs.size()));
  const double available = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  if (needed > 0.8 * available)
    throwInput("--size: a picture of {}x{} needs {:.1f} GB of memory, and there are {:.1f}",
               settings.width, settings.height, needed * 1e-9, available * 1e-9);
}

struct Report {
  nlohmann::json json;
  Metadata metadata;
};

Report describe(const RenderJob& job, const RenderOptions& options, const Scene& scene,
                const RenderResult& result, const Seconds& seconds, double noise) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const uint64_t rays = result.rays.camera + result.rays.shadow + result.rays.bounce;
  const std::string strategy = resolveStrategy(job.strategy.name);
  Report r;
  r.json = {
      {"version", CHROMEBALL_VERSION},
      {"scene", options.scene},
      {"strategy", strategy},
      {"samples_per_pixel", result.samples},
      {"width", result.film.width()},
      {"height", result.film.height()},
      {"seed", job.settings.seed},
      {"max_depth", job.settings.maxDepth},
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
      {"invalid_samples", result.invalid.count},
      {"noise", noise},  // NaN becomes null
      {"triangles", scene.triangleCount()},
      {"scene_bytes", scene.byteCount()},
      {"peak_memory_bytes", uint64_t(usage.ru_maxrss) * 1024},
      {"interrupted", result.interrupted},
  };
  r.metadata = {{"Software", "chromeball " CHROMEBALL_VERSION},
                {"scene", options.scene},
                {"strategy", strategy},
                {"samples", result.samples},
                {"seed", std::to_string(job.settings.seed)},
                {"seconds", float(seconds.render)},
                {"rays", std::to_string(rays)},
                {"noise", float(noise)}};
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

OutputImage assemble(const RenderResult& result, const RenderSettings& settings) {
  OutputImage output;
  if (settings.hideProbe)
    output.layers.push_back(
        {"", "RGBA", withAlpha(result.film.mean(), result.aovs.finished(Aov::Alpha))});
  else
    output.layers.push_back({"", "RGB", result.film.mean()});
  for (Aov aov : settings.aovs) {
    const AovInfo& info = aovInfo(aov);
    output.layers.push_back({info.name, info.channels,
                             aov == Aov::Variance  ? result.film.squaredStandardError()
                             : aov == Aov::Samples ? result.film.sampleCounts()
                                                   : result.aovs.finished(aov)});
  }
  return output;
}

void writeStats(const std::string& path, const nlohmann::json& json) {
  const std::string text = json.dump(2) + "\n";
  writeFile(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

void render(const RenderOptions& options) {
  RenderJob job = planJob(options);
  std::optional<tbb::global_control> threads;
  if (options.threads > 0)
    threads.emplace(tbb::global_control::max_allowed_parallelism, options.threads);

  Seconds seconds;
  Stopwatch watch;
  const Scene scene = loadModels(job.file);
  chooseSize(job, scene);
  const Camera camera = chooseCamera(job, scene);
  LoadedProbe loaded = loadProbeOf(job, scene);
  const Probe probe(std::move(loaded.latLong), job.file.probeRotation.value_or(0),
                    job.file.probeScale.value_or(1));
  seconds.load = watch.lap();
  const Accel accel(scene);
  seconds.build = watch.lap();
  const auto lighting =
      makeStrategy(job.strategy.name, probe, job.settings.mis, job.strategy.place);
  seconds.prepare = watch.lap();
  // Said once nothing can be wrong any more, so that what is wrong stays one line.
  if (job.file.probe) sayNotes(loaded, *job.file.probe, options.quiet);

  std::signal(SIGINT, [](int) { interrupted = true; });
  std::signal(SIGTERM, [](int) { interrupted = true; });
  const RenderResult result = [&] {
    ProgressBar bar(options.progress || (ProgressBar::isTerminal() && !options.quiet));
    return render(
        scene, accel, camera, *lighting, job.settings, [&](double share) { bar.update(share); },
        interrupted);
  }();
  seconds.render = watch.lap();

  const double noise = result.film.noise();
  OutputImage output = assemble(result, job.settings);
  output.metadata = describe(job, options, scene, result, seconds, noise).metadata;
  for (const std::string& path : job.outputs) writeImage(path, output, job.display);
  seconds.write = watch.lap();
  const Report report = describe(job, options, scene, result, seconds, noise);
  if (!options.stats.empty()) writeStats(options.stats, report.json);

  if (result.invalid.count)
    warn(
        fmt::format("{} invalid samples (NaN, infinite or negative) were left out, one at pixel "
                    "({}, {})",
                    result.invalid.count, result.invalid.x, result.invalid.y));
  if (result.interrupted) throw Interrupted("interrupted; the picture so far is saved");
  if (!options.quiet)
    fmt::print("{} samples a pixel in {:.2f} s, noise {:.2f}%: {}\n", result.samples,
               seconds.render, 100 * noise, fmt::join(job.outputs, ", "));
}

}  // namespace

void addRenderCommand(CLI::App& app) {
  auto options = std::make_shared<RenderOptions>();
  RenderOptions& o = *options;
  CLI::App* command = app.add_subcommand("render", "Render a scene file or a model to a picture");
  command->add_option("scene", o.scene, "Scene file (.toml) or model (.gltf, .glb)")->required();
  command->add_option("-o,--output", o.outputs, ".exr, .hdr, .pfm or .png; may be given repeatedly")
      ->take_all();
  command->add_option("--probe", o.probe, "Light probe: .hdr, .exr or .pfm");
  command->add_option("--probe-mapping", o.mapping,
                      "auto, lat-long, angular, mirror-ball, cube-cross or cube-strip");
  command->add_option("--probe-rotation", o.rotation,
                      "Degrees the environment turns, counter-clockwise from above");
  command->add_option("--probe-scale", o.scale, "Factor on the probe's radiance");
  command->add_option("--size", o.size, "WxH in pixels");
  command->add_option("--samples", o.samples, "Samples a pixel (256)");
  command->add_option("--time", o.time, "Stop after about this many seconds");
  command->add_option("--noise", o.noise, "Stop at this noise, in percent");
  command->add_option("--strategy", o.strategy, "How the probe is sampled: NAME or NAME:COUNT");
  command->add_option("--mis", o.mis, "off, balance or power");
  command->add_option("--max-depth", o.maxDepth, "Bounces: 0 emission, 1 direct light, ... (8)");
  command->add_option("--camera", o.camera, "Name of one of the model's cameras");
  command->add_option("--seed", o.seed, "Another seed, another independent picture (0)");
  command->add_option("--threads", o.threads, "Number of threads (all)");
  command->add_option("--aov", o.aovs, "Layers of the .exr: albedo, normal, depth, ...")
      ->delimiter(',');
  command->add_option("--stats", o.stats, "Write times, rays and noise to this .json");
  command->add_option("--tonemap", o.tonemap, "For .png: none, reinhard, aces, neutral or filmic");
  command->add_option("--exposure", o.exposure, "For .png: stops");
  command->add_flag("--transparent", o.transparent, "Hide the probe from the camera; write alpha");
  command->add_flag("--progress", o.progress, "Show progress even where it is no terminal");
  command->add_flag("--quiet", o.quiet, "Show neither progress nor notes");
  command->callback([options] { render(*options); });
}

}  // namespace chromeball
