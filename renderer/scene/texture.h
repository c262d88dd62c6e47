// SPDX-License-Identifier: Apache-2.0
// A 2D texture. Texels are stored as in the file (8 bits stay 8 bits) and decoded on lookup.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "math/vec.h"

namespace chromeball {

class TexelFile;

// The texels of an image file, shared by all textures that use it. Always four channels; exactly
// one of the two arrays is filled, or none if the texels are in a file.
struct TexelGrid {
  int width = 0, height = 0;
  std::vector<std::array<uint8_t, 4>> texels8;  // 8-bit sources
  std::vector<vec4> texelsFloat;                // sources of more bits; 0..1 for integer files
  const TexelFile* file = nullptr;              // image/io/texel_file.h; null: in memory
  int fileImage = -1;                           // index in it

  size_t byteCount() const;  // of the texels in memory
};

using MipChain = std::shared_ptr<const std::vector<TexelGrid>>;

enum class Wrap : uint8_t { Repeat, ClampToEdge, MirroredRepeat };
enum class Filter : uint8_t { Linear, Nearest };

// An image with a sampler (glTF 2.0, 3.8). `srgb`: RGB is sRGB-encoded and decoded on lookup;
// alpha is always linear.
struct Texture {
  const TexelGrid* grid = nullptr;
  Wrap wrapS = Wrap::Repeat, wrapT = Wrap::Repeat;
  Filter filter = Filter::Linear;
  bool srgb = false;
  // Whether filtering weights colours by alpha, so that the colours of transparent texels do not
  // bleed into opaque ones. True for the base colour of blended or masked materials.
  bool weightedByAlpha = false;
  MipChain mipLevels;  // null: none

  // Linear RGBA at uv (v down, texel centres at +0.5). Any finite uv is valid; others give texel 0.
  vec4 lookup(vec2 uv) const;

  // The mean of an area of about `texels` texels around uv: trilinear between mip levels (Williams
  // 1983). Up to one texel it is lookup(uv).
  vec4 lookup(vec2 uv, float texels) const;
};

// Linear RGBA of one texel.
vec4 linearTexel(const TexelGrid& grid, bool srgb, int x, int y);

inline constexpr int kMaxUvSet = 15;  // of TEXCOORD_n

// A material's use of a texture: its index, its UV set and its transform (KHR_texture_transform:
// uv' = offset + R(rotation) S(scale) uv).
struct TextureSlot {
  int texture = -1;                              // index into Scene::textures; -1: none
  int uvSet = 0;                                 // 0 to kMaxUvSet
  vec2 uvRow0{1, 0}, uvRow1{0, 1}, uvOffset{0};  // uv' = (dot(row0,uv), dot(row1,uv)) + offset

  explicit operator bool() const { return texture >= 0; }
  vec2 transform(vec2 uv) const {
    return vec2(glm::dot(uvRow0, uv), glm::dot(uvRow1, uv)) + uvOffset;
  }
  // The factor by which the transform scales areas.
  float areaFactor() const { return std::fabs(uvRow0.x * uvRow1.y - uvRow0.y * uvRow1.x); }
};

// The grid at half its size, at a quarter, and so on down to one texel; empty for a grid of one
// texel. Each texel is the mean, in linear light, of the texels it covers, stored like those of the
// grid (`srgb`: encoded). With `weightedByAlpha`, colours are weighted by alpha unless all alphas
// are 0.
std::vector<TexelGrid> makeMipLevels(const TexelGrid& grid, bool srgb,
                                     bool weightedByAlpha = false);

}  // namespace chromeball
