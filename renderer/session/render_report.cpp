// SPDX-License-Identifier: Apache-2.0
#include "session/render_report.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>

#include "base/error.h"
#include "base/file.h"
#include "base/json.h"
#include "base/parallel.h"
#include "description/capabilities.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "lighting/strategy.h"
#include "session/image_header.h"
#include "session/memory_estimate.h"

namespace chromeball {
namespace {

using nlohmann::json;

// The rest of the first line of a file that begins with `key`, after `separator`.
std::string lineIn(const char* path, const std::string& key, char separator) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(key)) {
      const size_t begin = line.find_first_not_of(" \t\"", line.find(separator) + 1);
      const size_t end = line.find_last_not_of(" \t\"") + 1;
      return begin < end ? line.substr(begin, end - begin) : "";
    }
  return "";
}

std::string shellWord(const std::string& argument) {
  const bool plain = !argument.empty() && argument.find_first_not_of(
                                              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                              "0123456789-_=+,./:@%") == std::string::npos;
  if (plain) return argument;
  std::string result = "'";
  for (const char c : argument) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

// Of this process, quoted for a shell.
std::string commandLine() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string command;
  for (std::string argument; std::getline(file, argument, '\0');)
    command += fmt::format("{}{}", command.empty() ? "" : " ", shellWord(argument));
  return command;
}

// The memory stated before the render, and the peak since the process began.
json describe(const MemoryEstimate& stated) {
  return {
      {"process", stated.process},         {"images", stated.images}, {"textures", stated.textures},
      {"geometry", stated.geometry},       {"probe", stated.probe},   {"stated_peak", stated.peak},
      {"measured_peak", peakMemoryBytes()}};
}

json describe(const CompositeReport& report) {
  json j = {
      {"composite", {{"objects", report.coverage}, {"darker_than_black", report.darkerThanBlack}}}};
  if (const auto& r = report.reflectance)
    j["reflectance"] = {{"pixels", r->pixels},
                        {"clamped", r->clampedFraction},
                        {"exposure_ratio", r->exposureRatio},
                        {"last_change", r->lastChange}};
  return j;
}

// Of the light, by the name of the limit; null where it is not estimated.
json describe(const DepthCut& cut, const RenderSettings& settings) {
  if (!settings.estimatesDepthCut()) return nullptr;
  json j;
  for (size_t i = 0; i < DepthCut::kLimits; ++i)
    j[std::string(kDepthLimitNames[i])] = cut.fraction(DepthLimit(i));
  return j;
}

json describe(const RenderResult& result) {
  return {
      {"samples_per_pixel", result.samplesPerPixel()},
      {"adaptive", result.adaptive},
      {"guided", result.guidedRegions > 0},
      {"caustics_guided", result.causticFraction > 0},
      {"width", result.film.width()},
      {"height", result.film.height()},
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
      {"interrupted", result.interrupted},
  };
}

}  // namespace

json statistics(const LoadedScene& loaded, const FinishedRender& result,
                const PhaseSeconds& seconds) {
  const RenderDescription& description = loaded.description;
  json j = {
      {"version", CHROMEBALL_VERSION},
      {"command", commandLine()},
      {"job", describeLoaded(loaded)},
      {"scene", description.path},
      {"quality", description.quality.empty() ? json() : json(description.quality)},
      {"exposure",
       description.output.choosesExposure ? json() : json(description.output.display.exposure)},
      {"strategy", resolveStrategy(description.lighting.strategy)},
      {"seed", description.settings.seed},
      {"max_depth", description.settings.maxDepth},
      {"max_transmission_depth", description.settings.maxTransmissionDepth},
      {"threads", threadCount()},
      {"seconds",
       {{"load", seconds.load},
        {"build", seconds.build},
        {"prepare", seconds.prepare},
        {"render", seconds.render},
        {"write", seconds.write}}},
      {"noise", result.noise.noise},  // NaN becomes null
      {"noise_median", result.noise.median},
      {"noise_p95", result.noise.p95},
      {"triangles", loaded.scene.triangleCount()},
      {"scene_bytes", loaded.scene.byteCount()},
      {"texture_bytes", loaded.scene.texelByteCount()},
      {"texture_file_bytes", loaded.scene.texelFileByteCount()},
      {"peak_memory_bytes", peakMemoryBytes()},
      {"memory", describe(estimateMemory(loaded))},
  };
  j.update(describe(result.render));
  j["depth_cut"] = describe(result.render.depthCut, description.settings);
  if (const auto& d = result.denoised)
    j["denoised"] = {
        {"noise", d->noise}, {"median", d->median}, {"p95", d->p95}, {"seconds", d->seconds}};
  if (result.composite) j.update(describe(*result.composite));
  if (const auto& found = loaded.plateScale)
    j["probe_scale"] = {{"scale", {found->scale.x, found->scale.y, found->scale.z}},
                        {"scatter", found->scatter},
                        {"pixels", found->pixels}};
  return j;
}

void addNoise(const DenoiseReport& denoised, Metadata& metadata) {
  if (!std::isfinite(denoised.noise)) return;
  metadata["denoised_noise"] = float(denoised.noise);
  metadata["denoised_noise_median"] = float(denoised.median);
  metadata["denoised_noise_p95"] = float(denoised.p95);
}

Metadata sampleMetadata(const FinishedImage& finished, const RenderResult& render) {
  const RayCounts& rays = render.rays;
  Metadata metadata;
  metadata["samples"] = int(render.samplesPerPixel());
  metadata["rays"] = std::to_string(rays.camera + rays.shadow + rays.bounce);
  metadata["noise"] = float(finished.noise.noise);
  metadata["noise_median"] = float(finished.noise.median);
  metadata["noise_p95"] = float(finished.noise.p95);
  if (finished.denoised) addNoise(*finished.denoised, metadata);
  if (render.clamped.kept + render.clamped.removed > 0)  // else nothing was to be clamped
    metadata["clamp_light_removed"] = float(render.clamped.fractionRemoved());
  return metadata;
}

