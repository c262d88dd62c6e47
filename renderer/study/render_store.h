// SPDX-License-Identifier: Apache-2.0
// Stores the renders of a study on disk, one EXR each, so that an interrupted run can be resumed.
#pragma once

#include <optional>
#include <string>

#include "image/image.h"
#include "probe/mapping.h"
#include "study/study.h"

namespace chromeball {

struct StoredRender {
  bool unbiased = true;  // whether its strategy is unbiased
  Image image;           // RGB
  double samples = 0, seconds = 0, prepareSeconds = 0;
  double noise = 0;  // estimated by the render itself
  double rays = 0, invalidSamples = 0;
};

class RenderStore {
 public:
  // `size`: that of all renders of the study.
  RenderStore(const Study& study, const ImageSize& size) : study_(study), size_(size) {}

  // Creates the folder if it does not exist. Throws RunError if that fails.
  void makeFolder() const;

  std::string path(const RenderKey& key) const;  // FOLDER/renders/median-cut.64-16spp-1.exr

  // Reads a render; nullopt if it does not exist yet. Throws InputError if the file belongs to
  // another study or is damaged.
  std::optional<StoredRender> find(const RenderKey& key) const;
  void save(const RenderKey& key, const StoredRender& render) const;

  // The first repeats of all renders in the folder except the reference, sorted by file name.
  // Throws as find() does.
  std::vector<RenderKey> firstRepeats() const;

 private:
  const Study& study_;
  ImageSize size_;
};

}  // namespace chromeball
