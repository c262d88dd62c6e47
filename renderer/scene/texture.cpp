// SPDX-License-Identifier: Apache-2.0
#include "scene/texture.h"

#include <immintrin.h>

#include <algorithm>
#include <bit>

#include "base/memory.h"
#include "base/progress.h"
#include "image/io/texel_file.h"

namespace chromeball {
namespace {

double decodeSrgb(double c) {  // IEC 61966-2-1
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

// The sRGB curve at all 8-bit codes.
const std::array<float, 256> kSrgb8 = [] {
  std::array<float, 256> table;
  for (int i = 0; i < 256; ++i) table[i] = float(decodeSrgb(i / 255.0));
  return table;
}();

// The curve at kCurveSteps + 1 equidistant points, for sources of more than 8 bits. Linear
// interpolation between them has an error below 5e-7.
constexpr int kCurveSteps = 1024;
const std::array<float, kCurveSteps + 2> kSrgbCurve = [] {
  std::array<float, kCurveSteps + 2> table;
  for (int i = 0; i <= kCurveSteps + 1; ++i) table[i] = float(decodeSrgb(double(i) / kCurveSteps));
  return table;
}();

float decodeSrgbFast(float c) {
  const float x = std::fmin(std::fmax(c, 0.0f), 1.0f) * kCurveSteps;
  const int i = int(x);
  return kSrgbCurve[i] + (x - float(i)) * (kSrgbCurve[i + 1] - kSrgbCurve[i]);
}

using Float4 = float __attribute__((vector_size(16)));  // RGBA

Float4 mix(Float4 a, Float4 b, float t) { return a * (1 - t) + b * t; }

[[gnu::always_inline]] inline Float4 decode(const std::array<uint8_t, 4>& t, bool srgb) {
  const __m128i codes = _mm_cvtepu8_epi32(_mm_cvtsi32_si128(std::bit_cast<int>(t)));
  const auto linear = Float4(_mm_cvtepi32_ps(codes)) * (1 / 255.0f);
  if (!srgb) return linear;
  return Float4{kSrgb8[t[0]], kSrgb8[t[1]], kSrgb8[t[2]], linear[3]};
}

Float4 decode(const vec4& t, bool srgb) {
  if (!srgb) return Float4{t.x, t.y, t.z, t.w};
  return Float4{decodeSrgbFast(t.x), decodeSrgbFast(t.y), decodeSrgbFast(t.z), t.w};
}

[[gnu::noinline]] Float4 fetchElsewhere(const TexelGrid& grid, bool srgb, int x, int y) {
  if (!grid.file) return decode(grid.texelsFloat[size_t(y) * size_t(grid.width) + size_t(x)], srgb);
  const TexelFile& file = *grid.file;
  return file.has8Bits(grid.fileImage) ? decode(file.texel8(grid.fileImage, x, y), srgb)
                                       : decode(file.texelFloat(grid.fileImage, x, y), srgb);
}

[[gnu::always_inline]] inline Float4 fetch(const TexelGrid& grid, bool srgb, int x, int y) {
  if (grid.texels8.empty()) [[unlikely]]
    return fetchElsewhere(grid, srgb, x, y);
  return decode(grid.texels8[size_t(y) * size_t(grid.width) + size_t(x)], srgb);
}

// Maps a texel index at most one period outside [0, size) into that range. A coordinate after
// reduce(), shifted by a texel for interpolation, is never further outside.
int wrapIndex(int i, int size, Wrap wrap) {
  switch (wrap) {
    case Wrap::Repeat:
      return i < 0 ? i + size : i >= size ? i - size : i;
    case Wrap::ClampToEdge:
      return i < 0 ? 0 : i >= size ? size - 1 : i;
    case Wrap::MirroredRepeat: {
      if (i < 0) i = -1 - i;
      if (i >= size) i = 2 * size - 1 - i;
      return i < 0 ? 0 : i;
    }
  }
  return 0;
}

// Maps a coordinate into [0, 1]: into one period, and for the mirrored wrap also folded. The order
// of the comparisons makes NaN and infinities give 0.
float reduce(float x, Wrap wrap) {
  switch (wrap) {
    case Wrap::Repeat:
      x -= std::floor(x);
      break;
    case Wrap::ClampToEdge:
      break;
    case Wrap::MirroredRepeat:
      x -= 2 * std::floor(0.5f * x);
      if (x > 1) x = 2 - x;
      break;
  }
  if (!(x > 0)) return 0;
  return x < 1 ? x : 1;
}

}  // namespace

size_t TexelGrid::byteCount() const {
  return texels8.size() * sizeof(texels8[0]) + texelsFloat.size() * sizeof(vec4);
}

namespace {

vec4 rgba(Float4 texel) { return {texel[0], texel[1], texel[2], texel[3]}; }

// Precondition of these: `uv` is finite.
template <class Fetch>
[[gnu::always_inline]] inline Float4 bilinear(const Texture& t, const TexelGrid& g, vec2 uv,
                                              const Fetch& fetch) {
  const float x = reduce(uv.x, t.wrapS) * float(g.width) - 0.5f;
  const float y = reduce(uv.y, t.wrapT) * float(g.height) - 0.5f;
  const float fx = std::floor(x), fy = std::floor(y);
  const int x0 = wrapIndex(int(fx), g.width, t.wrapS);
  const int x1 = wrapIndex(int(fx) + 1, g.width, t.wrapS);
  const int y0 = wrapIndex(int(fy), g.height, t.wrapT);
  const int y1 = wrapIndex(int(fy) + 1, g.height, t.wrapT);
  const Float4 top = mix(fetch(g, x0, y0), fetch(g, x1, y0), x - fx);
  const Float4 bottom = mix(fetch(g, x0, y1), fetch(g, x1, y1), x - fx);
  return mix(top, bottom, y - fy);
}

template <class Fetch>
Float4 nearestOrBilinear(const Texture& t, vec2 uv, const Fetch& fetch) {
  const TexelGrid& g = *t.grid;
  if (t.filter == Filter::Linear) return bilinear(t, g, uv, fetch);
  const int x = int(reduce(uv.x, t.wrapS) * float(g.width));
  const int y = int(reduce(uv.y, t.wrapT) * float(g.height));
  return fetch(g, wrapIndex(x, g.width, t.wrapS), wrapIndex(y, g.height, t.wrapT));
}

template <class Fetch>
Float4 trilinear(const Texture& t, vec2 uv, float texels, const Fetch& fetch) {
  // level = log2(texels) / 2, with the logarithm interpolated linearly between powers of two.
  int exponent = 0;
  const float mantissa = 2 * std::frexp(texels, &exponent) - 1;
  const float level = 0.5f * (float(exponent - 1) + mantissa);
  const std::vector<TexelGrid>& levels = *t.mipLevels;
  if (!(level < float(levels.size()))) return bilinear(t, levels.back(), uv, fetch);
  const size_t below = size_t(level);
  const Float4 finer =
      below == 0 ? nearestOrBilinear(t, uv, fetch) : bilinear(t, levels[below - 1], uv, fetch);
  return mix(finer, bilinear(t, levels[below], uv, fetch), level - float(below));
}

// A filtered lookup; mean(fetch) is the weighted mean of fetched texels. If colours are weighted by
// alpha, returns the mean of (alpha colour, alpha), with the colour then divided by alpha.
template <class Mean>
[[gnu::always_inline]] inline vec4 weighted(const Texture& t, const Mean& mean) {
  const bool srgb = t.srgb;
  const auto plain = [srgb](const TexelGrid& g, int x, int y) __attribute__((always_inline)) {
    return fetch(g, srgb, x, y);
  };
  if (!t.weightedByAlpha) return rgba(mean(plain));
  const vec4 sum = rgba(mean([srgb](const TexelGrid& g, int x, int y) {
    const Float4 texel = fetch(g, srgb, x, y);
    return Float4{texel[0], texel[1], texel[2], 1} * texel[3];
  }));
  if (!(sum.w > 0)) return rgba(mean(plain));  // visible if an alpha mask has a cutoff of 0
  return vec4(Rgb(sum) / sum.w, sum.w);
}

}  // namespace

vec4 linearTexel(const TexelGrid& grid, bool srgb, int x, int y) {
  return rgba(fetch(grid, srgb, x, y));
}

vec4 Texture::lookup(vec2 uv) const {
  if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return linearTexel(*grid, srgb, 0, 0);
  return weighted(*this, [&](const auto& fetch) { return nearestOrBilinear(*this, uv, fetch); });
}

vec4 Texture::lookup(vec2 uv, float texels) const {
  if (!(texels > 1) || !mipLevels || mipLevels->empty()) return lookup(uv);
  if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return lookup(uv);
  return weighted(*this, [&](const auto& fetch) { return trilinear(*this, uv, texels, fetch); });
}

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
