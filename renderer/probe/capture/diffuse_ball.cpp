// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/diffuse_ball.h"

#include <cmath>
#include <optional>

#include "base/error.h"

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

  // nullopt unless all of it is inside the circle and counts. Adds its invalid pixels to `invalid`.
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

}  // namespace chromeball
