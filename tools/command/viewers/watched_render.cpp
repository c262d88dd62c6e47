// SPDX-License-Identifier: Apache-2.0
#include "viewers/watched_render.h"

#include <algorithm>

namespace chromeball {
namespace {

constexpr std::chrono::seconds kAttention{2};  // pages ask twice a second
constexpr double kMostWaiting = 5;             // seconds

nlohmann::json namesOf(const std::vector<Layer>& layers) {
  nlohmann::json names = nlohmann::json::array();
  for (const Layer& layer : layers) names.push_back(layer.name);
  return names;
}

}  // namespace

void WatchedRender::begin(const std::string& name) {
  const std::scoped_lock lock(mutex_);
  name_ = name;
  watch_ = Stopwatch();
  fraction_ = 0;
}

void WatchedRender::update(double fraction) { fraction_ = fraction; }

void WatchedRender::show(std::shared_ptr<const ImageSoFar> image) {
  const std::scoped_lock lock(mutex_);
  image_ = {std::move(image), image_.number + 1};
}

bool WatchedRender::isWatched() const {
  const Clock::rep asked = asked_;
  return asked != Clock::duration::min().count() &&
         Clock::now().time_since_epoch() - Clock::duration(asked) < kAttention;
}

void WatchedRender::wroteFiles() {
  wantsFiles_ = false;
  const std::scoped_lock lock(mutex_);
  ++filesWritten_;
}

void WatchedRender::waitUntilSeen() {
  std::unique_lock lock(mutex_);
  const Stopwatch waiting;
  while (isWatched() && std::min(lastSent_, lastTold_) < image_.number &&
         waiting.seconds() < kMostWaiting)
    sent_.wait_for(lock, std::chrono::milliseconds(50));
}

nlohmann::json WatchedRender::status() {
  asked_ = Clock::now().time_since_epoch().count();
  const std::scoped_lock lock(mutex_);
  lastTold_ = image_.number;
  const double fraction = fraction_, elapsed = watch_.seconds();
  nlohmann::json status{{"name", name_},
                        {"elapsed", elapsed},
                        {"fraction", fraction},
                        {"image", image_.number},
                        {"filesWritten", filesWritten_}};
  if (fraction > 0) status["remaining"] = elapsed * (1 - fraction) / fraction;
  if (!image_.image) return status;
  const OutputImage& image = image_.image->image;
  const Image& color = image.layers.front().image;
  status["samples"] = image_.image->samples;
  status["noise"] = image_.image->noise;
  status["isLast"] = image_.image->isLast;
  status["width"] = color.width;
  status["height"] = color.height;
  status["left"] = image.placement ? image.placement->x : 0;
  status["top"] = image.placement ? image.placement->y : 0;
  status["layers"] = namesOf(image.layers);
  return status;
}

NumberedImage WatchedRender::image() const {
  const std::scoped_lock lock(mutex_);
  return image_;
}

void WatchedRender::hasSent(uint64_t number) {
  const std::scoped_lock lock(mutex_);
  lastSent_ = std::max(lastSent_, number);
  sent_.notify_all();
}

}  // namespace chromeball
