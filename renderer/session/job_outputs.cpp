// SPDX-License-Identifier: Apache-2.0
#include "session/job_outputs.h"

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "description/capabilities.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "lighting/strategy.h"

namespace chromeball {

Messages checkOutputs(const RenderDescription& job) {
  const std::vector<std::string>& files = job.output.files;
  if (files.empty())
    throw InputError(fmt::format("{}: no output file is named", job.path),
                     Remedy{"output.file", {}});
  for (const std::string& output : files)
    job.output.makesFolders ? checkSceneOutput(output) : checkWritable(output);
  if (job.output.stats) checkOutputFile(*job.output.stats, {".json"});
  if (job.run.checkpoint) checkOutputFile(*job.run.checkpoint, {".exr"});

  const auto has = [&](std::string_view extension) {
    return std::any_of(files.begin(), files.end(),
                       [&](const auto& output) { return lowerExtension(output) == extension; });
  };
  if (job.settings.isPart() && job.origins.has("shard") && !has(".exr"))
    throwInput("{}: needs an .exr as output, which `chromeball merge` reads",
               job.origins.of("shard"));
  Messages messages;
  const auto warn = [&](std::string_view setting, const std::string& why) {
    if (job.origins.has(setting))
      messages.push_back({Message::Kind::Warning,
                          fmt::format("{} has no effect: {}", namedOrigin(job, setting), why)});
  };
  for (const char* name : {"tonemap", "exposure", "output.develop"})
    if (!has(".png")) warn(name, fmt::format("it is for .png; {} holds radiance", files.front()));
  const bool isForLens =
      job.output.develop.lens && job.output.layers == std::vector<std::string>{"depth"};
  if (!has(".exr") && !isForLens) warn("output.aovs", "only an .exr holds layers");
  if (const std::string strategy = resolveStrategy(job.lighting.strategy);
      !strategy.starts_with("suns"))
    warn("lighting.sun_angle", fmt::format("the strategy is {}; only suns has discs", strategy));
  return messages;
}

void prepareOutputs(const RenderDescription& job, std::vector<std::string> inputs) {
  inputs.push_back(job.path);
  std::vector<std::string> outputs = job.output.files;
  for (const auto* file : {&job.output.stats, &job.run.checkpoint, &job.run.cache})
    if (*file) outputs.push_back(**file);
  checkDistinct(outputs, inputs);
  if (job.output.makesFolders)
    for (const std::string& output : job.output.files) makeFolder(output);
}

}  // namespace chromeball
