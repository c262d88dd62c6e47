// SPDX-License-Identifier: Apache-2.0
#include "session/live_image.h"

#include <algorithm>
#include <numeric>

#include "session/render_loaded.h"

namespace chromeball {
namespace {

template <class Number>
double sumOf(const std::vector<Number>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

// Images with the same layers as `part`, all 0.
OutputImage emptyImage(const OutputImage& part, const TileGrid& grid) {
  OutputImage image;
  image.placement = part.placement;
  for (const Layer& layer : part.layers)
    image.layers.push_back(
        {layer.name, layer.channels, Image(grid.width, grid.height, layer.image.channels)});
  return image;
}

void paste(const Image& part, const PixelRect& rect, Image& image) {
  for (int y = 0; y < rect.height; ++y)
    std::copy_n(part.at(0, y), rect.width * part.channels, image.at(rect.x, rect.y + y));
}

void copyPixels(const OutputImage& from, const PixelRect& rect, OutputImage& to) {
  for (size_t i = 0; i < from.layers.size(); ++i) {
    const Image& image = from.layers[i].image;
    rect.copy(image.texels, to.layers[i].image.texels, image.width, size_t(image.channels));
  }
}

}  // namespace

std::shared_ptr<const SessionImage> LiveImage::update(double noise) {
  live_.update([this](const RenderResult& result, size_t tile) { read(result, tile); });
  const std::scoped_lock lock(reading_);
  const double samples = sumOf(samples_);
  if (samples == 0) return nullptr;
  Buffer& buffer = freeBuffer();
  bring(buffer);
  buffer.image->samples = samples / (double(grid_.width) * grid_.height);
  buffer.image->noise = noise;
  return buffer.image;
}

void LiveImage::begin(const RenderResult& result) {
  plan_ = finishPlan(loaded_, result);
  grid_ = {result.film.width(), result.film.height()};
  samples_.assign(grid_.count(), 0);
  for (Buffer& buffer : buffers_) buffer.isStale.assign(grid_.count(), true);
  if (plan_->composite) composed_.emplace(plan_->settings, plan_->layers());
}

void LiveImage::read(const RenderResult& result, size_t tile) {
  const std::scoped_lock lock(reading_);
  if (!plan_) begin(result);
  const PixelRect rect = grid_.rectOf(tile);
  for (Buffer& buffer : buffers_) buffer.isStale[tile] = true;
  if (composed_) {
    composed_->copyPixels(result, rect);
    samples_[tile] = sumOf(result.film.part(rect).sampleCounts().texels);
    return;
  }
  const RenderResult pixels = result.part(rect);
  samples_[tile] = sumOf(pixels.film.sampleCounts().texels);
  const OutputImage part = imageOf(*plan_, pixels);
  if (current_.layers.empty()) current_ = emptyImage(part, grid_);
  for (size_t i = 0; i < part.layers.size(); ++i)
    paste(part.layers[i].image, rect, current_.layers[i].image);
}

// A buffer whose image nobody else holds; else one that gets a new image.
LiveImage::Buffer& LiveImage::freeBuffer() {
  const auto isFree = [](const Buffer& b) { return b.image && b.image.use_count() == 1; };
  const auto found = std::ranges::find_if(buffers_, isFree);
  if (found != buffers_.end()) {
    std::atomic_thread_fence(std::memory_order_acquire);  // after all reads by its last owner
    return *found;
  }
  std::swap(buffers_[0], buffers_[1]);  // the one that was returned last is kept
  buffers_[0].image = std::make_shared<SessionImage>();
  buffers_[0].isStale.assign(grid_.count(), true);
  return buffers_[0];
}

void LiveImage::bring(Buffer& buffer) const {
  OutputImage& image = buffer.image->image;
  if (composed_) {
    image = imageOf(*plan_, *composed_);
    return;
  }
  if (image.layers.empty()) image = emptyImage(current_, grid_);
  for (size_t tile = 0; tile < grid_.count(); ++tile) {
    if (!buffer.isStale[tile]) continue;
    buffer.isStale[tile] = false;
    copyPixels(current_, grid_.rectOf(tile), image);
  }
}

}  // namespace chromeball
