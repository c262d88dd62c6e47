// SPDX-License-Identifier: Apache-2.0
// chromeball merge PART... -o OUT: puts shards and crops of a render together.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "base/file.h"
#include "base/json.h"
#include "base/text.h"
#include "commands.h"
#include "display_options.h"
#include "front/plan_render.h"
#include "image/io/output_file.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "messages.h"
#include "noise_in_words.h"
#include "parts/merge.h"
#include "progress_bar.h"
#include "session/image_header.h"
#include "session/render_messages.h"
#include "session/render_report.h"

namespace chromeball {
namespace {

struct MergeArguments {
  std::vector<std::string> parts, outputs;
  Settings display;
};

// The attributes that hold for the whole image: the first part's, and the names of the numbers in
// the layers of all parts.
Metadata wholeMetadata(const PartSet& parts) {
  Metadata metadata = readExrMetadata(parts.paths().front());
  for (const char* name :
       {"shard", "samplesOfAll", "crop", "seconds", "command", "clamp_light_removed"})
    metadata.erase(name);
  std::map<std::string, std::map<int, std::string>> names{{"node", {}}, {"material", {}}};
  for (const std::string& path : parts.paths()) {
    const Metadata part = readExrMetadata(path);
    for (auto& [layer, ofLayer] : names) ofLayer.merge(readManifest(part, layer));
  }
  for (const auto& [layer, ofLayer] : names) {
    nlohmann::ordered_json manifest;
    for (const auto& [number, name] : ofLayer) manifest[std::to_string(number)] = name;
    if (!ofLayer.empty()) metadata["manifest/" + layer] = jsonText(manifest);
  }
  return metadata;
}

void run(const MergeArguments& arguments) {
  for (const std::string& output : arguments.outputs) checkWritable(output);
  checkDistinct(arguments.outputs, arguments.parts);
  const PartSet parts(arguments.parts);
  const std::atomic<bool> never = false;
  ProgressBar bar(progressStyle(), "merging");
  MergedParts whole = merge(parts, [&](double fraction) { bar.update(kRenderShare * fraction); });
  FinishedImage finished = finish(
      whole.part.plan, whole.result, [&](double fraction) { bar.update(fraction); }, never);
  finished.image.metadata = sampleMetadata(finished, whole.result);
  finished.image.metadata.merge(wholeMetadata(parts));
  if (finished.denoised) finished.image.metadata["denoise"] = "true";  // the parts are not yet
  auto [transform, choosesExposure] = planDisplay(arguments.display);
  // The parts' exposure; of a composite they have none.
  const std::optional<float> ofParts = exposureIn(finished.image.metadata);
  if (choosesExposure) transform.exposure = ofParts.value_or(0);
  finished.image.metadata["exposure"] = transform.exposure;
  Messages messages;
  for (const std::string& output : arguments.outputs) {
    const Messages lost = writeImage(output, finished.image, transform);
    messages.insert(messages.end(), lost.begin(), lost.end());
  }
  addExcluded(whole.result, optionInWords, messages);
  const auto has = [&](std::string_view extension) {
    return std::ranges::any_of(arguments.outputs, [&](const std::string& file) {
      return lowerExtension(file) == extension;
    });
  };
  const bool shows = has(".png");
  for (const std::string_view name : {"output.exposure", "output.tonemap", "output.white_balance"})
    if (const bool isForHeader = name == "output.exposure" && has(".exr");
        !shows && !isForHeader && arguments.display.has(name))
      addWarning(messages, "{} has no effect: it is for .png; {} holds radiance",
                 arguments.display.location(name), printableName(arguments.outputs.front()));
  print(messages);
  say("{} samples per pixel of {} part{}, noise {}{}: {}\n", whole.result.samplesPerPixel(),
      parts.paths().size(), parts.paths().size() == 1 ? "" : "s", noiseInWords(finished),
      shows && choosesExposure && ofParts ? ", " + exposureInWords(*ofParts, "from the parts") : "",
      printable(fmt::format("{}", fmt::join(arguments.outputs, ", "))));
}

}  // namespace

void addMergeCommand(Command app) {
  auto [command, a] = app.addCommand<MergeArguments>(
      "merge", "Put the parts of a render together, of `render --shard` and `--crop`", run);
  command.addRequired("PART", a.parts,
                      "All parts, .exr, in any order; the image has the same bits for each");
  command
      .addRequired("-o,--output", a.outputs,
                   "Image to write: .exr, .hdr, .pfm or .png; may be given repeatedly")
      .onePerName();
  addDisplayOptions(command, a.display);
}

}  // namespace chromeball
