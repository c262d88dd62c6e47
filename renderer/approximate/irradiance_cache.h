// SPDX-License-Identifier: Apache-2.0
// Irradiance that other surfaces reflect, at scattered points of a scene (HDRI book, section 9.5;
// Ward, Rubinstein and Clear 1988, "A Ray Tracing Solution for Diffuse Interreflection").
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

#include "base/archive.h"
#include "math/vec.h"

namespace chromeball {

// Irradiance at one point, with what is needed to extrapolate it (Ward and Heckbert 1992,
// "Irradiance Gradients").

struct IrradianceRecord {
  vec3 position{0};                   // metres
  vec3 normal{0};                     // unit
  Rgb irradiance{0};                  // W/m^2
  std::array<vec3, 3> rotation{};     // gradient of each channel, W/m^2 per radian of rotation axis
  std::array<vec3, 3> translation{};  // gradient of each channel, W/m^2 per metre
  float radius = 0;       // metres; at most the harmonic mean distance of what the point sees
  float leastRadius = 0;  // neighbours do not lower it further

  // The change of irradiance to be expected at another point, as a fraction: |x - x_i| / R_i +
  // sqrt(1 - n.n_i) (Ward, Rubinstein and Clear 1988, equation 5, without its constants).
  float errorAt(const vec3& x, const vec3& n) const {
    const float turned = std::sqrt(std::max(1 - glm::dot(n, normal), 0.0f));
    const float distance = glm::length(x - position);
    return (distance > 0 ? distance / radius : 0) + turned;
  }

  // Whether the point is behind the record's surface and a part of what the record sees is not
  // seen from there (Ward et al. 1988, equation 6).
  bool isInFront(const vec3& x, const vec3& n) const {
    return glm::dot(x - position, n + normal) < -0.02f * radius;
  }

  Rgb irradianceAt(const vec3& x, const vec3& n) const {
    const vec3 turn = glm::cross(normal, n), shift = x - position;
    Rgb sum = irradiance;
    for (int c = 0; c < 3; ++c)
      sum[c] += glm::dot(turn, rotation[size_t(c)]) + glm::dot(shift, translation[size_t(c)]);
    return glm::max(sum, Rgb(0));
  }
};

// Records in grids whose cells double in size from level to level. A record is in the level whose
// cells are just larger than the sphere in which it may be used, so that it is in at most eight
// cells, and a query reads one cell of each level. Queries are thread-safe among themselves.
class IrradianceCache {
 public:
  // `error`: records are used where their expected error is below it; in (0, 1].
  explicit IrradianceCache(float error) : error_(error) {}

  float error() const { return error_; }
  size_t size() const { return records_.size(); }
  const std::vector<IrradianceRecord>& records() const { return records_; }

  // The weighted mean of the records' irradiances at a point; nullopt if none may be used. A
  // record's weight falls to 0 where its expected error reaches the limit, so that the result is
  // continuous.
  std::optional<Rgb> find(const vec3& position, const vec3& normal) const;

  // The least distance, in metres, at which the usable records expect a surface to be seen from
  // there: the smallest radius less the distance; nullopt where none may be used.
  std::optional<float> claimedRadius(const vec3& position, const vec3& normal) const;

  // Adds a record. The radius of a record must not exceed a neighbour's radius plus their distance:
  // what is near to one is near to the other too (Krivanek, Bouatouch, Pattanaik and Zara 2006,
  // "Making Radiance and Irradiance Caching Practical").
  void add(IrradianceRecord record);

  // The records, without the grids.
  void archive(Archive& a);

 private:
  struct Cell {
    int64_t x, y, z;
    bool operator==(const Cell&) const = default;
  };
  struct CellHash {
    size_t operator()(const Cell& cell) const;
  };
  using Level = std::unordered_map<Cell, std::vector<uint32_t>, CellHash>;

  // Calls use(record, expected error) for all records that may be used at the point.
  template <class Use>
  void forUsable(const vec3& position, const vec3& normal, Use use) const;
  template <class Use>
  void forNear(const IrradianceRecord& record, Use use);
  void limitRadii(IrradianceRecord& record);
  void index(uint32_t record);

  float error_;
  std::vector<IrradianceRecord> records_;
  std::map<int, Level> levels_;     // by the binary logarithm of the cells' size in metres
  std::vector<uint32_t> anywhere_;  // the records that no cell is large enough for
};

}  // namespace chromeball
