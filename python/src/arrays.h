// SPDX-License-Identifier: Apache-2.0
// Arrays from and for numpy. Those from it have their types, and are contiguous
// (python/chromeball/_arrays.py).
#pragma once

#include <nanobind/ndarray.h>

#include <span>
#include <vector>

#include "image/image.h"
#include "math/vec.h"

namespace chromeball::python {

namespace nb = nanobind;

template <class Number>
using ArrayIn = nb::ndarray<const Number, nb::c_contig, nb::device::cpu>;
template <class Number>
using ArrayOut = nb::ndarray<nb::numpy, Number>;

// The elements as vectors of GLM, for an array whose last axis has as many numbers.
template <class Vector, class Number>
std::vector<Vector> vectorsOf(const ArrayIn<Number>& array) {
  const auto* first = reinterpret_cast<const Vector*>(array.data());
  return {first, first + array.size() * sizeof(Number) / sizeof(Vector)};
}

// [N,3]
template <class Number, class Vector>
ArrayOut<Number> arrayOf(std::vector<Vector> vectors) {
  static_assert(sizeof(Vector) == 3 * sizeof(Number));
  auto* kept = new std::vector<Vector>(std::move(vectors));
  const nb::capsule owner(kept,
                          [](void* p) noexcept { delete static_cast<std::vector<Vector>*>(p); });
  return {reinterpret_cast<Number*>(kept->data()), {kept->size(), 3}, owner};
}

// [N], or [N / columns, columns]
template <class Number>
ArrayOut<Number> listOf(std::vector<Number> numbers, size_t columns = 1) {
  auto* kept = new std::vector<Number>(std::move(numbers));
  const nb::capsule owner(kept,
                          [](void* p) noexcept { delete static_cast<std::vector<Number>*>(p); });
  const size_t shape[] = {kept->size() / columns, columns};
  return {kept->data(), columns == 1 ? size_t(1) : size_t(2), shape, owner};
}

// [H,W,C], as long as `owner` lives.
inline nb::ndarray<nb::numpy, const float> viewOf(const Image& image, nb::handle owner) {
  const size_t shape[] = {size_t(image.height), size_t(image.width), size_t(image.channels)};
  return {image.texels.data(), image.channels == 1 ? size_t(2) : size_t(3), shape, owner};
}

inline ArrayOut<float> arrayOf(Image image) {
  auto* kept = new Image(std::move(image));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<Image*>(p); });
  const size_t shape[] = {size_t(kept->height), size_t(kept->width), size_t(kept->channels)};
  return {kept->texels.data(), 3, shape, owner};
}

// [H,W,C]
inline Image imageOf(const ArrayIn<float>& array) {
  Image image(int(array.shape(1)), int(array.shape(0)), int(array.shape(2)));
  std::copy_n(array.data(), array.size(), image.texels.begin());
  return image;
}

}  // namespace chromeball::python
