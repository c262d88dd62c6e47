// SPDX-License-Identifier: Apache-2.0
// The renders of a study on disk, one EXR each, so that a run that was stopped goes on where it
// was.
#pragma once

#include <optional>
#include <string>

#include "image/image.h"
#include "probe/mapping.h"
#include "study/study.h"

namespace chromeball {

struct StoredRender {
  bool unbiased = true;  // whether its strategy is
  Image image;           // RGB
  double samples = 0, seconds = 0, prepareSeconds = 0;
  double noise = 0;  // as the render itself estimates it
  double rays = 0, invalidSamples = 0;
};

class RenderStore {
 public:
  // `size`: of the study's pictures.
  RenderStore(const Study& study, const ImageSize& size) : study_(study), size_(size) {}

  // Makes the folder where there is none. Throws RunError where it cannot.
  void makeFolder() const;

  std::string path(const RenderKey& key) const;  // FOLDER/renders/median-cut.64-16spp-1.exr

  // nullopt where it is not there yet. Throws InputError where the file is another study's or is
  // damaged.
  std::optional<StoredRender> find(const RenderKey& key) const;
  void save(const RenderKey& key, const StoredRender& render) const;

  // The first repeats of all renders in the folder but the reference's, in the order of their
  // names. Throws as find() does.
  std::vector<RenderKey> firstRepeats() const;

 private:
  const Study& study_;
  ImageSize size_;
};

}  // namespace chromeball
