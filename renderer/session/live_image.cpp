// SPDX-License-Identifier: Apache-2.0
#include "session/live_image.h"

#include <algorithm>
#include <numeric>

#include "session/run_job.h"

namespace chromeball {
namespace {

void paste(const Image& part, const PixelRect& rect, Image& image) {
  for (int y = 0; y < rect.height; ++y)
    std::copy_n(part.at(0, y), rect.width * part.channels, image.at(rect.x, rect.y + y));
}

double sumOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

std::shared_ptr<const SessionImage> LiveImage::update(LiveResult& live, double noise) {
  std::vector<size_t> changed;
  const RenderResult* const result = live.update(changed);
  if (!result) return nullptr;
  if (!plan_) {
    plan_ = finishPlan(loaded_, *result);
    grid_ = {result->film.width(), result->film.height()};
    samples_.assign(grid_.count(), 0);
    for (Buffer& buffer : buffers_) buffer.isStale.assign(grid_.count(), true);
  }
  for (const size_t tile : changed) {
    const Image counts = result->film.part(grid_.rectOf(tile)).sampleCounts();
    samples_[tile] = std::accumulate(counts.texels.begin(), counts.texels.end(), 0.0);
    for (Buffer& buffer : buffers_) buffer.isStale[tile] = true;
  }
  const double samples = sumOf(samples_);
  if (samples == 0) return nullptr;
  Buffer& buffer = freeBuffer();
  bring(buffer, *result);
  buffer.image->samples = samples / (double(grid_.width) * grid_.height);
  buffer.image->noise = noise;
  return buffer.image;
}

// One whose image nobody has; else one that gets a new image.
LiveImage::Buffer& LiveImage::freeBuffer() {
  const auto isFree = [](const Buffer& b) { return b.image && b.image.use_count() == 1; };
  const auto found = std::ranges::find_if(buffers_, isFree);
  if (found != buffers_.end()) {
    std::atomic_thread_fence(std::memory_order_acquire);  // what its last owner has read is read
    return *found;
  }
  std::swap(buffers_[0], buffers_[1]);  // the one that was returned last is kept
  buffers_[0].image = std::make_shared<SessionImage>();
  buffers_[0].isStale.assign(grid_.count(), true);
  return buffers_[0];
}

void LiveImage::bring(Buffer& buffer, const RenderResult& result) const {
  OutputImage& image = buffer.image->image;
  if (plan_->composite) {
    image = imageOf(*plan_, result);
    return;
  }
  for (size_t tile = 0; tile < grid_.count(); ++tile) {
    if (!buffer.isStale[tile]) continue;
    buffer.isStale[tile] = false;
    const PixelRect rect = grid_.rectOf(tile);
    const OutputImage part = imageOf(*plan_, result.part(rect));
    if (image.layers.empty()) {
      image.placement = part.placement;
      for (const Layer& layer : part.layers)
        image.layers.push_back(
            {layer.name, layer.channels, Image(grid_.width, grid_.height, layer.image.channels)});
    }
    for (size_t i = 0; i < part.layers.size(); ++i)
      paste(part.layers[i].image, rect, image.layers[i].image);
  }
}

}  // namespace chromeball
