// SPDX-License-Identifier: Apache-2.0
// Renders one image, with a progress bar, and writes and shows it meanwhile.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "base/progress.h"
#include "parts/checkpoint.h"
#include "progress_bar.h"

namespace chromeball {

// Reports the image so far after each pass.
class PassReport {
 public:
  std::string of(const RenderResult& result);

 private:
  uint64_t rays_ = 0;
  Stopwatch watch_;
};

class ImageRender {
 public:
  // All references must outlive this. Throws InputError for a checkpoint that does not fit.
  ImageRender(const LoadedScene& loaded, bool showsProgress, std::vector<Viewer*> viewers);

  // The image, ready to be written except for its state. Ends early if `stop` is set.
  // `fractionOfAll`: maps the fraction done of this image to the fraction of all work.
  FinishedRender run(const PreparedScene& prepared,
                     const std::function<double(double)>& fractionOfAll,
                     const std::atomic<bool>& stop);

 private:
  const LoadedScene& loaded_;
  std::vector<Viewer*> viewers_;
  ProgressBar bar_;
  PassReport report_;
  CheckpointControl control_;
};

}  // namespace chromeball
