// SPDX-License-Identifier: Apache-2.0
#include "lighting/constellation/penrose.h"

#include <queue>

#include "base/hash.h"
#include "base/progress.h"
#include "probe/mapping.h"

namespace chromeball {
namespace {

dvec2 toUv(const dvec2& p) { return {0.5 * p.x, p.y}; }

constexpr double kPhi = 1.6180339887498948482;
constexpr double kInvPhi = kPhi - 1;  // 1 / phi; 1 / phi^2 = 2 - phi; 1 / phi^3 = 2 phi - 3

// Half a rhomb of the tiling (a Robinson triangle), with an apex a of 36 or 108 degrees, in one of
// two mirror images.
struct Triangle {
  dvec2 a, b, c;
  bool acute, mirrored;
  int level;    // subdivisions so far
  double code;  // in [0, 1), uniform over the triangles of its shape and level in a neighbourhood
};

struct Corner {
  dvec2 position;
  double rank;
};

// A code is a number in base phi whose newest digit is the most significant: each parent shape has
// an interval of [0, 1) whose length is its fraction of the children of this shape; the parent's
// code is the position in the interval. The lengths are
//   acute:  1/phi^2 from acute, 1/phi from obtuse
//   obtuse: 1/phi^3 from acute, twice 1/phi^2 from obtuse
double acuteFromAcute(double code) { return code * (2 - kPhi); }
double acuteFromObtuse(double code) { return (2 - kPhi) + code * kInvPhi; }
double obtuseFromAcute(double code) { return code * (2 * kPhi - 3); }
double obtuseFromObtuse(double code, int which) {
  return (2 * kPhi - 3) + (code + which) * (2 - kPhi);
}

// Cuts side ab, and side bc of an obtuse triangle, in the golden ratio. Two triangles share the new
// corner on a side; only one of them adds it. The neighbour across bc is the mirror image; the
// neighbour across ab is the mirror image, or the other shape with the same `mirrored`.
template <class AddTriangle, class AddCorner>
void split(const Triangle& t, AddTriangle addTriangle, AddCorner addCorner) {
  const int level = t.level + 1;
  const bool ownsAb = t.mirrored == t.acute, ownsBc = !t.mirrored;
  const double scale = std::pow(kPhi, 2 * t.level);
  const auto rank = [&](double code) { return scale * (1 + kPhi * code); };
  if (t.acute) {
    const dvec2 p = glm::mix(t.a, t.b, kInvPhi);
    const double code = obtuseFromAcute(t.code);
    addTriangle({t.c, p, t.b, true, t.mirrored, level, acuteFromAcute(t.code)});
    addTriangle({p, t.c, t.a, false, t.mirrored, level, code});
    if (ownsAb) addCorner({p, rank(code)});
  } else {
    const dvec2 q = glm::mix(t.b, t.a, kInvPhi), r = glm::mix(t.b, t.c, kInvPhi);
    const double first = obtuseFromObtuse(t.code, 0), second = obtuseFromObtuse(t.code, 1);
    addTriangle({r, t.c, t.a, false, t.mirrored, level, first});
    addTriangle({q, r, t.b, false, !t.mirrored, level, second});
    addTriangle({r, q, t.a, true, !t.mirrored, level, acuteFromObtuse(t.code)});
    if (ownsAb) addCorner({q, rank(first)});
    if (ownsBc) addCorner({r, rank(second)});
  }
}

// Ten acute triangles around a point: a decagon of radius 4 that covers the map. The map is off its
// centre, where the tiling is symmetric.
std::vector<Triangle> decagon(uint64_t seed) {
  const auto random = [&](int i) { return double(toUnit(uint32_t(hash(seed, i)))); };
  const auto polar = [](double radius, double angle) {
    return radius * dvec2(std::cos(angle), std::sin(angle));
  };
  const dvec2 middle = dvec2(1, 0.5) + polar(1.2 + random(0), 2 * kPiD * random(1));
  const double turn = 2 * kPiD * random(2);
  std::vector<Triangle> triangles;
  for (int i = 0; i < 10; ++i) {
    const dvec2 b = middle + polar(4, turn + kPiD / 5 * i);
    const dvec2 c = middle + polar(4, turn + kPiD / 5 * (i + 1));
    const bool mirrored = i % 2;
    triangles.push_back({middle, mirrored ? c : b, mirrored ? b : c, true, mirrored, 0, i / 10.0});
  }
  return triangles;
}

// Finds corners in order of rank / importance.
class Search {
 public:
  Search(const ImportanceTable& table, uint64_t seed) : table_(table) {
    for (const Triangle& t : decagon(seed)) add(t);
  }

