// SPDX-License-Identifier: Apache-2.0
#include "lighting/product.h"

#include "base/parallel.h"

namespace chromeball {
namespace {

constexpr int kSide = 16;  // bins along a side of the octahedral map
constexpr int kBins = kSide * kSide;
// Added to each mean cosine: a normal may see a block although none of the bin's sampled normals
// sees any of the block's sampled directions, and every light must have a positive pdf.
constexpr double kMinCosine = 1e-3;

// The octahedral map: the octahedron |x| + |y| + |z| = 1, with its lower half (y < 0) folded
// outwards, becomes the square [-1, 1]^2.
vec2 toOctahedral(const vec3& n) {
  const vec3 p = n / (std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z));
  if (p.y >= 0) return {p.x, p.z};
  return {std::copysign(1 - std::fabs(p.z), p.x), std::copysign(1 - std::fabs(p.x), p.z)};
}

vec3 fromOctahedral(const vec2& p) {
  vec3 n(p.x, 1 - std::fabs(p.x) - std::fabs(p.y), p.y);
  if (n.y < 0) {
    n.x = std::copysign(1 - std::fabs(p.y), p.x);
    n.z = std::copysign(1 - std::fabs(p.x), p.y);
  }
  return glm::normalize(n);
}

int binOf(const vec3& normal) {
  const vec2 p = (toOctahedral(normal) + 1.0f) * (0.5f * kSide);
  const auto cell = [](float x) { return std::clamp(int(x), 0, kSide - 1); };
  return cell(p.y) * kSide + cell(p.x);
}

std::vector<vec3> normalsOf(int bin) {
  constexpr int kSub = 3;
  std::vector<vec3> normals;
  for (int i = 0; i < kSub * kSub; ++i) {
    const vec2 p(float(bin % kSide) + (float(i % kSub) + 0.5f) / kSub,
                 float(bin / kSide) + (float(i / kSub) + 0.5f) / kSub);
    normals.push_back(fromOctahedral(p * (2.0f / kSide) - 1.0f));
  }
  return normals;
}

double meanCosine(const std::vector<vec3>& directions, const std::vector<vec3>& normals) {
  double sum = 0;
  for (const vec3& d : directions)
    for (const vec3& n : normals) sum += std::max(glm::dot(d, n), 0.0f);
  return sum / double(directions.size() * normals.size());
}

}  // namespace

Product::Product(const Probe& probe)
    : ProbeLight(probe),
      field_(probe),
      rows_(kBins, field_.rows()),
      columns_(kBins * field_.rows(), field_.columns()),
      pdfRatios_(size_t(kBins) * field_.blocks()) {
  if (!(field_.total() > 0)) return;
  std::vector<std::vector<vec3>> directions(field_.blocks());
  for (int block = 0; block < field_.blocks(); ++block)
    directions[block] = field_.directions(block);
  parallelFor(0, kBins, [&](int bin) {
    const std::vector<vec3> normals = normalsOf(bin);
    std::vector<double> cosines;
    for (const auto& block : directions) cosines.push_back(meanCosine(block, normals) + kMinCosine);
    fillBin(bin, cosines);
  });
}

void Product::fillBin(int bin, const std::vector<double>& cosines) {
  std::vector<double> rowWeights, weights(field_.columns());
  for (int row = 0; row < field_.rows(); ++row) {
    const int first = row * field_.columns();
    for (int c = 0; c < field_.columns(); ++c)
      weights[c] = field_.integral(first + c) * cosines[first + c];
    rowWeights.push_back(columns_.setRow(bin * field_.rows() + row, weights));
  }
  const double total = rows_.setRow(bin, rowWeights);
  for (int block = 0; block < field_.blocks(); ++block)
    pdfRatios_[size_t(bin) * field_.blocks() + block] =
        float(cosines[block] * field_.total() / total);
}

float Product::pdfRatio(const LightPoint& point, int block) const {
  const float front = pdfRatio(binOf(point.normal), block);
  return point.transmits ? 0.5f * (front + pdfRatio(binOf(-point.normal), block)) : front;
}

DirectionSample Product::sampleDirection(const LightPoint& point, double u, double v) const {
  if (!(field_.total() > 0)) return {vec3(0, 1, 0), Rgb(0), 0};
  const bool behind = point.transmits && u >= 0.5;
  if (point.transmits) u = 2 * u - behind;
  const int bin = binOf(behind ? -point.normal : point.normal);
  const int row = rows_.sample(bin, v);
  const int block = row * field_.columns() + columns_.sample(bin * field_.rows() + row, u);
  const LuminanceField::Point seen = field_.sample(block, u, v);
  const float pdf = seen.weight * field_.scale() * pdfRatio(point, block);
  return {seen.direction, seen.radiance / pdf, pdf};
}

void Product::sample(const LightPoint& point, const PixelSampler& sampler,
                     std::vector<DirectionSample>& out) const {
  const DirectionSample sample = sampleDirection(point, sampler.bits(dimension::kLight) * 0x1p-32,
                                                 sampler.bits(dimension::kLight + 1) * 0x1p-32);
  if (sample.pdf > 0) out.push_back(sample);
}

LightSource::Escaped Product::escaped(const LightPoint& point, const vec3& wi) const {
  const Probe::Position p = probe_.locate(wi);
  const LuminanceField::Point seen = field_.at(wi, p);
  return {seen.radiance, seen.weight * field_.scale() * pdfRatio(point, field_.blockOf(p))};
}

}  // namespace chromeball
