// SPDX-License-Identifier: Apache-2.0
#include "viewers/preview_image.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "layer_view.h"

namespace chromeball {
namespace {

// Means of squares of `factor` pixels; those at the right and lower edge may be cut.
Image reduced(const Image& image, int factor) {
  Image small((image.width + factor - 1) / factor, (image.height + factor - 1) / factor,
              image.channels);
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      const int right = std::min(image.width, (x + 1) * factor);
      const int bottom = std::min(image.height, (y + 1) * factor);
      const float weight = 1 / float((right - x * factor) * (bottom - y * factor));
      for (int row = y * factor; row < bottom; ++row)
        for (int column = x * factor; column < right; ++column)
          for (int c = 0; c < image.channels; ++c)
            small.at(x, y)[c] += weight * image.at(column, row)[c];
    }
  return small;
}

}  // namespace

std::vector<uint8_t> pngOf(const OutputImage& image, const ImageView& view) {
  const auto layer = std::ranges::find(image.layers, view.layer, &Layer::name);
  if (layer == image.layers.end()) throwInput("the image has no layer `{}`", view.layer);
  if (!std::isfinite(view.display.exposure)) throwInput("exposure: must be finite");
  Image shown = layerView(view.layer, layer->image);
  if (view.maxWidth > 0 && shown.width > view.maxWidth)
    shown = reduced(shown, (shown.width + view.maxWidth - 1) / view.maxWidth);
  return encodePng(shown, view.display);
}

nlohmann::json valuesAt(const OutputImage& image, int x, int y) {
  const Image& color = image.layers.front().image;
  if (x < 0 || y < 0 || x >= color.width || y >= color.height)
    throwInput("{}, {} is outside the image", x, y);
  nlohmann::json values;
  for (const Layer& layer : image.layers) {
    nlohmann::json& texts = values[layer.name] = nlohmann::json::array();
    for (int c = 0; c < layer.image.channels; ++c)
      texts.push_back(fmt::format("{:.6g}", layer.image.at(x, y)[c]));
  }
  return values;
}

}  // namespace chromeball
