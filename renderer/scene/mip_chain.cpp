// SPDX-License-Identifier: Apache-2.0
#include "scene/mip_chain.h"

#include <algorithm>

#include "base/memory.h"
#include "base/progress.h"

namespace chromeball {
namespace {

double encodeSrgb(double c) {  // IEC 61966-2-1
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

// 8-bit sRGB codes of linear light. The steps are finer than the distance between codes, even where
// the curve is steepest.
constexpr int kCodeSteps = 1 << 14;
const std::vector<uint8_t>& srgbCodes() {
  static const std::vector<uint8_t> kCodes = [] {
    std::vector<uint8_t> codes(kCodeSteps + 1);
    for (int i = 0; i <= kCodeSteps; ++i)
      codes[size_t(i)] = uint8_t(std::lround(255 * encodeSrgb(double(i) / kCodeSteps)));
    return codes;
  }();
  return kCodes;
}

uint8_t code8(float c, bool srgb) {
  c = std::min(c, 1.0f);
  return srgb ? srgbCodes()[size_t(c * kCodeSteps + 0.5f)] : uint8_t(c * 255 + 0.5f);
}

// The texels of a row that one texel of the halved row covers, with the weight of each: two texels,
// or three if the length of the row is odd.
struct Cover {
  int first = 0;
  std::array<float, 3> weight{};
};

std::vector<Cover> covers(int from, int to) {
  std::vector<Cover> all(static_cast<size_t>(to));
  const double width = double(from) / to;
  for (int i = 0; i < to; ++i) {
    const double begin = i * width, end = begin + width;
    Cover& cover = all[size_t(i)];
    cover.first = int(begin);
    for (int k = 0; k < 3; ++k) {
      const double low = std::max(begin, double(cover.first + k));
      const double high = std::min(end, double(cover.first + k + 1));
      cover.weight[size_t(k)] = float(std::max(high - low, 0.0) / width);
    }
  }
  return all;
}

// The common case: one texel for four.
TexelGrid halvedEvenly(const TexelGrid& grid, bool srgb) {
  TexelGrid half{grid.width / 2, grid.height / 2, {}, {}};
  half.texels8 = longArray<std::array<uint8_t, 4>>(size_t(half.width) * size_t(half.height));
  std::array<float, 256> light;  // a quarter of the linear light of each code
  for (int code = 0; code < 256; ++code) {
    const uint8_t c = uint8_t(code);
    light[size_t(code)] = 0.25f * linearTexel({1, 1, {{c, c, c, c}}, {}}, srgb, 0, 0).x;
  }
  const auto mean = [](uint8_t a, uint8_t b, uint8_t c, uint8_t d) {
    return uint8_t((a + b + c + d + 2) / 4);
  };
  for (int y = 0; y < half.height; ++y) {
    endIfCancelled();
    const auto* above = &grid.texels8[size_t(2 * y) * size_t(grid.width)];
    const auto* below = above + grid.width;
    auto* out = &half.texels8[size_t(y) * size_t(half.width)];
    for (int x = 0; x < half.width; ++x, above += 2, below += 2, ++out) {
      for (size_t k = 0; k < 4; ++k)
        if (srgb && k < 3)
          (*out)[k] = code8(
              light[above[0][k]] + light[above[1][k]] + light[below[0][k]] + light[below[1][k]],
              true);
        else
          (*out)[k] = mean(above[0][k], above[1][k], below[0][k], below[1][k]);
    }
  }
  return half;
}

bool isOpaque(const TexelGrid& grid) {
  return std::all_of(grid.texels8.begin(), grid.texels8.end(),
                     [](const auto& texel) { return texel[3] == 255; }) &&
         std::all_of(grid.texelsFloat.begin(), grid.texelsFloat.end(),
                     [](const vec4& texel) { return texel.w == 1; });
}

TexelGrid halved(const TexelGrid& grid, bool srgb, bool weightedByAlpha) {
  if (!weightedByAlpha && !grid.texels8.empty() && grid.width % 2 == 0 && grid.height % 2 == 0)
    return halvedEvenly(grid, srgb);
  TexelGrid half{std::max(grid.width / 2, 1), std::max(grid.height / 2, 1), {}, {}};
  const std::vector<Cover> columns = covers(grid.width, half.width);
  const std::vector<Cover> rows = covers(grid.height, half.height);
  const size_t count = size_t(half.width) * size_t(half.height);
  const bool is8 = !grid.texels8.empty();
  is8 ? reserveLong(half.texels8, count) : reserveLong(half.texelsFloat, count);
  for (const Cover& row : rows) {
    endIfCancelled();
    for (const Cover& column : columns) {
      vec4 mean(0);
      Rgb weighted(0);  // by alpha
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
          if (const float w = row.weight[size_t(j)] * column.weight[size_t(i)]; w > 0) {
            const vec4 texel = linearTexel(grid, srgb, column.first + i, row.first + j);
            mean += w * texel;
            weighted += w * texel.w * Rgb(texel);
          }
      if (weightedByAlpha && mean.w > 0) mean = vec4(weighted / mean.w, mean.w);
      if (is8) {
        half.texels8.push_back(
            {code8(mean.x, srgb), code8(mean.y, srgb), code8(mean.z, srgb), code8(mean.w, false)});
        continue;
      }
      if (srgb)
        for (int k = 0; k < 3; ++k) mean[k] = float(encodeSrgb(mean[k]));
      half.texelsFloat.push_back(mean);
    }
  }
  return half;
}

}  // namespace

std::vector<TexelGrid> makeMipLevels(const TexelGrid& grid, bool srgb, bool weightedByAlpha) {
  weightedByAlpha = weightedByAlpha && !isOpaque(grid);
  std::vector<TexelGrid> levels;
  for (const TexelGrid* last = &grid; last->width > 1 || last->height > 1; last = &levels.back())
    levels.push_back(halved(*last, srgb, weightedByAlpha));
  return levels;
}

}  // namespace chromeball
