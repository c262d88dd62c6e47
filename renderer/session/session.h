// SPDX-License-Identifier: Apache-2.0
// A render in the background.
#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <optional>
#include <thread>

#include "description/render_description.h"
#include "integrate/live_result.h"
#include "scene/gltf/model_cache.h"
#include "session/run_job.h"

namespace chromeball {

// Loads and renders a description in a thread of its own, hands out what there is so far without
// stopping those that render, and takes other descriptions, of which it redoes only what differs
// from the one before. After update() the picture has the bits of a new session's.
//
// Its functions may be called from any thread, by one at a time. Errors of the background thread
// (InputError, RunError) are thrown by the next wait().
class Session {
 public:
  explicit Session(RenderDescription description);
  ~Session();  // cancels
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // Begins, if it has not begun: reads files, builds structures and renders.
  void start();
  // Stops as soon as the step in work or the tiles in work are finished. start() begins anew.
  void cancel();
  // Cancels, and takes the new description, to be started.
  void update(RenderDescription description);

  bool isRunning() const { return isRunning_; }
  double fraction() const { return fraction_; }  // of rendering; NaN if unknown
  // Waits for the end of the render. `interrupted` of the result's render if it was cancelled.
  const JobResult& wait();
  // Of the description as it was loaded; null before.
  const LoadedScene* loaded() const { return isRunning_ ? nullptr : loaded_.get(); }

  // What there is while it renders, and afterwards.
  struct Snapshot {
    FinishedImage image;  // the colour and the layers, not denoised
    double samples = 0;   // mean per pixel
  };
  std::optional<Snapshot> snapshot();  // nullopt before the first samples

  // What the last start() did, for tests and statistics.
  struct Work {
    bool loadedScene = false, builtWorld = false, loadedProbe = false, preparedLighting = false;
  };
  const Work& work() const { return work_; }
  // Structures over meshes that were built so far; 0 before the first.
  int meshBuilds() const;

 private:
  class Control;
  void run();
  void prepare();
  void load();
  void changeWhatDiffers();

  RenderDescription description_;
  std::optional<RenderDescription> given_;  // that of loaded_
  std::unique_ptr<LoadedScene> loaded_;
  PreparedScene prepared_;
  ModelCache models_;
  Work work_;
  std::unique_ptr<Control> control_;
  std::optional<JobResult> result_;
  std::exception_ptr error_;
  std::atomic<bool> stop_ = false, isRunning_ = false, isReady_ = false;
  std::atomic<double> fraction_ = 0;
  std::thread thread_;
};

}  // namespace chromeball
