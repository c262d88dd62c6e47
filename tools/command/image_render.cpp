// SPDX-License-Identifier: Apache-2.0
#include "image_render.h"

#include <fmt/format.h>

#include <cmath>

#include "session/render_report.h"

namespace chromeball {

std::string PassReport::of(const RenderResult& result) {
  const RayCounts& counts = result.rays;
  const uint64_t rays = counts.camera + counts.shadow + counts.bounce;
  std::string text = fmt::format("{} samples", result.samples);
  if (const Noise noise = result.film.noise(); !std::isnan(noise.noise))
    text += fmt::format(", noise {:.2g}%", 100 * noise.noise);
  if (rays_ > 0)  // a render that was resumed has rays of other times
    text += fmt::format(", {:.1f} M rays/s", 1e-6 * double(rays - rays_) / watch_.seconds());
  rays_ = rays;
  watch_ = Stopwatch();
  return text;
}

ImageRender::ImageRender(const LoadedScene& loaded, bool showsProgress,
                         std::vector<Viewer*> viewers)
    : loaded_(loaded),
      viewers_(std::move(viewers)),
      bar_(showsProgress),
      control_(
          loaded,
          [this, showsProgress](const RenderState& state) {
            if (showsProgress) bar_.describe(report_.of(state.result));
          },
          viewers_) {}

FinishedRender ImageRender::run(const PreparedScene& prepared,
                                const std::function<double(double)>& fractionOfAll,
                                const std::atomic<bool>& stop) {
  const RenderDescription& description = loaded_.description;
  for (Viewer* viewer : viewers_) viewer->begin(description.output.files.front());
  const auto progress = [&](double fraction) {
    bar_.update(fractionOfAll(fraction));
    for (Viewer* viewer : viewers_) viewer->update(fraction);
  };
  const bool isReference = description.composite && description.composite->passes == Passes::Two;
  FinishedRender result =
      renderLoaded(loaded_, prepared, progress, stop, isReference ? nullptr : &control_);
  result.image.metadata = imageMetadata(loaded_, result, result.render, result.seconds);
  const Messages& more = control_.messages();
  result.messages.insert(result.messages.end(), more.begin(), more.end());
  if (!viewers_.empty()) {
    auto last = std::make_shared<ImageSoFar>(imageSoFar(result, result.render));
    last->isLast = true;
    for (Viewer* viewer : viewers_) viewer->show(last);
  }
  return result;
}

}  // namespace chromeball
