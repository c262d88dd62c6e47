// SPDX-License-Identifier: Apache-2.0
// Images and checkpoints that are written while a render runs, so that it can be looked at and
// continued.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "base/archive.h"
#include "base/file.h"
#include "base/message.h"
#include "base/progress.h"
#include "render/render_state.h"
#include "session/finish.h"
#include "session/render_loaded.h"
#include "session/viewer.h"

namespace chromeball {

// Files of renders that are not complete: checkpoints, shards and crops. Each is an .exr with the
// image so far, which other programs read, and the sums of the samples behind it (exr_state.h).

// Identifies the render that a file is a part of, and says how its image is made.
struct RenderPart {
  std::string identity;  // renderIdentity() (session/image_header.h)
  FinishPlan plan;

  // The first bytes of a file. Throws InputError if another version wrote it.
  void archive(Archive& a);
};

// The function for OutputImage::state. `part` and `state`, a RenderResult or RenderState, must
// outlive it.
template <class State>
std::function<void(Archive&)> partState(RenderPart& part, State& state) {
  return [&](Archive& a) {
    part.archive(a);
    part.plan.archiveImages(a);
    state.archive(a);
  };
}

// Reads a part without its images. Throws InputError.
RenderPart readPartHeader(const std::filesystem::path& path);

// Calls something again and again, so many seconds after its last call has ended.
class Interval {
 public:
  explicit Interval(std::optional<double> seconds) : seconds_(seconds) {}  // nullopt: never
  bool isDue() const { return seconds_ && watch_.seconds() >= *seconds_; }
  void restart() { watch_ = Stopwatch(); }
  void restart(double seconds) { seconds_ = seconds, restart(); }

 private:
  std::optional<double> seconds_;
  Stopwatch watch_;
};

// Writes the render's images every `write-every` seconds, without denoising, and its checkpoint
// every `checkpoint-every` seconds and at the end; shows the image to those who watch.
class CheckpointControl : public RenderControl {
 public:
  // Holds the lock of the checkpoint from here on. Throws InputError if another process holds it,
  // or if there is a checkpoint of another render, or one that is not to be resumed.
  // `onPass` is called after each pass. The viewers must outlive this.
  CheckpointControl(const LoadedScene& loaded, std::function<void(const RenderState&)> onPass = {},
                    std::vector<Viewer*> viewers = {});

  // Throws InputError for a damaged checkpoint.
  bool restore(RenderState& state) override;
  void endPass(const RenderState& state) override;
  bool wantsPause(const RenderState& state) const override;
  void pause(RenderState& state) override;
  void end(RenderState& state) override;

  const Messages& messages() const { return messages_; }

 private:
  bool filesAreDue(const RenderState& state) const;
  bool viewIsDue() const;
  bool checkpointIsDue(const RenderState& state) const;
  void publish(const RenderState& state);
  FinishedImage imageOf(const RenderState& state) const;
  void writeFiles(const RenderState& state);
  void show(const RenderState& state);
  void noteSamples(const RenderState& restored);
  void writeCheckpoint(RenderState& state);

  const LoadedScene& loaded_;
  std::function<void(const RenderState&)> onPass_;
  std::optional<std::string> path_;  // of the checkpoint
  std::optional<FileLock> lock_;
  RenderPart part_;  // of the checkpoint; identified by the files as they were loaded
  std::vector<Viewer*> viewers_;
  Interval images_, checkpoints_, views_{0};
  Stopwatch rendering_;
  Messages messages_;
};

}  // namespace chromeball
