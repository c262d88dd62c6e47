// SPDX-License-Identifier: Apache-2.0
#include "approximate/irradiance_cache.h"

#include <algorithm>

#include "base/hash.h"

namespace chromeball {
namespace {

constexpr int kLargestLevel = 60;

int64_t cellOf(double coordinate, int level) {
  return int64_t(std::floor(std::ldexp(coordinate, -level)));
}

bool isSound(const IrradianceRecord& r) {
  const auto finite = [](const vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  return finite(r.position) && finite(r.normal) && finite(r.irradiance) &&
         std::ranges::all_of(r.rotation, finite) && std::ranges::all_of(r.translation, finite) &&
         r.radius > 0 && r.leastRadius >= 0;
}

}  // namespace

size_t IrradianceCache::CellHash::operator()(const Cell& cell) const {
  return hash(uint64_t(cell.x), uint64_t(cell.y), uint64_t(cell.z));
}

template <class Use>
void IrradianceCache::forUsable(const vec3& position, const vec3& normal, Use use) const {
  const auto tryOut = [&](uint32_t i) {
    const IrradianceRecord& record = records_[i];
    const float expected = record.errorAt(position, normal);
    if (expected < error_ && !record.isInFront(position, normal)) use(record, expected);
  };
  for (const uint32_t i : anywhere_) tryOut(i);
  for (const auto& [level, cells] : levels_) {
    const auto found = cells.find(
        {cellOf(position.x, level), cellOf(position.y, level), cellOf(position.z, level)});
    if (found == cells.end()) continue;
    for (const uint32_t i : found->second) tryOut(i);
  }
}

std::optional<Rgb> IrradianceCache::find(const vec3& position, const vec3& normal) const {
  Rgb sum(0);
  float weights = 0;
  forUsable(position, normal, [&](const IrradianceRecord& record, float expected) {
    const float weight = 1 - expected / error_;
    sum += weight * record.irradianceAt(position, normal);
    weights += weight;
  });
  if (weights == 0) return {};
  return sum / weights;
}

std::optional<float> IrradianceCache::claimedRadius(const vec3& position,
                                                    const vec3& normal) const {
  std::optional<float> least;
  forUsable(position, normal, [&](const IrradianceRecord& record, float) {
    const float claim = record.radius - glm::length(position - record.position);
    least = std::min(claim, least.value_or(INFINITY));
  });
  return least;
}

void IrradianceCache::add(IrradianceRecord record) {
  limitRadii(record);
  records_.push_back(record);
  index(uint32_t(records_.size() - 1));
}

// Goes over all records: that takes little time compared with their rays.
template <class Use>
void IrradianceCache::forNear(const IrradianceRecord& record, Use use) {
  constexpr float kOpposite = -0.5f;  // the other side of a wall has other neighbours
  for (IrradianceRecord& other : records_) {
    const float distance = glm::length(other.position - record.position);
    if (distance < error_ * (record.radius + other.radius) &&
        glm::dot(other.normal, record.normal) > kOpposite)
      use(other, distance);
  }
}

// A record whose radius falls may in turn limit others.
void IrradianceCache::limitRadii(IrradianceRecord& record) {
  const auto limit = [](IrradianceRecord& r, float largest) {
    largest = std::max(largest, r.leastRadius);
    return largest < r.radius ? r.radius = largest, true : false;
  };
  forNear(record,
          [&](IrradianceRecord& other, float distance) { limit(record, other.radius + distance); });
  std::vector<IrradianceRecord*> reduced{&record};
  while (!reduced.empty()) {
    const IrradianceRecord from = *reduced.back();
    reduced.pop_back();
    forNear(from, [&](IrradianceRecord& other, float distance) {
      if (limit(other, from.radius + distance)) reduced.push_back(&other);
    });
  }
}

void IrradianceCache::index(uint32_t i) {
  const IrradianceRecord& record = records_[i];
  const float reach = error_ * record.radius;
  if (!(reach < std::ldexp(0.5f, kLargestLevel))) {
    anywhere_.push_back(i);
    return;
  }
  const int level = std::max(std::ilogb(2 * reach) + 1, -kLargestLevel);
  Level& cells = levels_[level];
  const glm::dvec3 low = glm::dvec3(record.position) - double(reach),
                   high = glm::dvec3(record.position) + double(reach);
  for (int64_t z = cellOf(low.z, level); z <= cellOf(high.z, level); ++z)
    for (int64_t y = cellOf(low.y, level); y <= cellOf(high.y, level); ++y)
      for (int64_t x = cellOf(low.x, level); x <= cellOf(high.x, level); ++x)
        cells[{x, y, z}].push_back(i);
}

void IrradianceCache::archive(Archive& a) {
  std::vector<IrradianceRecord> records = records_;
  a(records);
  if (!a.reads()) return;
  a.check(std::ranges::all_of(records, isSound));
  *this = IrradianceCache(error_);
  records_ = std::move(records);
  for (size_t i = 0; i < records_.size(); ++i) index(uint32_t(i));
}

}  // namespace chromeball
