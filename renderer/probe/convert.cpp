// SPDX-License-Identifier: Apache-2.0
#include "probe/convert.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "probe/probe.h"

namespace chromeball {
namespace {

int roundUpToEven(double length) { return std::max(2, 2 * int(std::ceil(0.5 * length - 1e-9))); }

// Bilinear interpolation within the disc or within one cube face.
class PatchSource {
 public:
  PatchSource(const Image& image, Mapping mapping)
      : image_(image),
        mapping_(mapping),
        isDisc_(mapping.disc().has_value()),
        faceWidth_(image.width / faceLayout(mapping).columns),
        faceHeight_(image.height / faceLayout(mapping).rows) {}

  dvec3 radiance(const dvec3& direction) const {
    dvec2 uv = directionToUv(mapping_, direction);
    if (isDisc_) {
      constexpr double kRounding = 1e-9;
      const dvec2 fromCentre = uv - 0.5;
      const double radius = glm::length(fromCentre), maximum = 0.5 - 0.5 / image_.width;
      if (radius > 0.5 + kRounding) return dvec3(0);  // the disc does not show this direction
      // Clamped to half a texel inside the rim, where at least one of the four texels is inside.
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
      if (isDisc_ && !insideDisc(texelX, texelY)) continue;
      const double weight = (dx ? s : 1 - s) * (dy ? t : 1 - t);
      sum += weight * dvec3(image_.rgb(texelX, texelY));
      sumWeight += weight;
    }
    return sumWeight > 0 ? sum / sumWeight : dvec3(0);
  }

 private:
  bool insideDisc(int x, int y) const {
    const dvec2 fromCentre = dvec2((x + 0.5) / image_.width, (y + 0.5) / image_.height) - 0.5;
    return glm::dot(fromCentre, fromCentre) <= 0.25;
  }

  const Image& image_;
  Mapping mapping_;
  bool isDisc_;
  int faceWidth_, faceHeight_;
};

// The texels that show a direction: not those around a disc, or between the arms of a cross. For a
// disc that shows a part of the sphere, as many as the whole sphere would have.
double texelsInUse(Mapping mapping, const ImageSize& image) {
  const auto [columns, rows] = faceLayout(mapping);
  const double all = double(image.width) * image.height;
  if (const std::optional<Fisheye> lens = mapping.disc())
    return all * kPiD / 4 * (4 * kPiD / lens->solidAngle());
  return columns * rows > 1 ? all * 6 / (columns * rows) : all;
}

// Samples along the side of a target texel: two per source texel that it covers, at least two; more
// for discs that are not of equal area: the angular map's texels are wider at its rim than in its
// centre, by angle / sin(angle).
int samplesPerSide(Mapping from, const ImageSize& source, Mapping to, const ImageSize& target) {
  const double texels = texelsInUse(from, source) / texelsInUse(to, target);
  const std::optional<Fisheye> lens = to.disc();
  const double perTexel = lens && lens->projection != FisheyeProjection::Equisolid ? 4 : 2;
  return std::max(2, int(std::ceil(perTexel * std::sqrt(texels))));
}

glm::dmat3 matrixOf(const Rotation& rotation) {
  return {rotation(dvec3(1, 0, 0)), rotation(dvec3(0, 1, 0)), rotation(dvec3(0, 0, 1))};
}

// Resamples a cube map or a disc.
Image resample(const Image& image, Mapping from, Mapping to, const ImageSize& size,
               const glm::dmat3& rotation) {
  const int samples = samplesPerSide(from, {image.width, image.height}, to, size);
  const PatchSource patches(image, from);
  const glm::dmat3 back = glm::transpose(rotation);
  return rasterize(to, size, samples, [&](const dvec3& d) { return patches.radiance(back * d); });
}

// The height of a lat-long map over the diameter of a disc whose centre has the same detail.
double heightOverDiameter(const Fisheye& lens) {
  return 0.5 * kPiD / std::sqrt(lens.solidAngleJacobian(0));
}

// A weighted mean; black if nothing was added.
struct Mean {
  dvec3 sum{0};
  double weight = 0;

  void add(double w, const dvec3& radiance) {
    sum += w * radiance;
    weight += w;
  }
  operator Rgb() const { return weight > 0 ? Rgb(sum / weight) : Rgb(0); }
};

// Sines and cosines of the angles at the samples of one side of a lat-long map.
std::vector<dvec2> sinesAndCosines(int samples, double from, double to) {
  std::vector<dvec2> table(static_cast<size_t>(samples));
  for (int i = 0; i < samples; ++i) {
    const double angle = from + (to - from) * (i + 0.5) / samples;
    table[size_t(i)] = {std::sin(angle), std::cos(angle)};
  }
  return table;
}

// Faster for lat-long maps: azimuth depends on x alone and polar angle on y alone, so tables serve
// for both.
Image rasterizeLatLong(const ImageSize& size, int samplesPerSide,
                       const std::function<dvec3(const dvec3&)>& radiance) {
  Image out(size.width, size.height, 3);
  const int n = samplesPerSide;
  const std::vector<dvec2> phi = sinesAndCosines(n * size.width, -kPiD, kPiD);
  const std::vector<dvec2> theta = sinesAndCosines(n * size.height, 0, kPiD);
  parallelFor(0, size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) {
      Mean mean;
      for (int j = n * y; j < n * (y + 1); ++j)
        for (int i = n * x; i < n * (x + 1); ++i) {
          const dvec2 &p = phi[size_t(i)], &t = theta[size_t(j)];
          mean.add(t.x, radiance({t.x * p.x, t.y, -t.x * p.y}));
        }
      out.setRgb(x, y, mean);
    }
  });
  return out;
}

}  // namespace

