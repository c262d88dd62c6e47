// SPDX-License-Identifier: Apache-2.0
#include "display_options.h"

#include <fmt/format.h>

#include <cmath>

#include "front/plan_render.h"
#include "image/tonemap.h"
#include "messages.h"
#include "scene_options.h"
#include "session/develop_image.h"

namespace chromeball {
namespace {

constexpr float kBackground = 1e9f;  // distances beyond this mean that nothing was hit

// 1 where the file says that a pixel shows a surface; empty if it has no such layer.
Image coverageIn(const ImageFile& file, const std::string& path) {
  for (const char* name : {"alpha", "node"})
    if (std::optional<Image> layer = layerOf(file, name, path)) return *std::move(layer);
  std::optional<Image> depth = layerOf(file, "depth", path);
  if (!depth || depth->channels != 1) return {};
  for (float& d : depth->texels) d = d < kBackground;
  return *std::move(depth);
}

}  // namespace

void addDisplayOptions(Command app, Settings& settings) {
  for (const char* name : {"output.exposure", "output.tonemap", "output.white_balance"})
    addSettingOption(app, settingNamed(name), settings);
}

DisplayTransform displayOf(const Settings& settings, const ImageFile& file,
                           const std::string& path) {
  auto [transform, choosesExposure] = planDisplay(settings);
  if (!choosesExposure || (file.integers && !settings.has("output.exposure"))) return transform;
  const std::optional<float> ofRender = exposureIn(file.metadata);
  std::optional<Image> color = findColor(file);
  if (!ofRender && !color) return transform;
  transform.exposure = ofRender
                           ? *ofRender
                           : autoExposure(inDisplayWindow(*std::move(color), file.placement, path),
                                          coverageIn(file, path));
  say("{}\n", ofRender ? exposureInWords(transform.exposure, "from the header")
                       : chosenInWords(transform.exposure));
  return transform;
}

std::string exposureInWords(float exposure, std::string_view source) {
  return fmt::format("exposure {:+} stops ({})", exposure, source);
}

std::optional<float> exposureIn(const Metadata& metadata) {
  const std::optional<double> stops = metadataNumber(metadata, "exposure");
  return stops && std::isfinite(float(*stops)) ? std::optional(float(*stops)) : std::nullopt;
}

}  // namespace chromeball
