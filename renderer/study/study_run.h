// SPDX-License-Identifier: Apache-2.0
// Renders what a study lacks.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>

#include "integrate/render.h"
#include "job/load_scene.h"
#include "study/render_store.h"

namespace chromeball {

class StudyRun {
 public:
  // Builds every strategy, and the reference's. Throws InputError for a name that is not known. All
  // arguments must outlive the run.
  StudyRun(const Study& study, const RenderStore& store, const LoadedScene& loaded,
           const RenderSettings& settings);

  // Renders and stores what is missing. `progress` is told the share of the seconds that are
  // thought to be needed, `finishedBudget` when all strategies have rendered on one. Returns false
  // where `stop` was set: the render under way is dropped.
  bool run(const Progress& progress, const std::function<void()>& finishedBudget,
           const std::atomic<bool>& stop);

  int stored() const { return stored_; }
  int total() const { return int(renders_.size()); }
  const LightingStrategy& strategy(const std::string& name) const {
    return *built_.at(name).strategy;
  }

 private:
  struct Built {
    std::unique_ptr<LightingStrategy> strategy;
    double prepareSeconds = 0;
    double secondsPerSample = 0;  // as measured last; 0 where not yet
  };

  // The seconds a render will probably take.
  double guess(const RenderKey& key) const;
  double guessMissing(size_t from) const;
  void renderOne(const RenderKey& key, const Progress& progress, const std::atomic<bool>& stop);
  // A first render pays for cold caches and memory: one of a sample a pixel is thrown away.
  void warmUp(const std::atomic<bool>& stop);
  RenderResult render(const RenderKey& key, const Progress& progress,
                      const std::atomic<bool>& stop) const;

  const Study& study_;
  const RenderStore& store_;
  const LoadedScene& loaded_;
  const RenderSettings& settings_;
  World world_;
  std::map<std::string, Built> built_;
  std::vector<RenderKey> renders_;
  std::vector<bool> present_;
  int stored_ = 0;
};

}  // namespace chromeball
