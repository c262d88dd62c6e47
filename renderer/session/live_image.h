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

// Who watches an image while it is rendered: a page in a browser, another program.

struct ImageSoFar {
  OutputImage image;     // denoised only at the end
  uint32_t samples = 0;  // mean per pixel
  double noise = 0;     // of the colour before denoising (film/noise.h); a fraction, NaN if unknown
  bool isLast = false;  // of this render
};

// With the layers variance and samples, also if the job does not write them.
ImageSoFar imageSoFar(FinishedImage finished, const RenderResult& render);

class Viewer {
 public:
  virtual ~Viewer() = default;

  // A render begins; `name` is that of its first output file.
  virtual void begin(const std::string& name) = 0;
  // The fraction of the render's work done; NaN if unknown. Thread-safe.
  virtual void update(double fraction) = 0;

  // Whether a newer image is wanted. Thread-safe and fast: called after each tile.
  virtual bool wantsImage() const = 0;
  virtual void show(std::shared_ptr<const ImageSoFar> image) = 0;

  // Whether the output files shall be written now. Thread-safe and fast.
  virtual bool wantsFiles() const { return false; }
  virtual void wroteFiles() {}
};

}  // namespace chromeball
