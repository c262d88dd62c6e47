// SPDX-License-Identifier: Apache-2.0
#include "probe/irradiance.h"

#include <optional>

#include "base/parallel.h"

namespace chromeball {
namespace {

using Row = RowIntegrals<dvec3, 3>;

// Rows of coarser maps are divided: in azimuth the integrals are exact, but a whole row has the
// horizon of its mean direction.
constexpr int kMinRows = 128;

Row rowOf(const Image& latLong, int y, const AzimuthTable<3>& table) {
  std::vector<dvec3> radiances;
  radiances.reserve(size_t(latLong.width));
  for (int x = 0; x < latLong.width; ++x) radiances.emplace_back(latLong.rgb(x, y));
  return {table, std::move(radiances)};
}

// The irradiance from the part of a row with these moments.
dvec3 irradianceFrom(const Row& row, const PolarMoments& moments, const Horizon& horizon) {
  const auto [one, cosine, sine] = row.over(horizon.above(moments.sine2, moments.sineCosine));
  const dvec3& n = horizon.normal();
  return max(moments.sine2 * (n.z * cosine - n.x * sine) + moments.sineCosine * n.y * one,
             dvec3(0));
}

// The azimuth a turned by b.
Azimuth turned(const Azimuth& a, const Azimuth& b) {
  double phi = a.phi + b.phi;
  if (phi >= 2 * kPiD) phi -= 2 * kPiD;
  return {phi, a.cos * b.cos - a.sin * b.sin, a.sin * b.cos + a.cos * b.sin};
}

}  // namespace

std::vector<dvec3> exactIrradiance(const Image& latLong, std::span<const vec3> normals) {
  constexpr int kTexelsOfBand = 1 << 14;  // of rows whose integrals stay in the cache
  constexpr size_t kNormalsOfTask = 256;
  const int height = latLong.height, parts = (kMinRows + height - 1) / height;
  const int bandRows = std::clamp(kTexelsOfBand / latLong.width, 1, height);
  const AzimuthTable<3> table = azimuthTable<3>(latLong.width);
  const std::vector<Horizon> horizons(normals.begin(), normals.end());
  std::vector<dvec3> irradiance(normals.size(), dvec3(0));
  for (int first = 0; first < height; first += bandRows) {
    const int count = std::min(bandRows, height - first);
    std::vector<std::optional<Row>> rows(static_cast<size_t>(count));
    parallelFor(0, count, [&](int i) { rows[size_t(i)] = rowOf(latLong, first + i, table); });
    parallelRanges(normals.size(), kNormalsOfTask, [&](size_t begin, size_t end) {
      for (int i = 0; i < count * parts; ++i) {
        const double part = kPiD / (double(height) * parts), theta = part * (first * parts + i);
        const PolarMoments moments(theta, theta + part);
        for (size_t n = begin; n < end; ++n)
          irradiance[n] += irradianceFrom(*rows[size_t(i / parts)], moments, horizons[n]);
      }
    });
  }
  return irradiance;
}

std::vector<dvec3> shIrradiance(const Image& latLong, std::span<const vec3> normals) {
  const ShCoefficients radiance = projectSh(latLong);
  std::vector<dvec3> irradiance;
  irradiance.reserve(normals.size());
  for (const vec3& normal : normals) irradiance.push_back(shIrradiance(radiance, dvec3(normal)));
  return irradiance;
}

std::vector<vec3> texelDirections(const ImageSize& latLong) {
  std::vector<vec3> directions;
  directions.reserve(size_t(latLong.width) * latLong.height);
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x) directions.emplace_back(texelDirection(latLong, x, y));
  return directions;
}

std::vector<vec3> texelDirections(const ImageSize& latLong, const Rotation& rotation) {
  std::vector<vec3> directions = texelDirections(latLong);
  for (vec3& direction : directions) direction = rotation.back(direction);
  return directions;
}

Image imageOf(const ImageSize& size, std::span<const dvec3> colors) {
  Image image(size.width, size.height, 3);
  for (size_t i = 0; i < colors.size(); ++i)
    for (int c = 0; c < 3; ++c) image.texels[3 * i + c] = float(colors[i][c]);
  return image;
}

