// SPDX-License-Identifier: Apache-2.0
// The state of a render for the pages of a preview. Thread-safe.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "base/json.h"
#include "base/progress.h"
#include "session/viewer.h"

namespace chromeball {

struct NumberedImage {
  std::shared_ptr<const ImageSoFar> image;  // null before the first
  uint64_t number = 0;                      // of the images shown
};

class WatchedRender {
 public:
  // Called by the render.
  void begin(const std::string& name);
  void update(double fraction);
  void show(std::shared_ptr<const ImageSoFar> image);
  bool isWatched() const;  // whether a page has asked for the status in the last seconds
  bool wantsFiles() const { return wantsFiles_; }
  void wroteFiles();
  // Waits until the image and the status are sent, unless no page asks; a few seconds at most.
  void waitUntilSeen();

  // Called for the pages, which ask for the status again and again.
  nlohmann::json status();
  NumberedImage image() const;
  void hasSent(uint64_t number);
  void askForFiles() { wantsFiles_ = true; }

 private:
  using Clock = std::chrono::steady_clock;

  mutable std::mutex mutex_;
  std::condition_variable sent_;
  std::string name_;
  Stopwatch watch_;
  NumberedImage image_;
  uint64_t lastSent_ = 0, lastTold_ = 0, filesWritten_ = 0;
  std::atomic<double> fraction_ = 0;
  std::atomic<Clock::rep> asked_ = Clock::duration::min().count();  // since the clock's epoch
  std::atomic<bool> wantsFiles_ = false;
};

}  // namespace chromeball
