// SPDX-License-Identifier: Apache-2.0
#include "parts/checkpoint.h"

#include <algorithm>

#include "base/error.h"
#include "image/io/exr_rows.h"
#include "image/io/exr_state.h"
#include "session/develop_image.h"
#include "session/image_header.h"
#include "session/render_report.h"

namespace chromeball {
namespace {

// Whether the text can be shown in a message.
bool isPlainText(const std::string& text) {
  return text.size() < 32 && std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

}  // namespace

void RenderPart::archive(Archive& a) {
  std::string version = "chromeball " CHROMEBALL_VERSION " 4";
  const std::string own = version;
  a(version);
  if (version != own)
    throwInput("{}: was written by another version of chromeball{}; render it again", a.name(),
               isPlainText(version) ? fmt::format(" ({}; this is {})", version, own) : "");
  a(identity);
  plan.archive(a);
  constexpr int kMaxSide = 65536;
  const auto& s = plan.settings;
  const Crop w = s.window();
  a.check(s.width > 0 && s.height > 0 && s.width <= kMaxSide && s.height <= kMaxSide &&
          s.shard.count > 0 && s.shard.index < s.shard.count && w.x >= 0 && w.y >= 0 &&
          w.width > 0 && w.height > 0 && w.width <= s.width - w.x && w.height <= s.height - w.y);
}

RenderPart readPartHeader(const std::filesystem::path& path) {
  RenderPart part;
  readExrState(path, [&](Archive& a) { part.archive(a); });
  return part;
}

CheckpointControl::CheckpointControl(const LoadedScene& loaded,
                                     std::function<void(const RenderState&)> onPass,
                                     std::vector<Viewer*> viewers)
    : loaded_(loaded),
      onPass_(std::move(onPass)),
      path_(loaded.description.run.checkpoint),
      viewers_(std::move(viewers)),
      images_(loaded.description.run.writeEvery),
      checkpoints_(path_ ? std::optional(loaded.description.run.checkpointEvery) : std::nullopt) {
  if (!path_) return;
  path_ = std::filesystem::weakly_canonical(std::filesystem::absolute(*path_)).string();  // links
  lock_.emplace(*path_);
  part_.identity = renderIdentity(loaded);
  if (!std::filesystem::exists(*path_)) return;
  if (!loaded.description.run.resumes)
    throw InputError(fmt::format("{}: exists; continue that render, or remove the file", *path_),
                     Remedy{"resume", {}});
  const std::string stored = readPartHeader(*path_).identity;
  if (stored != part_.identity)
    throwInput("{}: is a checkpoint of another render: {}", *path_,
               differenceOf(stored, part_.identity));
}

bool CheckpointControl::restore(RenderState& state) {
  if (!path_ || !std::filesystem::exists(*path_)) return false;
  RenderPart part;  // has been compared
  readExrState(*path_, partState(part, state));
  noteSamples(state);
  return true;
}

void CheckpointControl::noteSamples(const RenderState& restored) {
  const uint32_t pass = restored.finished.empty() ? 0 : restored.wanted;  // in progress
  const uint32_t samples = std::max(restored.done, pass),
                 asked = loaded_.description.settings.samples;
  if (samples > asked)
    addNote(messages_,
            "{} has {} samples per pixel, more than the {} asked for; the image keeps them", *path_,
            samples, asked);
}

void CheckpointControl::endPass(const RenderState& state) {
  if (onPass_) onPass_(state);
  publish(state);
}

bool CheckpointControl::wantsPause(const RenderState& state) const {
  return filesAreDue(state) || viewIsDue() || checkpointIsDue(state);
}

void CheckpointControl::pause(RenderState& state) {
  publish(state);
  if (checkpointIsDue(state)) writeCheckpoint(state);
}

void CheckpointControl::end(RenderState& state) {
  if (path_) writeCheckpoint(state);
}

bool CheckpointControl::filesAreDue(const RenderState& state) const {
  if (state.result.samples == 0) return false;  // some pixels may have none
  return images_.isDue() || std::ranges::any_of(viewers_, &Viewer::wantsFiles);
}

bool CheckpointControl::viewIsDue() const {
  return views_.isDue() && std::ranges::any_of(viewers_, &Viewer::wantsImage);
}

bool CheckpointControl::checkpointIsDue(const RenderState& state) const {
  return checkpoints_.isDue() && state.canBeStored();
}

void CheckpointControl::publish(const RenderState& state) {
  if (filesAreDue(state)) writeFiles(state);
  if (viewIsDue()) show(state);
}

void CheckpointControl::writeFiles(const RenderState& state) {
  const OutputImage image = imageOf(state).image;
  try {
    writeOutputs(loaded_.description, image);
  } catch (const std::runtime_error& error) {  // a long render does not end for want of a file
    const std::string text = fmt::format("while rendering: {}", error.what());
    if (messages_.empty() || messages_.back().text != text)
      messages_.push_back({Message::Kind::Warning, text});
  }
  images_.restart();
  for (Viewer* viewer : viewers_) viewer->wroteFiles();
}

void CheckpointControl::show(const RenderState& state) {
  constexpr double kMostOfTime = 0.1, kLeastInterval = 0.2;  // seconds
  const Stopwatch watch;
  const auto shown = std::make_shared<const ImageSoFar>(imageSoFar(imageOf(state), state.result));
  for (Viewer* viewer : viewers_)
    if (viewer->wantsImage()) viewer->show(shown);
  views_.restart(std::max(kLeastInterval, watch.seconds() / kMostOfTime));
}

FinishedImage CheckpointControl::imageOf(const RenderState& state) const {
  FinishPlan plan = finishPlan(loaded_, state.result);
  plan.settings.denoise = false;
  const std::atomic<bool> never = false;
  FinishedImage finished = finish(
      plan, state.result, [](double) {}, never);
  finished.image.metadata = imageMetadata(loaded_, finished, state.result, rendering_.seconds());
  return finished;
}

void CheckpointControl::writeCheckpoint(RenderState& state) {
  OutputImage image = imageOf(state).image;
  part_.plan = finishPlan(loaded_, state.result);
  image.state = partState(part_, state);
  writeExr(*path_, image);
  checkpoints_.restart();
}

}  // namespace chromeball