Image irradianceMap(const Image& latLong, const ImageSize& size, const Rotation& rotation) {
  return imageOf(size, exactIrradiance(latLong, texelDirections(size, rotation)));
}

Image shIrradianceMap(const Image& latLong, const ImageSize& size, const Rotation& rotation) {
  return imageOf(size, shIrradiance(latLong, texelDirections(size, rotation)));
}

Horizon::Horizon(const vec3& normal)
    : normal_(normal), azimuth_{0, 1, 0}, horizontal_(std::hypot(normal_.x, normal_.z)) {
  if (!(horizontal_ > 0)) return;
  const double phi = std::atan2(-normal_.x, normal_.z);
  azimuth_ = {phi < 0 ? phi + 2 * kPiD : phi, normal_.z / horizontal_, -normal_.x / horizontal_};
}

// sine horizontal cos(phi - azimuth) + cosine normal.y > 0.
Arc Horizon::above(double sine, double cosine) const {
  const double across = sine * horizontal_, up = cosine * normal_.y;
  if (up >= across) return {up > 0 ? Arc::Kind::Whole : Arc::Kind::Empty};
  if (-up >= across) return {};
  const double cosHalf = -up / across, half = std::acos(cosHalf);
  const double sinHalf = std::sqrt((1 - cosHalf) * (1 + cosHalf));
  return {Arc::Kind::Part, turned(azimuth_, {2 * kPiD - half, cosHalf, -sinHalf}),
          turned(azimuth_, {half, cosHalf, sinHalf})};
}

// Written so that flat rows suffer no cancellation.
PolarMoments::PolarMoments(double theta0, double theta1) {
  const double sum = theta0 + theta1, height = theta1 - theta0;
  sine2 = (height - std::sin(height) * std::cos(sum)) / 2;
  sineCosine = std::sin(sum) * std::sin(height) / 2;
}

std::array<double, kShCount> shBasis(const dvec3& d) {
  const double l0 = 0.5 * std::sqrt(1 / kPiD), l1 = 0.5 * std::sqrt(3 / kPiD);
  const double l2 = 0.5 * std::sqrt(15 / kPiD), l20 = 0.25 * std::sqrt(5 / kPiD);
  return {l0,
          l1 * d.y,
          l1 * d.z,
          l1 * d.x,
          l2 * d.x * d.y,
          l2 * d.y * d.z,
          l20 * (3 * d.z * d.z - 1),
          l2 * d.x * d.z,
          0.5 * l2 * (d.x * d.x - d.y * d.y)};
}

ShCoefficients projectSh(const Image& latLong) {
  // Parts of a texel that are small enough to use the basis at their centres.
  constexpr int kWidth = 256, kHeight = 128;
  const int across = (kWidth - 1) / latLong.width + 1, along = (kHeight - 1) / latLong.height + 1;
  const int w = latLong.width * across, h = latLong.height * along;
  ShCoefficients coefficients{};
  for (int y = 0; y < h; ++y) {
    const double solidAngle = texelSolidAngle(y, w, h);
    for (int x = 0; x < w; ++x) {
      const std::array<double, kShCount> basis = shBasis(texelDirection({w, h}, x, y));
      const dvec3 flux = dvec3(latLong.rgb(x / across, y / along)) * solidAngle;
      for (int i = 0; i < kShCount; ++i) coefficients[i] += basis[i] * flux;
    }
  }
  return coefficients;
}

dvec3 shConvolution(const ShCoefficients& radiance, const std::array<double, 3>& moments,
                    const dvec3& direction) {
  const auto [zero, one, two] = moments;
  const std::array<double, kShCount> factors{zero, one, one, one, two, two, two, two, two};
  const std::array<double, kShCount> basis = shBasis(direction);
  dvec3 sum(0);
  for (int i = 0; i < kShCount; ++i) sum += factors[i] * basis[i] * radiance[i];
  return sum;
}

dvec3 shIrradiance(const ShCoefficients& radiance, const dvec3& normal) {
  return shConvolution(radiance, {kPiD, 2 * kPiD / 3, kPiD / 4}, normal);
}

}  // namespace chromeball
