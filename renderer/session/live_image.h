// SPDX-License-Identifier: Apache-2.0
// The image of a render in progress, brought up to date by tiles.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "render/render_state.h"
#include "session/finish.h"
#include "session/session.h"

namespace chromeball {

struct LoadedScene;

class LiveImage {
 public:
  // Both arguments must outlive this, and this must outlive the render.
  LiveImage(const LoadedScene& loaded, LiveResult& live) : loaded_(loaded), live_(live) {}

  // The image so far; null before the first samples. For a composite, all pixels are composed
  // again. Otherwise only changed tiles cost time, if one of the last two images returned is no
  // longer in use.
  std::shared_ptr<const SessionImage> update(double noise);

 private:
  // An image, and the tiles in which it is not up to date.
  struct Buffer {
    std::shared_ptr<SessionImage> image;
    std::vector<bool> isStale;
  };
  void begin(const RenderResult& result);
  void read(const RenderResult& result, size_t tile);
  Buffer& freeBuffer();
  void bring(Buffer& buffer) const;

  const LoadedScene& loaded_;
  LiveResult& live_;
  std::mutex reading_;  // at its end the render reads the rest
  std::optional<FinishPlan> plan_;
  TileGrid grid_{0, 0};
  std::vector<double> samples_;           // by tile
  OutputImage current_;                   // of all tiles that were read; not of a composite
  std::optional<RenderResult> composed_;  // the input of a composite
  std::array<Buffer, 2> buffers_;
};

}  // namespace chromeball
