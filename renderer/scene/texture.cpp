// SPDX-License-Identifier: Apache-2.0
#include "scene/texture.h"

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

vec4 decode(const std::array<uint8_t, 4>& t, bool srgb) {
  const float alpha = t[3] * (1 / 255.0f);
  if (srgb) return {kSrgb8[t[0]], kSrgb8[t[1]], kSrgb8[t[2]], alpha};
  return vec4(t[0], t[1], t[2], t[3]) * (1 / 255.0f);
}

vec4 decode(const vec4& t, bool srgb) {
  if (!srgb) return t;
  return {decodeSrgbFast(t.x), decodeSrgbFast(t.y), decodeSrgbFast(t.z), t.w};
}

[[gnu::noinline]] vec4 fetchFromFile(const TexelGrid& grid, bool srgb, int x, int y) {
  const TexelFile& file = *grid.file;
  return file.has8Bits(grid.fileImage) ? decode(file.texel8(grid.fileImage, x, y), srgb)
                                       : decode(file.texelFloat(grid.fileImage, x, y), srgb);
}

vec4 fetch(const TexelGrid& grid, bool srgb, int x, int y) {
  const size_t i = size_t(y) * grid.width + x;
  if (!grid.texels8.empty()) return decode(grid.texels8[i], srgb);
  if (grid.file) [[unlikely]]
    return fetchFromFile(grid, srgb, x, y);
  return decode(grid.texelsFloat[i], srgb);
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

vec4 linearTexel(const TexelGrid& grid, bool srgb, int x, int y) { return fetch(grid, srgb, x, y); }

// A filtered lookup; mean(fetch) is the weighted mean of fetched texels. If colours are weighted by
// alpha, returns the mean of (alpha colour, alpha), with the colour then divided by alpha.
template <class Mean>
[[gnu::always_inline]] static inline vec4 weighted(const Texture& t, const Mean& mean) {
  const bool srgb = t.srgb;
  const auto plain = [srgb](const TexelGrid& g, int x, int y) { return fetch(g, srgb, x, y); };
  if (!t.weightedByAlpha) return mean(plain);
  const vec4 sum = mean([srgb](const TexelGrid& g, int x, int y) {
    const vec4 texel = fetch(g, srgb, x, y);
    return vec4(texel.w * Rgb(texel), texel.w);
  });
  if (!(sum.w > 0)) return mean(plain);  // visible if an alpha mask has a cutoff of 0
  return vec4(Rgb(sum) / sum.w, sum.w);
}

vec4 Texture::lookup(vec2 uv) const {
  return weighted(*this, [&](const auto& fetch) { return nearestOrBilinear(uv, fetch); });
}

vec4 Texture::lookup(vec2 uv, float texels) const {
  if (!(texels > 1) || !mipLevels || mipLevels->empty()) return lookup(uv);
  if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return lookup(uv);
  return weighted(*this, [&](const auto& fetch) { return trilinear(uv, texels, fetch); });
}

template <class Fetch>
vec4 Texture::nearestOrBilinear(vec2 uv, const Fetch& fetch) const {
  const TexelGrid& g = *grid;
  if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return fetch(g, 0, 0);
  if (filter == Filter::Linear) return bilinear(g, uv, fetch);
  const int x = int(reduce(uv.x, wrapS) * float(g.width));
  const int y = int(reduce(uv.y, wrapT) * float(g.height));
  return fetch(g, wrapIndex(x, g.width, wrapS), wrapIndex(y, g.height, wrapT));
}

template <class Fetch>
vec4 Texture::trilinear(vec2 uv, float texels, const Fetch& fetch) const {
  // level = log2(texels) / 2, with the logarithm interpolated linearly between powers of two.
  int exponent = 0;
  const float mantissa = 2 * std::frexp(texels, &exponent) - 1;
  const float level = 0.5f * (float(exponent - 1) + mantissa);
  const size_t last = mipLevels->size();
  if (!(level < float(last))) return bilinear(mipLevels->back(), uv, fetch);
  const size_t below = size_t(level);
  const vec4 finer =
      below == 0 ? nearestOrBilinear(uv, fetch) : bilinear((*mipLevels)[below - 1], uv, fetch);
  return glm::mix(finer, bilinear((*mipLevels)[below], uv, fetch), level - float(below));
}

// Precondition: `uv` is finite.
template <class Fetch>
vec4 Texture::bilinear(const TexelGrid& g, vec2 uv, const Fetch& fetch) const {
  const float x = reduce(uv.x, wrapS) * float(g.width);
  const float y = reduce(uv.y, wrapT) * float(g.height);
  const float fx = std::floor(x - 0.5f), fy = std::floor(y - 0.5f);
  const float tx = x - 0.5f - fx, ty = y - 0.5f - fy;
  const int x0 = wrapIndex(int(fx), g.width, wrapS), x1 = wrapIndex(int(fx) + 1, g.width, wrapS);
  const int y0 = wrapIndex(int(fy), g.height, wrapT), y1 = wrapIndex(int(fy) + 1, g.height, wrapT);
  const vec4 top = glm::mix(fetch(g, x0, y0), fetch(g, x1, y0), tx);
  const vec4 bottom = glm::mix(fetch(g, x0, y1), fetch(g, x1, y1), tx);
  return glm::mix(top, bottom, ty);
}

}  // namespace chromeball
