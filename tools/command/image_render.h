// SPDX-License-Identifier: Apache-2.0
// chromeball render: one image, from the loaded scene to its files.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "front/sequence.h"
#include "parts/checkpoint.h"
#include "progress_bar.h"
#include "scene_options.h"
#include "session/render_loaded.h"
#include "session/render_report.h"

namespace chromeball {

// Renders one image, with a progress bar, and writes and shows it meanwhile.
class ImageRender {
 public:
  // All references must outlive this. Throws InputError for a checkpoint that does not fit.
  ImageRender(const LoadedScene& loaded, std::vector<Viewer*> viewers);

  // The image, ready to be written except for its state. Ends early if `stop` says so.
  // `fractionOfAll`: maps the fraction done of this image to the fraction of all work.
  FinishedRender run(const PreparedScene& prepared,
                     const std::function<double(double)>& fractionOfAll, const Stop& stop);

 private:
  // Says what each pass has reached.
  class PassReport {
   public:
    std::string of(const RenderResult& result);

   private:
    uint64_t rays_ = 0;
    Stopwatch watch_;
  };

  const LoadedScene& loaded_;
  std::vector<Viewer*> viewers_;
  ProgressBar bar_;
  PassReport report_;
  CheckpointControl control_;
};

// The identity of a part of a render, from the files that were loaded; empty for a whole render.
std::optional<RenderPart> identified(const LoadedScene& loaded);

// Adds the state of a part to its image. To be called after the render, which solves the
// reflectance of a local scene.
void addState(const LoadedScene& loaded, std::optional<RenderPart>& part, FinishedRender& result);

void writeImages(const RenderDescription& description, const LoadedScene& loaded,
                 const FinishedRender& result, PhaseSeconds seconds);

// The line at the end of a render. Throws Interrupted, with what was saved, if it was interrupted.
// `exposure`: the one that was chosen; nullopt: none was.
void printOutcome(const RenderDescription& description, const FinishedRender& result,
                  std::optional<float> exposure);

// Renders the frames that are missing, or all with --overwrite.
void renderFrames(const Sequence& sequence, const SceneOptions& options);

}  // namespace chromeball
