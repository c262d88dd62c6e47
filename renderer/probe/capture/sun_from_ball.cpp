// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/sun_from_ball.h"

#include "base/error.h"
#include "base/file.h"
#include "image/io/read_image.h"
#include "probe/convert.h"
#include "probe/irradiance.h"

namespace chromeball {
namespace {

constexpr double kMaxRadius = 128;  // in blocks
constexpr size_t kMinSamples = 100;

// Blocks of a photograph of a ball.
class Blocks {
 public:
  Blocks(const DiffuseBall& ball, const Image& photograph, const Image& excluded)
      : ball_(ball),
        photograph_(photograph),
        excluded_(excluded),
        size_(int(std::ceil(ball.circle.radius / kMaxRadius))),
        left_(int(std::floor(ball.circle.centre.x - ball.circle.radius))),
        top_(int(std::floor(ball.circle.centre.y - ball.circle.radius))) {}

  int size() const { return size_; }
  int side() const { return int(std::ceil((2 * ball_.circle.radius + 1) / size_)); }

  // nullopt unless all of the block is inside the circle and counts. Adds its invalid pixels to
  // `invalid`.
  std::optional<BallSample> sample(int x, int y, size_t& invalid) const {
    const dvec2 corner(left_ + x * size_, top_ + y * size_);
    for (int i = 0; i < 4; ++i)
      if (glm::distance(corner + double(size_) * dvec2(i & 1, i >> 1), ball_.circle.centre) >
          ball_.circle.radius)
        return std::nullopt;
    dvec3 sum(0);
    size_t invalidHere = 0;
    for (int j = 0; j < size_; ++j)
      for (int i = 0; i < size_; ++i) {
        const int px = int(corner.x) + i, py = int(corner.y) + j;
        if (!excluded_.empty() && *excluded_.at(px, py) > 0.5f) return std::nullopt;
        const Rgb c = photograph_.rgb(px, py);
        invalidHere += !isFinite(c) || std::min({c.x, c.y, c.z}) < 0;
        sum += dvec3(c);
      }
    invalid += invalidHere;
    if (invalidHere > 0) return std::nullopt;
    const dvec2 fromCentre = (corner + size_ / 2.0 - ball_.circle.centre) / ball_.circle.radius;
    return BallSample{x, y, vec3(ball_.normalAt({fromCentre.x, -fromCentre.y})),
                      sum / double(size_ * size_) / ball_.paint};
  }

 private:
  const DiffuseBall& ball_;
  const Image &photograph_, &excluded_;
  int size_, left_, top_;
};

// The radiance of a white ball in the light of the probe, at each sample.
std::vector<dvec3> radianceOf(const Image& probe, const BallSamples& ball) {
  std::vector<vec3> normals;
  normals.reserve(ball.samples.size());
  for (const BallSample& sample : ball.samples) normals.push_back(sample.normal);
  std::vector<dvec3> radiance = exactIrradiance(probe, normals);
  for (dvec3& r : radiance) r /= kPiD;
  return radiance;
}

dvec3 meanOf(const std::vector<dvec3>& values) {
  dvec3 sum(0);
  for (const dvec3& value : values) sum += value;
  return sum / double(values.size());
}

double rmsOf(const std::vector<dvec3>& values) {
  double sum = 0;
  for (const dvec3& value : values) sum += glm::dot(value, value);
  return std::sqrt(sum / (3 * double(values.size())));
}

constexpr float kPlateau = 0.98f;

// Three channels: 1 where the probe shows as much as it can, else 0.
Image marked(const Image& latLong, const Image* clipped) {
  float maximum = 0;
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x)
      maximum = std::max(maximum, luminance(latLong.rgb(x, y)));
  return colorImage(latLong.width, latLong.height, [&](int x, int y) {
    const bool isMarked = clipped
                              ? *clipped->at(x, y) > 0.5f
                              : maximum > 0 && luminance(latLong.rgb(x, y)) >= kPlateau * maximum;
    return Rgb(isMarked ? 1 : 0);
  });
}

struct Region {
  std::vector<Texel> texels;
  double solidAngle = 0;
};

std::vector<Region> regionsOf(const Image& marks) {
  std::vector<Region> regions;
  for (std::vector<Texel>& texels : brightRegions(marks, 0.5)) {
    Region& region = regions.emplace_back(Region{std::move(texels)});
    for (const Texel t : region.texels)
      region.solidAngle += texelSolidAngle(t.y, marks.width, marks.height);
  }
  return regions;
}

}  // namespace

// A point that is seen at the angle b from the axis is hit at the angle of incidence i, sin(i) =
// distance x sin(b), and its normal is at i - b from the axis.
dvec3 DiffuseBall::normalAt(const dvec2& point) const {
  const double r = std::min(glm::length(point), 1.0);
  double sine = r;  // of the normal's angle from the axis
  if (std::isfinite(distance)) {
    const double b = std::atan(r / std::sqrt(distance * distance - 1));
    sine = std::sin(std::asin(std::min(distance * std::sin(b), 1.0)) - b);
  }
  const dvec2 across = r > 0 ? point * (sine / r) : dvec2(0);
  return glm::normalize(camera.axes() * dvec3(across, std::sqrt(1 - sine * sine)));
}