ImageSize latLongSize(Mapping mapping, const ImageSize& image) {
  if (mapping == Mapping::LatLong) return image;
  const std::optional<Fisheye> lens = mapping.disc();
  const double height = lens ? image.width * heightOverDiameter(*lens)
                             : 2.0 * (image.width / faceLayout(mapping).columns);
  constexpr double kMostRows = 8192;
  const int rows =
      roundUpToEven(mapping.kind() == Mapping::FisheyeDisc ? std::min(height, kMostRows) : height);
  return {2 * rows, rows};
}

ImageSize sizeFor(Mapping mapping, const ImageSize& latLong) {
  if (mapping == Mapping::LatLong) return latLong;
  const auto [columns, rows] = faceLayout(mapping);
  const std::optional<Fisheye> lens = mapping.disc();
  const int face =
      roundUpToEven(lens ? latLong.height / heightOverDiameter(*lens) : 0.5 * latLong.height);
  return {face * columns, face * rows};
}

Image convert(const Image& image, Mapping from, Mapping to, const ImageSize& size,
              const Rotation& rotation) {
  if (parseMapping(mappingName(to), size.width, size.height, "convert") != to)
    throwInput("convert: {} x {} is the wrong aspect ratio for this {} layout", size.width,
               size.height, mappingName(to));
  const ImageSize source{image.width, image.height};
  if (from == to && rotation == Rotation() && size.width == image.width &&
      size.height == image.height)
    return image;

  if (from == Mapping::LatLong) {
    const int samples = samplesPerSide(from, source, to, size);
    const Probe probe(image, rotation);
    return rasterize(to, size, samples,
                     [&](const dvec3& d) { return dvec3(probe.radiance(vec3(d))); });
  }
  return resample(image, from, to, size, matrixOf(rotation));
}

Image latLongOf(const Image& image, Mapping from, const glm::dmat3& rotation) {
  return resample(image, from, Mapping::LatLong, latLongSize(from, {image.width, image.height}),
                  rotation);
}

Image rasterize(Mapping mapping, const ImageSize& size, int samplesPerSide,
                const std::function<dvec3(const dvec3&)>& radiance) {
  if (mapping == Mapping::LatLong) return rasterizeLatLong(size, samplesPerSide, radiance);
  Image out(size.width, size.height, 3);
  const auto meanOverTexel = [&](int x, int y) {
    Mean mean;
    for (int j = 0; j < samplesPerSide; ++j)
      for (int i = 0; i < samplesPerSide; ++i) {
        const dvec2 uv((x + (i + 0.5) / samplesPerSide) / size.width,
                       (y + (j + 0.5) / samplesPerSide) / size.height);
        if (const std::optional<dvec3> direction = uvToDirection(mapping, uv))
          mean.add(solidAngleJacobian(mapping, uv), radiance(*direction));
      }
    return mean;
  };
  parallelFor(0, size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) out.setRgb(x, y, meanOverTexel(x, y));
  });
  return out;
}

DisplayTransform previewTransform(const Image& latLong) {
  constexpr float kMiddleGrey = 0.18f;
  const float mean = luminance(Rgb(meanRadiance(latLong)));
  if (mean == 0) return {};
  double logarithms = 0;
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x)
      logarithms += std::log2(std::fmax(luminance(latLong.rgb(x, y)), 1e-4f * mean));
  const double texels = double(latLong.width) * latLong.height;
  return {ToneOperator::Reinhard, std::log2(kMiddleGrey) - float(logarithms / texels)};
}

Image probePreview(const Probe& probe, int width) {
  const DisplayTransform transform = previewTransform(probe.latLong());
  const ImageSize size{width, width / 2};
  return colorImage(size.width, size.height, [&](int x, int y) {
    return display(transform, probe.radiance(vec3(texelDirection(size, x, y))));
  });
}

using glm::dvec3;

double PinholeView::pixelAngle() const { return 2 * std::tan(glm::radians(fov) / 2) / size.height; }

dvec3 PinholeView::direction(double x, double y) const {
  const double pixel = pixelAngle();
  return pose(
      glm::normalize(dvec3((x - 0.5 * size.width) * pixel, (0.5 * size.height - y) * pixel, -1)));
}

Image crop(const Image& latLong, const PinholeView& view) {
  const Probe probe(latLong);
  // Two samples per texel between two directions.
  const auto samplesBetween = [&](const dvec3& a, const dvec3& b) {
    const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
    return std::max(2, int(std::ceil(2 * angle * latLong.height / kPiD)));
  };
  Image out(view.size.width, view.size.height, 3);
  parallelFor(0, out.height, [&](int y) {
    for (int x = 0; x < out.width; ++x) {
      const int columns =
                    samplesBetween(view.direction(x, y + 0.5), view.direction(x + 1, y + 0.5)),
                rows = samplesBetween(view.direction(x + 0.5, y), view.direction(x + 0.5, y + 1));
      dvec3 sum(0);
      for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
          sum += dvec3(
              probe.radiance(vec3(view.direction(x + (i + 0.5) / columns, y + (j + 0.5) / rows))));
      out.setRgb(x, y, Rgb(sum / (double(columns) * rows)));
    }
  });
  return out;
}

int rowsOfCrop(const Image& latLong, double fov) {
  const double rows = 2 * std::tan(glm::radians(fov) / 2) * latLong.height / kPiD;
  return int(std::lround(std::clamp(rows, 1.0, 1e6)));
}

}  // namespace chromeball
