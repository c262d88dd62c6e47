// SPDX-License-Identifier: Apache-2.0
// Renders the missing images of a study.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>

#include "base/message.h"
#include "measure/bias_variance.h"
#include "render/render.h"
#include "session/load_scene.h"
#include "study/render_store.h"
#include "study/study.h"

namespace chromeball {

class StudyRun {
 public:
  // Builds all rows (study.h), including the reference's. Throws InputError for unknown names. All
  // arguments must outlive the run.
  StudyRun(const Study& study, const RenderStore& store, const LoadedScene& loaded,
           const RenderSettings& settings);

  // What of the rows' own modes has no effect, each message with its row.
  Messages idleModes() const;

  // Renders and stores the missing images. `progress` receives the fraction of the estimated time
  // that has elapsed; `finishedBudget` is called when all strategies have rendered a budget.
  // Returns false if `stop` was set; the unfinished render is discarded.
  bool run(const Progress& progress, const std::function<void()>& finishedBudget,
           const std::atomic<bool>& stop);

  int stored() const { return stored_; }
  int total() const { return int(renders_.size()); }
  const LightSource& strategy(const std::string& row) const { return *built_.at(row).strategy; }
  bool unbiased(const std::string& row) const {
    return strategy(row).unbiased() && !built_.at(row).row.isBiased();
  }

 private:
  struct Built {
    Row row;
    std::unique_ptr<LightSource> strategy;
    std::unique_ptr<const EnvironmentLight> environment;  // of approximate integrators
    double prepareSeconds = 0;
    double secondsPerSample = 0;  // of the last render; 0 if there was none
  };

  // The estimated render time: of one render, and of all missing ones from index `from` on.
  double estimatedSeconds(const RenderKey& key) const;
  double estimatedSecondsMissing(size_t from) const;
  void renderOne(const RenderKey& key, const Progress& progress, const std::atomic<bool>& stop);
  // Renders one sample per pixel with each strategy and discards it, since the first render is slow
  // because of cold caches and memory allocation.
  void warmUp(const std::atomic<bool>& stop);
  RenderResult render(const RenderKey& key, const Progress& progress,
                      const std::atomic<bool>& stop) const;
  void makeWorlds();
  const World& worldOf(const Row& row) const {
    return row.has(Mode::GlassShadows) ? *straightWorld_ : *world_;
  }

  const Study& study_;
  const RenderStore& store_;
  const LoadedScene& loaded_;
  const RenderSettings& settings_;
  std::map<std::string, Built> built_;  // by row
  std::optional<Scene> straightScene_;  // with passShadowsStraight(), if a row needs it
  std::unique_ptr<const World> world_, straightWorld_;
  std::vector<RenderKey> renders_;
  std::vector<bool> present_;
  int stored_ = 0;
};

// The reference image of a study.

// Reads the reference from its file, or takes the mean of its parts from the store, which must have
// all of them. Throws InputError if the file has no colour or is not of the given size.
Reference loadReference(const Study& study, const RenderStore& store, int width, int height,
                        Messages* messages = nullptr);

}  // namespace chromeball
