// SPDX-License-Identifier: Apache-2.0
#include "probe/cube_mips.h"

#include <array>
#include <bit>

#include "base/error.h"
#include "base/suggest.h"
#include "probe/convert.h"
#include "probe/convolve.h"

namespace chromeball {
namespace {

constexpr int kSmallestFace = 16;

// OpenGL 4.6, table 8.19: the major axis of a face, and where its texture coordinates grow.
struct Face {
  vec3 forward, right, down;
};
constexpr vec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);
const std::array<Face, 6> kFaces{
    {{kX, -kZ, -kY}, {-kX, kZ, -kY}, {kY, kX, kZ}, {-kY, kX, -kZ}, {kZ, kX, -kY}, {-kZ, -kX, -kY}}};

std::vector<vec3> texelDirections(int size) {
  std::vector<vec3> directions;
  directions.reserve(6 * size_t(size) * size);
  for (const Face& face : kFaces)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const float s = (2 * float(x) + 1) / float(size) - 1,
                    t = (2 * float(y) + 1) / float(size) - 1;
        directions.push_back(glm::normalize(face.forward + s * face.right + t * face.down));
      }
  return directions;
}

// The faces of Mapping::VerticalStrip are seen from inside and upright: those of the sides are
// mirrored here, those of top and bottom turned over.
Image mirrored(const Image& strip, int size) {
  Image faces(size, 6 * size, 3);
  for (int face = 0; face < 6; ++face) {
    const bool isSide = face != 2 && face != 3;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        faces.setRgb(
            x, face * size + y,
            strip.rgb(isSide ? size - 1 - x : x, face * size + (isSide ? y : size - 1 - y)));
  }
  return faces;
}

Image toImage(int size, const std::vector<dvec3>& colors) {
  Image faces(size, 6 * size, 3);
  for (int y = 0; y < faces.height; ++y)
    for (int x = 0; x < size; ++x) faces.setRgb(x, y, Rgb(colors[size_t(y) * size + x]));
  return faces;
}

}  // namespace

MipRoughness parseMipRoughness(std::string_view text, std::string_view location) {
  if (text == "khronos") return MipRoughness::Khronos;
  if (text == "filament") return MipRoughness::Filament;
  throwInput("{}: unknown roughness of levels `{}`; {}", location, text,
             didYouMean(text, {"khronos", "filament"}));
}

std::vector<CubeLevel> cubeMips(const Image& latLong, int size, MipRoughness roughness) {
  if (size < 1 || size > 4096 || !std::has_single_bit(unsigned(size)))
    throwInput("faces of {0}x{0} texels: the size should be a power of two from 1 to 4096", size);
  const Image strip = convert(latLong, Mapping::LatLong, Mapping::VerticalStrip, {size, 6 * size});
  std::vector<CubeLevel> levels{{0, mirrored(strip, size)}};
  const int smallest = std::min(size, kSmallestFace);
  const double last = std::bit_width(unsigned(size / smallest)) - 1;
  for (int face = size / 2; face >= smallest; face /= 2) {
    const double t = double(levels.size()) / last;
    const double r = roughness == MipRoughness::Khronos ? t : 1 - std::sqrt(1 - t);
    levels.push_back(
        {r, toImage(face, convolve(latLong, ZonalKernel::ggx(r), texelDirections(face)))});
  }
  return levels;
}

}  // namespace chromeball