BallSamples sampleBall(const DiffuseBall& ball, const Image& photograph, const Image& excluded,
                       const std::string& name) {
  const dvec2 least = ball.circle.centre - ball.circle.radius,
              most = ball.circle.centre + ball.circle.radius;
  if (!(least.x >= 0 && least.y >= 0 && most.x <= photograph.width && most.y <= photograph.height))
    throwInput("{}: the circle {:g},{:g},{:g} is not inside its {} x {} pixels", name,
               ball.circle.centre.x, ball.circle.centre.y, ball.circle.radius, photograph.width,
               photograph.height);
  const Blocks blocks(ball, photograph, excluded);
  BallSamples result{.side = blocks.side(), .block = blocks.size()};
  for (int y = 0; y < result.side; ++y)
    for (int x = 0; x < result.side; ++x)
      if (const auto sample = blocks.sample(x, y, result.invalid))
        result.samples.push_back(*sample);
  if (result.samples.size() < kMinSamples)
    throwInput("{}: {} pixels of the ball are left; at least {} are needed", name,
               result.samples.size(), kMinSamples);
  return result;
}

SunFromBall solveSun(const Image& clipped, const BallSamples& ball, const dvec3& direction,
                     double angle) {
  constexpr double kLeastLit = 0.01;
  const size_t count = ball.samples.size();
  const std::vector<dvec3> fromProbe = radianceOf(clipped, ball);
  const Sun test{direction, dvec3(kPiD), angle};
  std::vector<dvec3> real(count), fromSun(count), fromTest(count);
  for (size_t i = 0; i < count; ++i) {
    real[i] = ball.samples[i].radiance;
    fromSun[i] = real[i] - fromProbe[i];
    fromTest[i] = test.irradianceOn(dvec3(ball.samples[i].normal)) / kPiD;
  }
  if (!(meanOf(fromTest).x > kLeastLit))
    throwInput(
        "direction: the sun at {:.3f} {:.3f} {:.3f} lights less than the rim of what the camera "
        "sees of the ball",
        direction.x, direction.y, direction.z);

  SunFromBall result{.sun = test, .alpha = meanOf(fromSun) / meanOf(fromTest)};
  if (!(std::min({result.alpha.x, result.alpha.y, result.alpha.z}) > 0))
    throwInput(
        "the diffuse ball is darker than the probe alone lights it: {:.4g} {:.4g} {:.4g} of its "
        "mean; do both have the same exposure, and is the paint right?",
        (meanOf(fromSun) / meanOf(real)).x, (meanOf(fromSun) / meanOf(real)).y,
        (meanOf(fromSun) / meanOf(real)).z);
  result.sun.irradiance = kPiD * result.alpha;

  const double mean = glm::dot(meanOf(real), dvec3(1)) / 3;
  std::vector<dvec3> residual(count);
  size_t explained = 0;
  result.residual = Image(ball.side, ball.side, 3);
  for (size_t i = 0; i < count; ++i) {
    residual[i] = fromSun[i] - result.alpha * fromTest[i];
    const dvec3 size = glm::abs(residual[i]);
    explained += std::max({size.x, size.y, size.z}) <= kExplained * mean;
    result.residual.setRgb(ball.samples[i].x, ball.samples[i].y, Rgb(residual[i]));
  }
  result.rmsOfProbe = rmsOf(fromSun) / mean;
  result.rms = rmsOf(residual) / mean;
  result.explained = double(explained) / double(count);
  return result;
}

std::optional<Image> loadClippedLayer(const std::filesystem::path& path, const LoadedProbe& probe) {
  if (lowerExtension(path) != ".exr") return std::nullopt;
  const std::optional<Image> layer = layerOf(readImageFile(path), "clipped", path);
  if (!layer) return std::nullopt;
  const Image marks = colorImage(layer->width, layer->height, [&](int x, int y) {
    return Rgb(*layer->at(x, y) > 0.5f ? 1 : 0);
  });
  const Image map = convert(marks, probe.mapping, Mapping::LatLong,
                            {probe.latLong.width, probe.latLong.height}, probe.turned ? 180 : 0);
  Image clipped(map.width, map.height, 1);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) *clipped.at(x, y) = map.rgb(x, y).x;
  return clipped;
}

ClippedSun findClippedSun(const Image& latLong, const Image* clipped, const std::string& name) {
  const Image marks = marked(latLong, clipped);
  const std::vector<Region> regions = regionsOf(marks);
  if (regions.empty())
    throwInput("{}: {}; give the direction", name,
               clipped ? "its layer `clipped` marks no texel" : "is black");
  const auto bySize = [](const Region& a, const Region& b) { return a.solidAngle < b.solidAngle; };
  const Region& largest = *std::ranges::max_element(regions, bySize);

  const ImageSize size{marks.width, marks.height};
  dvec3 sum(0);
  for (const Texel t : largest.texels)
    sum += texelDirection(size, t.x, t.y) * texelSolidAngle(t.y, size.width, size.height);
  if (!(glm::length(sum) > 0.1 * largest.solidAngle))
    throwInput("{}: what is as bright as it can show surrounds the viewer; give the direction",
               name);
  ClippedSun sun{glm::normalize(sum), 180.0 / size.height};
  double furthest = 0;  // half of the chord
  for (const Texel t : largest.texels)
    furthest = std::max(furthest, glm::distance(sun.direction, texelDirection(size, t.x, t.y)) / 2);
  sun.width += 4 * std::asin(std::min(furthest, 1.0)) * 180 / kPiD;
  sun.rivals = size_t(std::ranges::count_if(regions,
                                            [&](const Region& region) {
                                              return region.solidAngle >= largest.solidAngle / 2;
                                            })) -
               1;
  return sun;
}

}  // namespace chromeball
