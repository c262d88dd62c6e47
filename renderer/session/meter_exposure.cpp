// SPDX-License-Identifier: Apache-2.0
#include "session/meter_exposure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/file.h"
#include "image/auto_exposure.h"

namespace chromeball {
namespace {

constexpr double kPixels = 96 * 64;
constexpr uint32_t kSamples = 32;  // per pixel

// What decides the light stays as it is.
RenderSettings meterSettings(RenderSettings settings) {
  const double scale =
      std::min(1.0, std::sqrt(kPixels / (double(settings.width) * settings.height)));
  settings.width = std::max(1, int(std::lround(scale * settings.width)));
  settings.height = std::max(1, int(std::lround(scale * settings.height)));
  settings.crop.reset(), settings.shard = {};
  settings.samples = kSamples, settings.timeLimit.reset(), settings.noiseLimit.reset();
  settings.adaptive = settings.denoise = settings.lightGroups = settings.shadowMattes = false;
  settings.guiding = Guiding::Off, settings.cacheError.reset();
  settings.aovs = {Aov::Alpha};
  return settings;
}

}  // namespace

bool needsExposure(const RenderDescription& description) {
  const auto isPng = [](const std::string& file) { return lowerExtension(file) == ".png"; };
  return description.output.choosesExposure &&
         (description.settings.isPart() || std::ranges::any_of(description.output.files, isPng));
}

float meteredExposure(const LoadedScene& loaded, const PreparedScene& prepared,
                      const std::atomic<bool>& stop) {
  const RenderResult small = render(*prepared.world, loaded.camera, *prepared.lighting,
                                    meterSettings(loaded.description.settings), [](double) {}, stop,
                                    nullptr, {prepared.environment.get(), nullptr});
  if (small.interrupted) return 0;
  return autoExposure(small.film.mean(), small.aovs.finished(Aov::Alpha));
}

std::string chosenInWords(float exposure) {
  return fmt::format("exposure {:+.1f} stops (auto)", exposure);
}

}  // namespace chromeball
