// SPDX-License-Identifier: Apache-2.0
// chromeball render --frames: the images of a sequence.
#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "base/error.h"
#include "front/plan_render.h"
#include "image/io/output_file.h"
#include "image_render.h"
#include "interrupt.h"
#include "messages.h"
#include "scene_notes.h"
#include "session/develop_image.h"
#include "session/render_messages.h"
#include "viewers/viewers.h"

namespace chromeball {
namespace {

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
void printNew(const Messages& messages, std::set<std::string>& printed) {
  for (const Message& message : messages)
    if (printed.insert(message.text).second) print(Messages{message});
}

}  // namespace

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
      ImageRender render(scene.loaded(), viewers.all());
      printNew(viewers.messages(), printed);
      printNew(sequence.messages(), printed);
      printNew(outputMessages, printed);
      printNew(scene.loaded().messages, printed);
      printNew(sceneNotes(scene.loaded()), printed);
      return render.run(
          scene.prepared(), [&](double fraction) { return (before + fraction) / count; },
          interrupted);
    }();
    if (result.render.interrupted) break;  // an image that exists is a finished one
    addState(scene.loaded(), part, result);
    writeImages(description, scene.loaded(), result, seconds);
    printNew(resultMessages(scene.loaded(), scene.prepared(), result, optionInWords), printed);
    say("frame {}: ", frame.number);
    printOutcome(description, result, exposure);
  }
  if (interrupted)
    throw Interrupted("interrupted; the same command goes on with the frames that are missing");
  if (kept > 0)
    say("{} of {} frames existed before; --overwrite renders them again\n", kept, frames.size());
}

}  // namespace chromeball
