// SPDX-License-Identifier: Apache-2.0
#include "film/halved_image.h"

namespace chromeball {
namespace {

void subtract(Image& a, const Image& b) {
  for (size_t i = 0; i < a.texels.size(); ++i) a.texels[i] -= b.texels[i];
}

}  // namespace

HalvedImage operator-(HalvedImage a, const HalvedImage& b) {
  subtract(a.mean, b.mean);
  subtract(a.half, b.half);
  return a;
}

}  // namespace chromeball