  // Splits triangles until none can contain a corner that precedes the first known one.
  dvec2 next() {
    while (corners_.empty() || triangles_.top().key <= corners_.top().key) {
      const Triangle triangle = triangles_.top().item;
      triangles_.pop();
      split(
          triangle, [&](const Triangle& t) { add(t); }, [&](const Corner& c) { add(c); });
    }
    const dvec2 position = corners_.top().item.position;
    corners_.pop();
    return position;
  }

  // The sides ab and ac of each triangle: bc is the diagonal of a rhomb.
  std::vector<MapLine> takeSides() {
    std::vector<MapLine> sides;
    for (; !triangles_.empty(); triangles_.pop()) {
      const Triangle& t = triangles_.top().item;
      sides.push_back({toUv(t.a), toUv(t.b)});
      sides.push_back({toUv(t.a), toUv(t.c)});
    }
    return sides;
  }

 private:
  template <class Item>
  struct Entry {
    double key;
    Item item;
    bool operator<(const Entry& other) const { return key > other.key; }  // smallest on top
  };

  void add(const Triangle& t) {
    const dvec2 low = glm::min(t.a, glm::min(t.b, t.c)), high = glm::max(t.a, glm::max(t.b, t.c));
    const double maximum = table_.bound(low, high);
    if (maximum > 0) triangles_.push({std::pow(kPhi, 2 * t.level) / maximum, t});
  }
  void add(const Corner& c) {
    const double importance = table_.at(c.position);
    if (importance > 0) corners_.push({c.rank / importance, c});
  }

  const ImportanceTable& table_;
  std::priority_queue<Entry<Triangle>> triangles_;
  std::priority_queue<Entry<Corner>> corners_;
};

}  // namespace

ImportanceTable::ImportanceTable(const Image& latLong)
    : texels_(latLong, kFineCells), blocks_(texels_) {
  levels_.push_back({texels_.width(), texels_.height(), {}});
  levels_[0].maximum.reserve(texels_.cells().size());
  for (int y = 0; y < texels_.height(); ++y)
    for (int x = 0; x < texels_.width(); ++x) {
      const dvec2 size = texels_.uv(x + 1, y + 1) - texels_.uv(x, y);
      levels_[0].maximum.push_back(texels_.at(x, y).weight / (size.x * size.y));
    }
  while (levels_.back().maximum.size() > 1) {
    const Level& fine = levels_.back();
    Level coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
    coarse.maximum.resize(size_t(coarse.width) * coarse.height);
    for (int y = 0; y < fine.height; ++y)
      for (int x = 0; x < fine.width; ++x) {
        double& maximum = coarse.maximum[size_t(y / 2) * coarse.width + x / 2];
        maximum = std::max(maximum, fine.maximum[size_t(y) * fine.width + x]);
      }
    levels_.push_back(std::move(coarse));
  }
}

double ImportanceTable::at(const dvec2& p) const {
  if (p.x < 0 || p.x > 2 || p.y < 0 || p.y > 1) return 0;
  const glm::ivec2 i = texels_.cellAt(toUv(p));
  return levels_[0].maximum[size_t(i.y) * levels_[0].width + i.x];
}

// The level on which the rectangle meets at most 2 x 2 entries.
double ImportanceTable::bound(const dvec2& low, const dvec2& high) const {
  if (high.x < 0 || low.x > 2 || high.y < 0 || low.y > 1) return 0;
  glm::ivec2 first = texels_.cellAt(toUv(low)), last = texels_.cellAt(toUv(high));
  size_t k = 0;
  for (; last.x - first.x > 1 || last.y - first.y > 1; ++k) first /= 2, last /= 2;
  const Level& level = levels_[k];
  double maximum = 0;
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x)
      maximum = std::max(maximum, level.maximum[size_t(y) * level.width + x]);
  return maximum;
}

Constellation penrose(const ImportanceTable& table, int count, uint64_t seed) {
  if (!(table.texels().total().weight > 0)) return {};
  Search search(table, seed);
  std::vector<dvec3> directions;
  for (int i = 0; i < count; ++i) {
    endIfCancelled();
    directions.push_back(*uvToDirection(Mapping::LatLong, toUv(search.next())));
  }
  const std::vector<dvec3> irradiance = table.blocks().assignToNearest(directions);
  Constellation lights;
  for (int i = 0; i < count; ++i) lights.push_back(makeLight(directions[i], irradiance[i]));
  return lights;
}

std::vector<MapLine> penroseTiling(const ImportanceTable& table, int count, uint64_t seed) {
  if (!(table.texels().total().weight > 0)) return {};
  Search search(table, seed);
  for (int i = 0; i < count; ++i) search.next();
  return search.takeSides();
}

}  // namespace chromeball
