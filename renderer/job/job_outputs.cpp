// SPDX-License-Identifier: Apache-2.0
#include "job/job_outputs.h"

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "image/io/write_image.h"
#include "job/output_file.h"
#include "lighting/strategy.h"

namespace chromeball {

Messages checkOutputs(const RenderJob& job) {
  const Settings& settings = job.file.settings;
  if (job.outputs.empty())
    throw InputError(fmt::format("{}: no output file is named", job.file.path),
                     Remedy{"output.file", {}});
  for (const std::string& output : job.outputs)
    job.makesOutputFolders ? checkSceneOutput(output) : checkWritable(output);
  if (const auto stats = settings.getIfGiven<std::string>("stats"))
    checkOutputFile(*stats, {".json"});
  if (const auto checkpoint = settings.getIfGiven<std::string>("checkpoint"))
    checkOutputFile(*checkpoint, {".exr"});

  const auto has = [&](std::string_view extension) {
    return std::any_of(job.outputs.begin(), job.outputs.end(),
                       [&](const auto& output) { return lowerExtension(output) == extension; });
  };
  if (settings.has("shard") && !has(".exr"))
    throwInput("{}: needs an .exr as output, which `chromeball merge` reads",
               settings.location("shard"));
  Messages messages;
  const auto warn = [&](std::string_view setting, const std::string& why) {
    if (settings.has(setting))
      messages.push_back({Message::Kind::Warning,
                          fmt::format("{} has no effect: {}", settings.location(setting), why)});
  };
  for (const char* name : {"tonemap", "exposure", "output.develop"})
    if (!has(".png"))
      warn(name, fmt::format("it is for .png; {} holds radiance", job.outputs.front()));
  const auto layers = settings.get<std::vector<std::string>>("output.aovs");
  const bool isForLens = job.develop.lens && layers == std::vector<std::string>{"depth"};
  if (!has(".exr") && !isForLens) warn("output.aovs", "only an .exr holds layers");
  if (const std::string strategy = resolveStrategy(job.strategy.name);
      !strategy.starts_with("suns"))
    warn("lighting.sun_angle", fmt::format("the strategy is {}; only suns has discs", strategy));
  return messages;
}

void prepareOutputs(const RenderJob& job, std::vector<std::string> inputs) {
  inputs.push_back(job.file.path);
  std::vector<std::string> outputs = job.outputs;
  for (const char* name : {"stats", "checkpoint", "cache"})
    if (const auto file = job.file.settings.getIfGiven<std::string>(name)) outputs.push_back(*file);
  checkDistinct(outputs, inputs);
  if (job.makesOutputFolders)
    for (const std::string& output : job.outputs) makeFolder(output);
}

}  // namespace chromeball
