// SPDX-License-Identifier: Apache-2.0
// The image of a render that goes on, brought up to date by tiles.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/live_result.h"
#include "session/finish.h"
#include "session/session.h"

namespace chromeball {

struct LoadedScene;

class LiveImage {
 public:
  explicit LiveImage(const LoadedScene& loaded) : loaded_(loaded) {}  // which must outlive this

  // The image so far; null before the first samples. Of a composite, all pixels are composed again.
  // Otherwise only what has changed costs time, if of the two images that were returned last one is
  // not in use any more.
  std::shared_ptr<const SessionImage> update(LiveResult& live, double noise);

 private:
  // An image, and the tiles in which it is not up to date.
  struct Buffer {
    std::shared_ptr<SessionImage> image;
    std::vector<bool> isStale;
  };
  Buffer& freeBuffer();
  void bring(Buffer& buffer, const RenderResult& result) const;

  const LoadedScene& loaded_;
  std::optional<FinishPlan> plan_;
  TileGrid grid_{0, 0};
  std::vector<double> samples_;  // by tile
  std::array<Buffer, 2> buffers_;
};

}  // namespace chromeball
