// SPDX-License-Identifier: Apache-2.0
#include "guiding/caustic_guide.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "math/vec.h"
#include "math/warp.h"

namespace chromeball {
namespace {

constexpr double kLargestLobeFraction =
    0.03;                              // of the flux, in a lobe of lights that can be divided
constexpr size_t kMinLobePhotons = 8;  // of a lobe that is the part of another
constexpr float kSmallestSquare = 1.0f / 512;  // of the probe, as uniformSphereToSquare() maps it
constexpr size_t kMinToFollow = 6;             // photons that determine a gradient
constexpr double kRidge = 1e-4;                // of the variance of the positions
constexpr double kMargin = 2;        // of spreads: photons of a region do not tell all directions
constexpr double kMinSpread = 1e-5;  // 0.26 degrees, the radius of the Sun; keeps floats precise
constexpr double kUnknownSpread = 0.01;  // added where few photons determine the lobe

double fluxOf(std::span<const Photon> photons) {
  double sum = 0;
  for (const Photon& p : photons) sum += double(p.flux);
  return sum;
}

vec2 squareOf(const Photon& p) { return uniformSphereToSquare(p.emission); }

}  // namespace

CausticLobes::CausticLobes(std::span<Photon> photons) {
  const double total = fluxOf(photons);
  if (!(total > 0)) return;
  origin_ = photons[0].position;
  std::vector<Lobe> lobes;
  std::stable_sort(photons.begin(), photons.end(),
                   [](const Photon& a, const Photon& b) { return a.chain < b.chain; });
  for (auto begin = photons.begin(); begin != photons.end();) {
    const auto end = std::find_if(begin, photons.end(),
                                  [&](const Photon& p) { return p.chain != begin->chain; });
    divide({begin, end}, vec2(0), 1, total, lobes);
    begin = end;
  }

  packs_.resize((lobes.size() + Pack::kLobes - 1) / Pack::kLobes);
  double upTo = 0;
  for (size_t i = 0; i < packs_.size() * Pack::kLobes; ++i) {
    const Lobe& lobe = lobes[std::min(i, lobes.size() - 1)];  // the rest of a pack has factor 0
    Pack& pack = packs_[i / Pack::kLobes];
    const size_t k = i % Pack::kLobes;
    for (int row = 0; row < 3; ++row) {
      pack.base[row][k] = float(lobe.axis[row]);
      for (int column = 0; column < 3; ++column)
        pack.gradient[column][row][k] = float(lobe.gradient[column][row]);
    }
    pack.spread[k] = float(lobe.spread);
    if (i >= lobes.size()) continue;
    const double probability = lobe.flux / total;
    pack.factor[k] = float(probability * lobe.spread * (2 + lobe.spread) / (4 * double(kPi)));
    upTo_.push_back(float(upTo += probability));
  }
}

// Makes one lobe, or the lobes of the quarters of the square of the probe that the photons came
// from.
void CausticLobes::divide(std::span<Photon> photons, vec2 corner, float size, double total,
                          std::vector<Lobe>& lobes) const {
  if (photons.empty()) return;
  if (photons.size() < 2 * kMinLobePhotons || size < kSmallestSquare ||
      fluxOf(photons) < kLargestLobeFraction * total) {
    lobes.push_back(fit(photons));
    return;
  }
  const float half = size / 2;
  const vec2 middle = corner + half;
  const auto halves = [](std::span<Photon> all, const auto& isFirst) {
    const auto second = std::stable_partition(all.begin(), all.end(), isFirst);
    return std::array{std::span(all.begin(), second), std::span(second, all.end())};
  };
  const auto rows = halves(photons, [&](const Photon& p) { return squareOf(p).y < middle.y; });
  for (size_t y = 0; y < 2; ++y) {
    const auto parts = halves(rows[y], [&](const Photon& p) { return squareOf(p).x < middle.x; });
    for (size_t x = 0; x < 2; ++x)
      divide(parts[x], corner + half * vec2(float(x), float(y)), half, total, lobes);
  }
}

// Least squares, weighted by flux: directions d_i ~ mean(d) + gradient (x_i - mean(x)), with
//   gradient = sum (d_i - mean(d)) (x_i - mean(x))^T (sum (x_i - mean(x)) (x_i - mean(x))^T)^-1.
CausticLobes::Lobe CausticLobes::fit(std::span<const Photon> photons) const {
  const double flux = fluxOf(photons);
  glm::dvec3 meanPosition(0), meanDirection(0);
  for (const Photon& p : photons) {
    meanPosition += double(p.flux) / flux * glm::dvec3(p.position - origin_);
    meanDirection += double(p.flux) / flux * glm::dvec3(p.direction);
  }
  glm::dmat3 positions(0), products(0);
  for (const Photon& p : photons) {
    const glm::dvec3 x = glm::dvec3(p.position - origin_) - meanPosition;
    const glm::dvec3 d = glm::dvec3(p.direction) - meanDirection;
    positions += double(p.flux) / flux * glm::outerProduct(x, x);
    products += double(p.flux) / flux * glm::outerProduct(d, x);
  }
  const double variance = positions[0][0] + positions[1][1] + positions[2][2];
  const bool follows = photons.size() >= kMinToFollow && variance > 0;
  Lobe lobe{meanDirection, glm::dmat3(0), 0, flux};
  if (follows) {
    lobe.gradient = products / variance * glm::inverse(positions / variance + glm::dmat3(kRidge));
    lobe.axis -= lobe.gradient * meanPosition;
  }
  for (const Photon& p : photons) {
    const glm::dvec3 axis =
        glm::normalize(lobe.axis + lobe.gradient * glm::dvec3(p.position - origin_));
    const glm::dvec3 d = glm::dvec3(p.direction) - axis;
    lobe.spread += double(p.flux) / flux * glm::dot(d, d) / 2;  // 1 - cos
  }
  const double count = double(photons.size()), parameters = follows ? 3 : 1;
  lobe.spread *= kMargin * count / std::max(count - parameters, 0.5);
  if (!follows) lobe.spread += kUnknownSpread;
  lobe.spread = std::clamp(lobe.spread, kMinSpread, 1.0);
  return lobe;
}

CausticLobes::Sample CausticLobes::sample(const vec3& position, vec2 u, float lobe) const {
  const size_t i = std::min(
      upTo_.size() - 1, size_t(std::upper_bound(upTo_.begin(), upTo_.end(), lobe) - upTo_.begin()));
  const Pack& pack = packs_[i / Pack::kLobes];
  const size_t k = i % Pack::kLobes;
  const vec3 x = position - origin_;
  vec3 axis;
  for (int row = 0; row < 3; ++row)
    axis[row] = pack.base[row][k] + pack.gradient[0][row][k] * x.x +
                pack.gradient[1][row][k] * x.y + pack.gradient[2][row][k] * x.z;
  // The probability of 1 - cos(theta) < t is t (2 + s) / (2 (t + s)).
  const float s = pack.spread[k];
  const float t = std::min(2 * s * u.x / (2 * (1 - u.x) + s), 2.0f);
  const float sine = std::sqrt(t * (2 - t));
  const Frame frame(glm::normalize(axis));
  const vec3 direction = frame.toWorld(sine * unitVector(0, u.y) + vec3(0, 0, 1 - t));
  return {direction, pdf(position, direction)};
}

float CausticLobes::pdf(const vec3& position, const vec3& direction) const {
  const vec3 at = position - origin_;
  float sums[Pack::kLobes] = {};
  for (const Pack& pack : packs_)
    for (size_t k = 0; k < Pack::kLobes; ++k) {  // without branches, for vector instructions
      const auto axis = [&](int row) {
        return pack.base[row][k] + pack.gradient[0][row][k] * at.x +
               pack.gradient[1][row][k] * at.y + pack.gradient[2][row][k] * at.z;
      };
      const float x = axis(0), y = axis(1), z = axis(2);
      const float scale = 1 / std::sqrt(x * x + y * y + z * z);
      const float dx = x * scale - direction.x, dy = y * scale - direction.y,
                  dz = z * scale - direction.z;
      const float t = 0.5f * (dx * dx + dy * dy + dz * dz) + pack.spread[k];
      sums[k] += pack.factor[k] / (t * t);
    }
  float sum = 0;
  for (const float density : sums) sum += density;
  return sum;
}

namespace {

constexpr size_t kMinPhotons = 500;        // of a region that is the half of another
constexpr size_t kMinPhotonsToGuide = 20;  // of a region with lobes

}  // namespace

CausticGuide::CausticGuide(std::vector<Photon> photons) {
  std::vector<std::span<Photon>> regions;
  tree_ = RegionTree(std::span(photons), kMinPhotons, regions);
  regions_.assign(regions.size(), {});
  parallelFor(size_t(0), regions.size(), [&](size_t i) {
    if (regions[i].size() >= kMinPhotonsToGuide) regions_[i] = CausticLobes(regions[i]);
  });
  if (std::all_of(regions_.begin(), regions_.end(), [](const auto& r) { return r.empty(); }))
    *this = CausticGuide();
}

}  // namespace chromeball
