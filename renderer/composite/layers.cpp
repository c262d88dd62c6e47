// SPDX-License-Identifier: Apache-2.0
#include "composite/layers.h"

#include <algorithm>
#include <cassert>

namespace chromeball {
namespace {

Rgb valueOf(const DifferentialPixel& p, CompositeLayer layer) {
  const double count = std::max(p.count, 1.0);
  switch (layer) {
    case CompositeLayer::WithObjects:
      return Rgb((p.objects + p.local + p.difference) / count);
    case CompositeLayer::WithoutObjects:
      return Rgb((p.local + p.behind) / count);
    case CompositeLayer::Difference:
      return Rgb(p.difference / count);
    case CompositeLayer::Ratio:
      return Rgb(p.ratio());
    case CompositeLayer::Objects:
      return Rgb(p.objects / count);
    default:
      return Rgb(float(p.covered / count));
  }
}

}  // namespace

const std::vector<CompositeLayerInfo>& compositeLayers() {
  static const std::vector<CompositeLayerInfo> layers{
      {CompositeLayer::WithObjects, "l_obj", "RGB"},
      {CompositeLayer::WithoutObjects, "l_noobj", "RGB"},
      {CompositeLayer::Difference, "difference", "RGB"},
      {CompositeLayer::Ratio, "ratio", "RGB"},
      {CompositeLayer::Objects, "objects", "RGB"},
      {CompositeLayer::Alpha, "alpha", "A"},
      {CompositeLayer::Reflectance, "reflectance", "RGB"}};
  return layers;
}

const CompositeLayerInfo* findCompositeLayer(std::string_view name) {
  for (const CompositeLayerInfo& info : compositeLayers())
    if (name == info.name) return &info;
  return nullptr;
}

Image compositeLayer(const DifferentialFilm& film, CompositeLayer layer) {
  assert(layer != CompositeLayer::Reflectance);
  Image image(film.width(), film.height(), layer == CompositeLayer::Alpha ? 1 : 3);
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const Rgb value = valueOf(film.at(x, y), layer);
      std::copy_n(&value.x, image.channels, image.at(x, y));
    }
  return image;
}

}  // namespace chromeball
