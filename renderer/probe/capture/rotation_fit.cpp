// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/rotation_fit.h"

#include <array>

#include "base/parallel.h"
#include "math/icosphere.h"
#include "probe/convert.h"
#include "probe/mapping.h"

namespace chromeball {
namespace {

using glm::dmat3;
using glm::dquat;

constexpr int kSubdivisions = 1;
constexpr size_t kParts = 80;  // faces of that icosphere

double power(const Image& map) {
  double sum = 0;
  for (int y = 0; y < map.height; ++y) {
    double row = 0;
    for (int x = 0; x < map.width; ++x) {
      const dvec3 value(map.rgb(x, y));
      row += glm::dot(value, value);
    }
    sum += row * texelSolidAngle(y, map.width, map.height);
  }
  return sum;
}

dquat rotated(const dquat& rotation, const dvec3& turn) {
  const double angle = glm::length(turn);
  return angle > 0 ? glm::normalize(glm::angleAxis(angle, turn / angle) * rotation) : rotation;
}

constexpr int kMedianHeight = 32;
constexpr float kLogFloor = 0.05f;

Image resized(const Image& latLong, int height) {
  return convert(latLong, Mapping::LatLong, Mapping::LatLong, {2 * height, height});
}

// The median of one channel over the sphere; over its lit part if that median is 0; 1 if all is
// black.
float medianOf(const Image& map, int channel) {
  struct Texel {
    float radiance;
    double solidAngle;
  };
  std::vector<Texel> texels;
  double all = 0, lit = 0;
  forTexels(map, [&](int, int, const Rgb& c, double solidAngle) {
    texels.push_back({c[channel], solidAngle});
    all += solidAngle;
    if (c[channel] > 0) lit += solidAngle;
  });
  std::ranges::sort(texels, {}, &Texel::radiance);
  double target = lit > 0.5 * all ? 0.5 * all : all - 0.5 * lit;
  for (const Texel& texel : texels)
    if ((target -= texel.solidAngle) < 0) return texel.radiance > 0 ? texel.radiance : 1;
  return 1;
}

// Weights of a Gaussian at -n .. n, of sum 1.
std::vector<float> gaussian(double sigma, int largest) {
  const int n = std::min(int(std::ceil(3 * sigma)), largest);
  std::vector<float> weights;
  double sum = 0;
  for (int i = -n; i <= n; ++i) sum += std::exp(-0.5 * i * i / (sigma * sigma));
  for (int i = -n; i <= n; ++i)
    weights.push_back(float(std::exp(-0.5 * i * i / (sigma * sigma)) / sum));
  return weights;
}

// Blurs along the rows by 1 / sin(theta) texels, then along the meridians, over the poles, by one.
Image blurred(const Image& map) {
  const int width = map.width, height = map.height;
  Image along(width, height, 3), out(width, height, 3);
  forRows(width, height, 64, [&](int y) {
    const auto weights = gaussian(1 / std::sin(kPiD * (y + 0.5) / height), width / 2 - 1);
    const int n = int(weights.size()) / 2;
    for (int x = 0; x < width; ++x) {
      Rgb sum(0);
      for (int i = -n; i <= n; ++i)
        sum += weights[size_t(i + n)] * map.rgb((x + i + width) % width, y);
      along.setRgb(x, y, sum);
    }
  });
  const auto weights = gaussian(1, height / 2);
  const int n = int(weights.size()) / 2;
  forRows(width, height, 8, [&](int y) {
    for (int x = 0; x < width; ++x) {
      Rgb sum(0);
      for (int i = -n; i <= n; ++i) {
        const int row = y + i;
        const bool isBeyondPole = row < 0 || row >= height;
        const int inside = row < 0 ? -1 - row : row >= height ? 2 * height - 1 - row : row;
        sum +=
            weights[size_t(i + n)] * along.rgb(isBeyondPole ? (x + width / 2) % width : x, inside);
      }
      out.setRgb(x, y, sum);
    }
  });
  return out;
}

}  // namespace

// Integrals over the sphere, summed over channels. J: the derivatives of g.
struct MapPair::Sums {
  double fg = 0;
  dvec3 fJ{0};
  dmat3 JJ{0};

  void operator+=(const Sums& other) { fg += other.fg, fJ += other.fJ, JJ += other.JJ; }
};

MapPair::MapPair(const Image& f, const Image& g)
    : width_(f.width),
      height_(f.height),
      g_(g),
      texel_(kPiD / f.height),
      powerF_(power(f)),
      powerG_(power(g)) {
  texels_.reserve(size_t(width_) * height_);
  chromeball::forTexels(f, [&](int x, int y, const Rgb& c, double solidAngle) {
    texels_.push_back({vec3(texelDirection({width_, height_}, x, y)), c, float(solidAngle)});
  });
}

template <class Visit>
void MapPair::forTexels(const Visit& visit) const {
  forRanges(size_t(height_), size_t(width_), [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row)
      for (size_t i = row * width_; i < (row + 1) * width_; ++i) visit(texels_[i], row);
  });
}

