// SPDX-License-Identifier: Apache-2.0
#include "job/render_job.h"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "base/error.h"
#include "base/suggest.h"
#include "image/io/write_image.h"
#include "job/arguments.h"
#include "job/output_file.h"

namespace chromeball {
namespace {

SceneFile openScene(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), ::tolower);
  if (extension == ".toml") return readSceneFile(path);
  if (extension != ".gltf" && extension != ".glb")
    throwInput("{}: not a scene; give a scene file (.toml) or a model (.gltf, .glb)", path);
  SceneFile file;
  file.models.push_back({path, {}, {}});
  return file;
}

void overlay(std::optional<NamedSetting>& setting, const std::optional<std::string>& option,
             const char* location) {
  if (option) setting = NamedSetting{*option, location};
}

template <class T>
void overlay(std::optional<T>& setting, const std::optional<T>& option) {
  if (option) setting = option;
}

Mis parseMis(const NamedSetting& setting) {
  if (setting.name == "off") return Mis::Off;
  if (setting.name == "balance") return Mis::Balance;
  if (setting.name == "power") return Mis::Power;
  throwInput("{}: `{}` is not known; {}", setting.location, setting.name,
             didYouMean(setting.name, {"off", "balance", "power"}));
}

SingleSided parseSingleSided(const NamedSetting& setting) {
  if (setting.name == "camera") return SingleSided::Camera;
  if (setting.name == "light") return SingleSided::Light;
  if (setting.name == "off") return SingleSided::Off;
  throwInput("{}: `{}` is not known; {}", setting.location, setting.name,
             didYouMean(setting.name, {"camera", "light", "off"}));
}

float parseModelLights(const std::string& text) {
  if (text == "off") return 0;
  const double factor = parseNumbers(text, 1, "--lights").front();
  if (!(factor >= 0)) throwInput("--lights: {} is neither `off` nor a factor, 0 or above", text);
  return float(factor);
}

template <class T>
void require(bool valid, const char* option, T given, std::string_view expected) {
  if (!valid) throwInput("{}: {} is not {}", option, given, expected);
}

void checkRanges(const RenderOptions& o) {
  if (o.samples)
    require(*o.samples >= 1 && *o.samples <= kMaxSamples, "--samples", *o.samples,
            fmt::format("a number from 1 to {}", kMaxSamples));
  if (o.maxDepth)
    require(*o.maxDepth >= 0 && *o.maxDepth <= kMaxDepth, "--max-depth", *o.maxDepth,
            fmt::format("a number from 0 to {}", kMaxDepth));
  if (o.maxTransmissionDepth)
    require(*o.maxTransmissionDepth >= 0 && *o.maxTransmissionDepth <= kMaxDepth,
            "--max-transmission-depth", *o.maxTransmissionDepth,
            fmt::format("a number from 0 to {}", kMaxDepth));
  if (o.time) require(*o.time > 0 && std::isfinite(*o.time), "--time", *o.time, "above 0 seconds");
  if (o.noise)
    require(*o.noise > 0 && std::isfinite(*o.noise), "--noise", *o.noise, "above 0 percent");
  if (o.scale)
    require(*o.scale >= 0 && std::isfinite(*o.scale), "--probe-scale", *o.scale, "0 or more");
  if (o.rotation)
    require(std::isfinite(*o.rotation), "--probe-rotation", *o.rotation, "a finite angle");
  if (o.animationTime)
    require(std::isfinite(*o.animationTime), "--animation-time", *o.animationTime,
            "a finite number of seconds");
  require(std::isfinite(o.exposure), "--exposure", o.exposure, "a finite number of stops");
  if (o.memory)
    require(*o.memory > 0 && std::isfinite(*o.memory), "--memory", *o.memory, "above 0 GB");
  if (o.clamp) require(*o.clamp > 0 && std::isfinite(*o.clamp), "--clamp", *o.clamp, "above 0");
  require(o.threads >= 0, "--threads", o.threads, "0 (all) or more");
}

void overlayAnimation(const RenderOptions& o, SceneFile& file) {
  if (!o.animation && !o.animationTime) return;
  for (ModelEntry& model : file.models) {
    std::optional<AnimationTime>& when = model.choice.animation;
    if (!when) when.emplace();
    if (o.animation || when->location.empty())
      when->location = o.animation ? "--animation" : "--animation-time";
    if (o.animation) when->name = *o.animation;
    if (o.animationTime) when->seconds = *o.animationTime;
  }
}

}  // namespace

