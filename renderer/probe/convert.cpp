// SPDX-License-Identifier: Apache-2.0
#include "probe/convert.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "probe/probe.h"
#include "probe/rasterize.h"

namespace chromeball {
namespace {

int roundUpToEven(double length) { return std::max(2, 2 * int(std::ceil(0.5 * length - 1e-9))); }

// Bilinear interpolation within the disc or within one cube face.
class PatchSource {
 public:
  PatchSource(const Image& image, Mapping mapping)
      : image_(image),
        mapping_(mapping),
        faceWidth_(image.width / faceLayout(mapping).columns),
        faceHeight_(image.height / faceLayout(mapping).rows) {}

  dvec3 radiance(const dvec3& direction) const {
    dvec2 uv = directionToUv(mapping_, direction);
    if (isDisc()) {
      // At most to half a texel inside the rim, where at least one of the four texels is inside.
      const dvec2 fromCentre = uv - 0.5;
      const double radius = glm::length(fromCentre), maximum = 0.5 - 0.5 / image_.width;
      if (radius > maximum) uv = 0.5 + fromCentre * (maximum / radius);
    }
    const double x = uv.x * image_.width, y = uv.y * image_.height;
    const int left = std::min(int(x) / faceWidth_ * faceWidth_, image_.width - faceWidth_);
    const int top = std::min(int(y) / faceHeight_ * faceHeight_, image_.height - faceHeight_);
    const double cornerX = std::floor(x - 0.5), cornerY = std::floor(y - 0.5);
    const double s = x - 0.5 - cornerX, t = y - 0.5 - cornerY;

    dvec3 sum(0);
    double sumWeight = 0;
    for (int k = 0; k < 4; ++k) {
      const int dx = k & 1, dy = k >> 1;
      const int texelX = std::clamp(int(cornerX) + dx, left, left + faceWidth_ - 1);
      const int texelY = std::clamp(int(cornerY) + dy, top, top + faceHeight_ - 1);
      if (isDisc() && !insideDisc(texelX, texelY)) continue;
      const double weight = (dx ? s : 1 - s) * (dy ? t : 1 - t);
      sum += weight * dvec3(image_.rgb(texelX, texelY));
      sumWeight += weight;
    }
    return sumWeight > 0 ? sum / sumWeight : dvec3(0);
  }

 private:
  bool isDisc() const { return mapping_ == Mapping::AngularMap || mapping_ == Mapping::MirrorBall; }
  bool insideDisc(int x, int y) const {
    const dvec2 fromCentre = dvec2((x + 0.5) / image_.width, (y + 0.5) / image_.height) - 0.5;
    return glm::dot(fromCentre, fromCentre) <= 0.25;
  }

  const Image& image_;
  Mapping mapping_;
  int faceWidth_, faceHeight_;
};

// The texels that show a direction: not those around a disc, or between the arms of a cross.
double texelsInUse(Mapping mapping, const ImageSize& image) {
  const auto [columns, rows] = faceLayout(mapping);
  const double all = double(image.width) * image.height;
  if (mapping == Mapping::AngularMap || mapping == Mapping::MirrorBall) return all * kPiD / 4;
  return columns * rows > 1 ? all * 6 / (columns * rows) : all;
}

// Samples along the side of a target texel: two per source texel that it covers, at least two; more
// for the angular map, whose texels are wider at its rim than in its centre, by angle / sin(angle).
int samplesPerSide(Mapping from, const ImageSize& source, Mapping to, const ImageSize& target) {
  const double texels = texelsInUse(from, source) / texelsInUse(to, target);
  const double perTexel = to == Mapping::AngularMap ? 4 : 2;
  return std::max(2, int(std::ceil(perTexel * std::sqrt(texels))));
}

glm::dmat3 turnAboutY(double degrees) {
  const double angle = degrees * kPiD / 180, c = std::cos(angle), s = std::sin(angle);
  return glm::dmat3(c, 0, -s, 0, 1, 0, s, 0, c);
}

// Resamples a cube map or a disc.
Image resample(const Image& image, Mapping from, Mapping to, const ImageSize& size,
               const glm::dmat3& rotation) {
  const int samples = samplesPerSide(from, {image.width, image.height}, to, size);
  const PatchSource patches(image, from);
  const glm::dmat3 back = glm::transpose(rotation);
  return rasterize(to, size, samples, [&](const dvec3& d) { return patches.radiance(back * d); });
}

}  // namespace

ImageSize latLongSize(Mapping mapping, const ImageSize& image) {
  const int faceWidth = image.width / faceLayout(mapping).columns;
  double height = 2.0 * faceWidth;
  if (mapping == Mapping::LatLong) return image;
  if (mapping == Mapping::AngularMap) height = 0.5 * image.width;
  if (mapping == Mapping::MirrorBall) height = 0.25 * kPiD * image.width;
  return {2 * roundUpToEven(height), roundUpToEven(height)};
}

ImageSize sizeFor(Mapping mapping, const ImageSize& latLong) {
  const auto [columns, rows] = faceLayout(mapping);
  int face = roundUpToEven(0.5 * latLong.height);
  if (mapping == Mapping::LatLong) return latLong;
  if (mapping == Mapping::AngularMap) face = roundUpToEven(2.0 * latLong.height);
  if (mapping == Mapping::MirrorBall) face = roundUpToEven(latLong.height * 4 / kPiD);
  return {face * columns, face * rows};
}

Image convert(const Image& image, Mapping from, Mapping to, const ImageSize& size,
              float rotationDegrees) {
  if (parseMapping(mappingName(to), size.width, size.height, "convert") != to)
    throwInput("convert: {} x {} is the wrong aspect ratio for this {} layout", size.width,
               size.height, mappingName(to));
  const ImageSize source{image.width, image.height};
  if (from == to && rotationDegrees == 0 && size.width == image.width &&
      size.height == image.height)
    return image;

  if (from == Mapping::LatLong) {
    const int samples = samplesPerSide(from, source, to, size);
    const Probe probe(image, rotationDegrees);
    return rasterize(to, size, samples,
                     [&](const dvec3& d) { return dvec3(probe.radiance(vec3(d))); });
  }
  return resample(image, from, to, size, turnAboutY(double(rotationDegrees)));
}

Image latLongOf(const Image& image, Mapping from, const glm::dmat3& rotation) {
  return resample(image, from, Mapping::LatLong, latLongSize(from, {image.width, image.height}),
                  rotation);
}

}  // namespace chromeball