double MapPair::correlation(const dquat& rotation) const {
  if (powerF_ == 0 || powerG_ == 0) return 0;
  const mat3 back(glm::mat3_cast(glm::conjugate(rotation)));
  std::vector<double> rows(size_t(height_), 0.0);
  forTexels([&](const Texel& texel, size_t row) {
    rows[row] += double(texel.solidAngle * glm::dot(texel.f, g_.radiance(back * texel.direction)));
  });
  double sum = 0;
  for (const double row : rows) sum += row;
  return sum / std::sqrt(powerF_ * powerG_);
}

// A turn of the map by w moves the radiance at d - w x d to d.
MapPair::Seen MapPair::seenAt(const mat3& back, const vec3& d) const {
  const float step = float(0.5 * texel_);
  Seen seen{dvec3(g_.radiance(back * d)), {}};
  for (int axis = 0; axis < 3; ++axis) {
    vec3 turn(0);
    turn[axis] = step;
    const vec3 shift = glm::cross(turn, d);
    const dvec3 after(g_.radiance(back * (d - shift)));
    const dvec3 before(g_.radiance(back * (d + shift)));
    seen.derivatives[axis] = (after - before) / double(2 * step);
  }
  return seen;
}

MapPair::Sums MapPair::sumsAt(const dquat& rotation) const {
  const mat3 back(glm::mat3_cast(glm::conjugate(rotation)));
  std::vector<Sums> rows(static_cast<size_t>(height_));
  forTexels([&](const Texel& texel, size_t row) {
    const Seen seen = seenAt(back, texel.direction);
    const double weight = double(texel.solidAngle);
    const dvec3 f(texel.f);
    Sums& sums = rows[row];
    sums.fg += weight * glm::dot(f, seen.g);
    for (int i = 0; i < 3; ++i) {
      sums.fJ[i] += weight * glm::dot(f, seen.derivatives[i]);
      for (int j = 0; j < 3; ++j)
        sums.JJ[i][j] += weight * glm::dot(seen.derivatives[i], seen.derivatives[j]);
    }
  });
  Sums all;
  for (const Sums& row : rows) all += row;
  return all;
}

dquat MapPair::refined(dquat rotation) const {
  constexpr int kMaxSteps = 40, kMaxHalvings = 6;
  constexpr double kLargest = 2, kUnseen = 0.05, kEnough = 1e-3;  // steps, in texels
  if (powerF_ == 0 || powerG_ == 0) return rotation;
  for (int i = 0; i < kMaxSteps; ++i) {
    const Sums sums = sumsAt(rotation);
    // g scaled to f; the factor only lengthens the step.
    const double scale = std::max(sums.fg / powerG_, 0.1);
    const double regular = 1e-9 * (sums.JJ[0][0] + sums.JJ[1][1] + sums.JJ[2][2]);
    if (!(regular > 0)) return rotation;
    dvec3 step = glm::inverse(sums.JJ + dmat3(regular)) * sums.fJ / scale;
    double length = glm::length(step) / texel_;
    if (length > kLargest) step *= kLargest / length, length = kLargest;
    const double before = sums.fg / std::sqrt(powerF_ * powerG_);
    int halvings = 0;
    while (length > kUnseen && correlation(rotated(rotation, step)) <= before)
      if (step *= 0.5, length *= 0.5; ++halvings > kMaxHalvings) return rotation;
    rotation = rotated(rotation, step);
    if (length < kEnough) break;
  }
  return rotation;
}

dvec3 MapPair::standardErrors(const dquat& rotation) const {
  const Sums sums = sumsAt(rotation);
  const double scale = sums.fg / powerG_;
  const mat3 back(glm::mat3_cast(glm::conjugate(rotation)));
  std::vector<std::array<dvec3, kParts>> rows(static_cast<size_t>(height_));
  for (auto& row : rows) row.fill(dvec3(0));
  forTexels([&](const Texel& texel, size_t row) {
    const Seen seen = seenAt(back, texel.direction);
    const dvec3 residual = double(texel.solidAngle) * (dvec3(texel.f) - scale * seen.g);
    dvec3& part = rows[row][size_t(icosphereFace(texel.direction, kSubdivisions))];
    for (int i = 0; i < 3; ++i) part[i] += glm::dot(residual, seen.derivatives[i]);
  });
  dmat3 scatter(0);
  for (size_t p = 0; p < kParts; ++p) {
    dvec3 part(0);
    for (const auto& row : rows) part += row[p];
    scatter += glm::outerProduct(part, part);
  }
  const dmat3 inverse = glm::inverse(scale * sums.JJ);
  const dmat3 covariance = inverse * scatter * inverse;
  return {std::sqrt(covariance[0][0]), std::sqrt(covariance[1][1]), std::sqrt(covariance[2][2])};
}

LogMaps::LogMaps(const Image& latLong) : latLong_(latLong) {
  const Image small = resized(latLong, kMedianHeight);
  for (int channel = 0; channel < 3; ++channel) unit_[channel] = medianOf(small, channel);
}

Image LogMaps::map(int height) const {
  Image map = resized(latLong_, height);
  recolor(map, [&](const Rgb& c) { return glm::log(glm::max(c, 0.0f) / unit_ + kLogFloor); });
  map = blurred(map);
  const Rgb mean(meanRadiance(map));
  recolor(map, [&](const Rgb& c) { return c - mean; });
  return map;
}

}  // namespace chromeball
