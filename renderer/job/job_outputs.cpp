// SPDX-License-Identifier: Apache-2.0
#include "job/job_outputs.h"

#include <algorithm>

#include "base/file.h"
#include "image/io/write_image.h"
#include "job/output_file.h"

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

  const auto has = [&](std::string_view extension) {
    return std::any_of(job.outputs.begin(), job.outputs.end(),
                       [&](const auto& output) { return lowerExtension(output) == extension; });
  };
  Messages messages;
  const auto warn = [&](std::string_view setting, const std::string& why) {
    if (settings.has(setting))
      messages.push_back({Message::Kind::Warning,
                          fmt::format("{} has no effect: {}", settings.location(setting), why)});
  };
  for (const char* name : {"tonemap", "exposure"})
    if (!has(".png"))
      warn(name, fmt::format("it is for .png; {} holds radiance", job.outputs.front()));
  if (!has(".exr")) warn("output.aovs", "only an .exr holds layers");
  return messages;
}

void prepareOutputs(const RenderJob& job, std::vector<std::string> inputs) {
  inputs.push_back(job.file.path);
  std::vector<std::string> outputs = job.outputs;
  if (const auto stats = job.file.settings.getIfGiven<std::string>("stats"))
    outputs.push_back(*stats);
  checkDistinct(outputs, inputs);
  if (job.makesOutputFolders)
    for (const std::string& output : job.outputs) makeFolder(output);
}

}  // namespace chromeball
