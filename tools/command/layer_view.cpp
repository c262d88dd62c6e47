// SPDX-License-Identifier: Apache-2.0
#include "layer_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/tonemap.h"

namespace chromeball {
namespace {

constexpr float kBackground = 1e9f;  // distances beyond this mean that nothing was hit

Rgb toLinear(const Color8& color) {
  Rgb linear;
  for (int c = 0; c < 3; ++c) linear[c] = srgbToLinear(float(color[c]) / 255);
  return linear;
}

// `color` maps a texel's channels to its color.
template <class Color>
Image colored(const Image& layer, const Color& color) {
  return colorImage(layer.width, layer.height, [&](int x, int y) { return color(layer.at(x, y)); });
}

float maxFinite(const Image& layer, int channel) {
  float maximum = 0;
  for (size_t i = channel; i < layer.texels.size(); i += layer.channels)
    if (std::isfinite(layer.texels[i])) maximum = std::max(maximum, layer.texels[i]);
  return maximum > 0 ? maximum : 1;
}

Image depthView(Image depth) {
  const auto isHit = [](float d) { return std::isfinite(d) && d < kBackground; };
  float nearest = std::numeric_limits<float>::max(), farthest = 0;
  for (const float d : depth.texels)
    if (isHit(d)) nearest = std::min(nearest, d), farthest = std::max(farthest, d);
  const float range = std::max(farthest - nearest, 1e-20f);
  for (float& d : depth.texels) d = isHit(d) ? 1 - 0.95f * (d - nearest) / range : 0;
  return depth;
}

Image varianceView(const Image& variance) {
  constexpr double kDecades = 3;
  const auto error = [&](const float* v) {
    return std::sqrt(variance.channels == 3 ? luminance(Rgb(v[0], v[1], v[2])) : v[0]);
  };
  std::vector<float> errors;
  for (size_t i = 0; i < variance.texels.size(); i += variance.channels)
    if (const float e = error(&variance.texels[i]); std::isfinite(e)) errors.push_back(e);
  const double maximum = roundUp(percentile(std::move(errors), 0.99));
  return colored(variance, [&](const float* v) {
    const float e = error(v);
    if (!std::isfinite(e)) return Rgb(1);  // unknown
    return toLinear(heatColor(logLevel(e, maximum, kDecades)));
  });
}

Image samplesView(const Image& samples) {
  const float maximum = maxFinite(samples, 0);
  return colored(samples, [&](const float* n) { return toLinear(heatColor(*n / maximum)); });
}

Image invalidView(Image invalid) {
  for (int c = 0; c < invalid.channels; ++c) {
    const float maximum = maxFinite(invalid, c);
    for (size_t i = c; i < invalid.texels.size(); i += invalid.channels)
      invalid.texels[i] /= maximum;
  }
  return invalid;
}

}  // namespace

bool isOfIds(const std::string& name) { return name == "node" || name == "material"; }

// Hues at steps of the golden angle, so that consecutive numbers have very different hues; three
// brightness levels.
Color8 idColor(int id) {
  if (id <= 0) return {0, 0, 0};
  constexpr double kTurn = 0.6180339887498949;
  const double hue = std::fmod(id * kTurn, 1.0), dark = 1 - 0.22 * (id % 3), pale = 0.15 * (id % 2);
  Color8 color;
  for (int c = 0; c < 3; ++c) {
    const double wave = std::clamp(std::fabs(std::fmod(hue + c / 3.0, 1.0) * 6 - 3) - 1, 0.0, 1.0);
    color[size_t(c)] = uint8_t(std::lround(255 * dark * (pale + (1 - pale) * wave)));
  }
  return color;
}

Image layerView(const std::string& name, Image layer) {
  if (name == "depth") return depthView(std::move(layer));
  if (name == "variance") return varianceView(layer);
  if (name == "samples") return samplesView(layer);
  if (name == "invalid") return invalidView(std::move(layer));
  if (isOfIds(name))
    return colored(layer, [](const float* id) {
      return toLinear(idColor(*id >= 1 && *id < 1e9f ? int(*id) : 0));
    });
  if (name == "normal")
    for (float& component : layer.texels) component = 0.5f * (component + 1);
  return layer;
}

}  // namespace chromeball
