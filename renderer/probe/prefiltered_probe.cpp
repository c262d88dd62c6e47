// SPDX-License-Identifier: Apache-2.0
#include "probe/prefiltered_probe.h"

#include <bit>

#include "base/error.h"
#include "base/text.h"
#include "probe/convert.h"
#include "probe/convolve.h"
#include "probe/irradiance.h"

namespace chromeball {
namespace {

constexpr double kError = 2e-2;  // of the convolution
constexpr ImageSize kDiffuseSize{128, 64};
constexpr int kMaxWidth = 256;

// Texels of a quarter of the lobe's width: 2 alpha, as seen by the mirror direction.
ImageSize sizeFor(float roughness) {
  const double wanted = 4 * kPiD / (double(roughness) * roughness);
  const int width = wanted < kMaxWidth ? int(std::bit_ceil(unsigned(wanted))) : kMaxWidth;
  return {width, width / 2};
}

Probe filtered(const Image& map, const Rotation& rotation, const ZonalKernel& kernel,
               const ImageSize& size) {
  return Probe(imageOf(size, convolve(map, kernel, texelDirections(size), kError)), rotation);
}

constexpr int kSmallestFace = 16;

// The texel of Mapping::VerticalStrip, whose faces are seen from inside and upright, that OpenGL
// has at (x, y) of a face (OpenGL 4.6, table 8.19): sides are mirrored, top and bottom turned over.
glm::ivec2 stripTexel(int size, int face, int x, int y) {
  const bool isSide = face != 2 && face != 3;
  return {isSide ? size - 1 - x : x, face * size + (isSide ? y : size - 1 - y)};
}

// Calls `visit` with the texel of the strip for each texel of the faces, row by row.
template <class Visit>
void forFaceTexels(int size, const Visit& visit) {
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) visit(stripTexel(size, face, x, y));
}

Image faces(const Image& latLong, int size) {
  const ImageSize strip{size, 6 * size};
  const Image upright = convert(latLong, Mapping::LatLong, Mapping::VerticalStrip, strip);
  std::vector<dvec3> colors;
  forFaceTexels(size, [&](const glm::ivec2& t) { colors.emplace_back(upright.rgb(t.x, t.y)); });
  return imageOf(strip, colors);
}

Image convolvedFaces(const Image& latLong, int size, const ZonalKernel& kernel) {
  const ImageSize strip{size, 6 * size};
  std::vector<vec3> directions;
  forFaceTexels(size, [&](const glm::ivec2& t) {
    directions.emplace_back(*uvToDirection(Mapping::VerticalStrip,
                                           (dvec2(t) + 0.5) / dvec2(strip.width, strip.height)));
  });
  return imageOf(strip, convolve(latLong, kernel, directions));
}

}  // namespace

PrefilteredProbe::PrefilteredProbe(const Probe& probe, std::vector<float> roughnesses)
    : probe_(probe),
      diffuse_(filtered(probe.latLong(), probe.rotation(), ZonalKernel::phong(1), kDiffuseSize)) {
  std::ranges::sort(roughnesses);
  const Image map = probe.latLong();
  for (const float roughness : roughnesses)
    levels_.push_back({roughness, filtered(map, probe.rotation(), ZonalKernel::ggx(roughness),
                                           sizeFor(roughness))});
}

Rgb PrefilteredProbe::radiance(const vec3& direction, float roughness) const {
  size_t above = 0;
  while (above < levels_.size() && levels_[above].roughness < roughness) ++above;
  const bool isLast = above == levels_.size();
  const float from = above == 0 ? 0 : levels_[above - 1].roughness;
  const float to = isLast ? 1 : levels_[above].roughness;
  const float t = (roughness - from) / (to - from);
  Rgb sum(0);
  if (t < 1) sum += (1 - t) * (above == 0 ? probe_ : levels_[above - 1].map).radiance(direction);
  if (t > 0) sum += t * (isLast ? diffuse_ : levels_[above].map).radiance(direction);
  return sum;
}

MipRoughness parseMipRoughness(std::string_view text, std::string_view location) {
  if (text == "khronos") return MipRoughness::Khronos;
  if (text == "filament") return MipRoughness::Filament;
  throwInput("{}: unknown roughness of levels `{}`; {}", location, text,
             didYouMean(text, {"khronos", "filament"}));
}

std::vector<CubeLevel> cubeMips(const Image& latLong, int size, MipRoughness roughness) {
  if (size < 1 || size > 4096 || !std::has_single_bit(unsigned(size)))
    throwInput("faces of {0}x{0} texels: the size should be a power of two from 1 to 4096", size);
  std::vector<CubeLevel> levels{{0, faces(latLong, size)}};
  const int smallest = std::min(size, kSmallestFace);
  const double last = std::bit_width(unsigned(size / smallest)) - 1;
  for (int face = size / 2; face >= smallest; face /= 2) {
    const double t = double(levels.size()) / last;
    const double r = roughness == MipRoughness::Khronos ? t : 1 - std::sqrt(1 - t);
    levels.push_back({r, convolvedFaces(latLong, face, ZonalKernel::ggx(r))});
  }
  return levels;
}

}  // namespace chromeball