RenderJob planJob(const RenderOptions& o) {
  checkRanges(o);
  RenderJob job;
  SceneFile& file = job.file = openScene(o.scene);
  if (o.camera) file.camera.reset();
  overlay(file.cameraName, o.camera, "--camera");
  overlayAnimation(o, file);
  if (o.variant)
    for (ModelEntry& model : file.models) model.choice.variant = {*o.variant, "--variant"};
  overlay(file.probe, o.probe);
  overlay(file.probeMapping, o.mapping, "--probe-mapping");
  overlay(file.probeRotation, o.rotation);
  overlay(file.probeScale, o.scale);
  overlay(file.strategy, o.strategy, "--strategy");
  overlay(file.mis, o.mis, "--mis");
  if (o.samples || o.time || o.noise) {  // how long to render is one decision
    file.samples = o.samples;
    file.timeLimit = o.time;
    file.noiseLimit.reset();
    if (o.noise) file.noiseLimit = *o.noise / 100;
  }
  if (o.lights) file.modelLights = parseModelLights(*o.lights);
  overlay(file.lightUnits, o.lightUnits, "--light-units");
  if (file.lightUnits)
    for (ModelEntry& model : file.models)
      model.choice.lightUnits = parseLightUnits(*file.lightUnits);
  overlay(file.singleSided, o.singleSided, "--single-sided");
  if (file.singleSided) job.singleSided = parseSingleSided(*file.singleSided);
  if (o.maxDepth) file.maxDepth = int(*o.maxDepth);
  if (o.maxTransmissionDepth) file.maxTransmissionDepth = int(*o.maxTransmissionDepth);
  overlay(file.seed, o.seed);

  job.size = file.size;
  if (o.size) {
    const ImageSize size = parseSize(*o.size);
    job.size = SceneFile::Size{size.width, size.height};
  }
  job.strategy = file.strategy.value_or(NamedSetting{"auto", "--strategy"});
  if (o.memory) job.memory = *o.memory * 1e9;
  job.display = {parseToneOperator(o.tonemap), o.exposure};

  RenderSettings& settings = job.settings;
  settings.timeLimit = file.timeLimit;
  settings.noiseLimit = file.noiseLimit;
  const bool limited = file.timeLimit || file.noiseLimit;
  settings.samples = file.samples.value_or(limited ? kMaxSamples : settings.samples);
  settings.maxDepth = file.maxDepth.value_or(settings.maxDepth);
  settings.maxTransmissionDepth = file.maxTransmissionDepth.value_or(settings.maxTransmissionDepth);
  settings.seed = file.seed.value_or(0);
  settings.hideProbe = o.transparent;
  settings.clamp = o.clamp;
  if (o.allowExternal)
    for (ModelEntry& model : file.models) model.choice.external = ExternalFiles::Allow;
  if (file.mis) settings.mis = parseMis(*file.mis);
  std::vector<NamedSetting> aovs = file.aovs;
  if (!o.aovs.empty()) {
    aovs.clear();
    for (const std::string& name : o.aovs) aovs.push_back({name, "--aov"});
  }
  for (const NamedSetting& aov : aovs) {
    settings.aovs.push_back(aovFromName(aov.name, aov.location));
    if (isOfComposite(settings.aovs.back()) && !file.composite)
      throwInput("{}: layer `{}` is a composite's; the scene file has no [composite]", aov.location,
                 aov.name);
  }
  if (o.twoPass && !file.composite)
    throwInput("--two-pass: renders a composite, and the scene file has no [composite]");
  if (settings.hideProbe && std::count(settings.aovs.begin(), settings.aovs.end(), Aov::Alpha) == 0)
    settings.aovs.push_back(Aov::Alpha);
  return job;
}

namespace {

void warnOfTonemap(RenderJob& job, const RenderOptions& options) {
  const auto isPng = [](const std::string& output) {
    std::string extension = std::filesystem::path(output).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), ::tolower);
    return extension == ".png";
  };
  if (std::any_of(job.outputs.begin(), job.outputs.end(), isPng)) return;
  for (const GivenOption& option : options.given)
    if (option.name == "tonemap" || option.name == "exposure")
      job.file.warnings.push_back(
          fmt::format("--{} has no effect: it is for .png, and {} holds radiance as it is",
                      option.name, job.outputs.front()));
}

}  // namespace

void planOutputs(RenderJob& job, const RenderOptions& options) {
  job.outputs = options.outputs.empty() ? job.file.outputs : options.outputs;
  if (job.outputs.empty())
    throwInput("{}: nowhere to write the picture; give --output FILE", options.scene);
  for (const std::string& output : job.outputs)
    options.outputs.empty() ? checkSceneOutput(output) : checkWritable(output);
  warnOfTonemap(job, options);
  if (!options.stats.empty()) checkOutputFile(options.stats, {".json"});
}

void prepareOutputs(const RenderJob& job, const RenderOptions& options,
                    std::vector<std::string> inputs) {
  inputs.push_back(options.scene);
  std::vector<std::string> outputs = job.outputs;
  outputs.push_back(options.stats);
  checkDistinct(outputs, inputs);
  if (options.outputs.empty())
    for (const std::string& output : job.outputs) makeFolder(output);
}

}  // namespace chromeball