Metadata imageMetadata(const LoadedScene& loaded, const FinishedImage& finished,
                       const RenderResult& render, double seconds) {
  const RenderDescription& description = loaded.description;
  Metadata metadata = toMetadata(describeLoaded(loaded));
  metadata["Software"] = "chromeball " CHROMEBALL_VERSION;
  metadata["command"] = commandLine();
  metadata["seconds"] = float(seconds);
  metadata.merge(sampleMetadata(finished, render));
  if (render.interrupted) metadata["interrupted"] = "true";
  if (description.settings.denoisesAtEnd() && !finished.denoised) metadata["denoise"] = "false";
  if (!description.quality.empty()) metadata["quality"] = description.quality;
  if (!description.output.choosesExposure)
    metadata["exposure"] = description.output.display.exposure;
  if (description.settings.clamp)
    metadata["clamp_light_removed"] = float(render.clamped.fractionRemoved());
  const RenderSettings& settings = description.settings;
  if (const Shard& shard = settings.shard;
      shard.samplesOfAll > 0 && !settings.noiseLimit && !settings.timeLimit)
    metadata["samplesOfAll"] = int(shard.samplesOfAll);  // up to kMaxSamples
  metadata.merge(idManifests(finished.image, loaded.scene));
  return metadata;
}

Messages checkOutputs(const RenderDescription& description) {
  const std::vector<std::string>& files = description.output.files;
  if (files.empty())
    throw InputError(fmt::format("{}: no output file is named", description.path),
                     Remedy{"output.file", {}});
  for (const std::string& output : files)
    description.output.makesFolders ? checkSceneOutput(output) : checkWritable(output);
  if (description.output.stats) checkOutputFile(*description.output.stats, {".json"});
  if (description.output.noiseMap) checkOutputFile(*description.output.noiseMap, {".png"});
  if (description.run.checkpoint) checkOutputFile(*description.run.checkpoint, {".exr"});

  const auto has = [&](std::string_view extension) {
    return std::ranges::any_of(
        files, [&](const auto& output) { return lowerExtension(output) == extension; });
  };
  if (description.settings.isPart() && description.origins.has("shard") && !has(".exr"))
    throwInput("{}: needs an .exr as output, which `chromeball merge` reads",
               description.origins.of("shard"));
  Messages messages;
  const auto warn = [&](std::string_view setting, const std::string& why) {
    if (description.origins.has(setting))
      addWarning(messages, "{} has no effect: {}", namedOrigin(description, setting), why);
  };
  // Keys of a scene file are for whatever it is rendered to. A part and a checkpoint, which is one,
  // keep their exposure for the whole.
  const bool isForWhole = description.settings.isPart() || description.run.checkpoint;
  for (const char* name :
       {"output.tonemap", "output.white_balance", "output.develop", "output.exposure"})
    if (!has(".png") && description.origins.of(name).starts_with("--") &&
        !(name == std::string_view("output.exposure") && isForWhole))
      warn(name, fmt::format("it is for .png; {} holds radiance", files.front()));
  const bool isForLens = description.output.develop.lens &&
                         description.output.layers == std::vector<std::string>{"depth"};
  if (!has(".exr") && !isForLens) warn("output.aovs", "only an .exr holds layers");
  return messages;
}

std::string partialName(const std::string& output) {
  constexpr size_t kLongestName = 255;
  std::filesystem::path path = output;
  const std::string end = ".partial" + path.extension().string();
  path.replace_filename(path.stem().string().substr(0, kLongestName - end.size()) + end);
  return path.string();
}

void prepareOutputs(const RenderDescription& description, std::vector<std::string> inputs) {
  inputs.push_back(description.path);
  std::vector<std::string> outputs = description.output.files;
  for (const std::string& file : description.output.files) outputs.push_back(partialName(file));
  if (const auto& checkpoint = description.run.checkpoint)
    outputs.push_back(FileLock::nameOf(*checkpoint).string());
  for (const auto* file : {&description.output.stats, &description.output.noiseMap,
                           &description.run.checkpoint, &description.run.cache})
    if (*file) outputs.push_back(**file);
  checkDistinct(outputs, inputs);
  if (description.output.makesFolders)
    for (const std::string& output : description.output.files) makeFolder(output);
}

namespace {

#ifdef __clang__
constexpr const char* kCompiler = "clang++ " __clang_version__;
#else
constexpr const char* kCompiler = "g++ " __VERSION__;
#endif

}  // namespace

// (getrusage() would include what the process that started this one had.)
uint64_t peakMemoryBytes() {
  return 1024 * std::strtoull(lineIn("/proc/self/status", "VmHWM", ':').c_str(), nullptr, 10);
}

Machine thisMachine() {
  Machine machine;
  machine.processor = lineIn("/proc/cpuinfo", "model name", ':');
  utsname name{};
  uname(&name);
  machine.system = lineIn("/etc/os-release", "PRETTY_NAME", '=') + ", " + name.sysname + " " +
                   name.release + ", " + name.machine;
  machine.compiler = kCompiler;
  const std::time_t now = std::time(nullptr);
  char date[32];
  std::strftime(date, sizeof date, "%Y-%m-%d %H:%M UTC", std::gmtime(&now));
  machine.date = date;
  machine.threads = threadCount();
  machine.command = commandLine();
  return machine;
}

}  // namespace chromeball
