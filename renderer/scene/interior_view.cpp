// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <set>

#include "scene/choose_view.h"
#include "scene/placed_triangles.h"

namespace chromeball {
namespace {

using glm::dvec2;
using glm::dvec3;

// A horizontal section through the scene, as a grid of square cells with the room in the middle.
// Each cell holds the directions of the front faces that cross it at this height.
class Section {
 public:
  static constexpr int kSide = 256;  // cells per side; walls are thicker than one cell

  // `above`: the view of the scene from above and below.
  Section(const Scene& scene, const std::vector<int>& instances, const Bounds& box, double height,
          const AxisView& above)
      : cell_(std::max(box.size().x, box.size().z) / kSide),
        corner_(middle(box) - 0.5 * kSide * cell_) {
    forShownTriangles(scene, instances, [&](const Corners& c, int) { add(c, height); });
    for (int z = 0; z < kSide; ++z)
      for (int x = 0; x < kSide; ++x) {
        const dvec2 at = point(x, z);
        hasRoof_.push_back(!above.shows({at.x, height, at.y}, true));
      }
  }

  dvec2 point(int x, int z) const { return corner_ + cell_ * dvec2(x + 0.5, z + 0.5); }
  bool hasRoof(int x, int z) const { return hasRoof_[size_t(z * kSide + x)]; }

  // Whether no surface is near: within 8 of 256 cells, 3% of the room's length.
  bool isFree(int x, int z) const {
    constexpr int kFreeMargin = 8;
    for (int dz = -kFreeMargin; dz <= kFreeMargin; ++dz)
      for (int dx = -kFreeMargin; dx <= kFreeMargin; ++dx)
        if (inside(x + dx, z + dz) && at(x + dx, z + dz) != 0) return false;
    return true;
  }

  // Metres to the first surface in this direction; nullopt if there is none or if its back is seen.
  // Under a roof only those under it count: what a window shows is no part of the room.
  std::optional<double> sightDistance(int x, int z, const dvec2& direction) const {
    constexpr double kStep = 0.7;
    double counted = INFINITY;
    for (double t = kStep;; t += kStep) {
      const int cx = int(std::floor(x + 0.5 + t * direction.x));
      const int cz = int(std::floor(z + 0.5 + t * direction.y));
      if (!inside(cx, cz)) return std::nullopt;
      if (hasRoof(x, z) && !hasRoof(cx, cz)) counted = std::min(counted, t);
      const uint16_t fronts = at(cx, cz);
      if (fronts == 0) continue;
      for (int i = 0; i < kNormals; ++i)
        if ((fronts >> i & 1) && glm::dot(normal(i), direction) < 0)
          return std::min(t, counted) * cell_;
      return std::nullopt;
    }
  }

 private:
  static constexpr int kNormals = 16;  // directions of the circle, one bit of a cell for each

  static dvec2 normal(int i) {
    const double angle = (i + 0.5) * 2 * kPiD / kNormals;
    return {std::cos(angle), std::sin(angle)};
  }
  static bool inside(int x, int z) { return x >= 0 && z >= 0 && x < kSide && z < kSide; }
  uint16_t at(int x, int z) const { return fronts_[size_t(z * kSide + x)]; }

  void add(const Corners& corners, double height) {
    std::array<dvec2, 2> ends;  // of the segment where the triangle crosses the plane
    int count = 0;
    for (size_t k = 0; k < 3 && count < 2; ++k) {
      const dvec3 &a = corners[k], &b = corners[(k + 1) % 3];
      if ((a.y < height) == (b.y < height)) continue;
      const dvec3 p = a + (height - a.y) / (b.y - a.y) * (b - a);
      ends[size_t(count++)] = (dvec2(p.x, p.z) - corner_) / cell_;
    }
    const dvec3 front = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (count < 2 || (front.x == 0 && front.z == 0)) return;
    const double turn = std::atan2(front.z, front.x) / (2 * kPiD) + 1;
    const uint16_t bit = uint16_t(1u << (int(turn * kNormals) % kNormals));
    const int steps = 1 + int(std::min(2 * glm::length(ends[1] - ends[0]), 4.0 * kSide));
    for (int i = 0; i <= steps; ++i) {
      const dvec2 p = glm::mix(ends[0], ends[1], double(i) / steps);
      const int x = std::clamp(int(p.x), 0, kSide - 1), z = std::clamp(int(p.y), 0, kSide - 1);
      fronts_[size_t(z * kSide + x)] |= bit;
    }
  }

  static dvec2 middle(const Bounds& box) {
    return 0.5 * (dvec2(box.min.x, box.min.z) + dvec2(box.max.x, box.max.z));
  }

  double cell_;
  dvec2 corner_;
  std::vector<uint16_t> fronts_ = std::vector<uint16_t>(size_t(kSide) * kSide);
  std::vector<bool> hasRoof_;
};

constexpr int kDirections = 32;
constexpr double kEyeHeight = 0.55;  // as a fraction of the room's height

dvec2 direction(int i) {
  const double angle = 2 * kPiD * i / kDirections;
  return {std::sin(angle), -std::cos(angle)};
}

// The squared sight distance in each direction, which is proportional to the area of its sector;
// negative in directions where no front face is seen.
using Panorama = std::array<double, kDirections>;

// Whether the size and the number of instances fit a furnished room.
bool isFurnishedRoom(const Bounds& box, const std::vector<int>& instances) {
  constexpr double kMinHeight = 2, kMaxHeight = 10, kMinWidth = 2.5;  // metres
  constexpr size_t kMinInstances = 5;
  const dvec3 size = box.size();
  return size.y >= kMinHeight && size.y <= kMaxHeight && std::min(size.x, size.z) >= kMinWidth &&
         instances.size() >= kMinInstances;
}

// Whether there are walls on all sides, except for a window or a door. (In a box without a front
// wall, the opening takes at least 53 degrees.)
bool isEnclosed(const Panorama& seen) {
  constexpr int kMaxOpen = 3;  // of 32 directions: 34 degrees
  return std::count_if(seen.begin(), seen.end(), [](double s) { return s < 0; }) <= kMaxOpen;
}

// The area of the region around the eye, m^2. Gaps count as nothing.
double areaAround(const Panorama& seen) {
  double sum = 0;
  for (const double squared : seen) sum += std::max(squared, 0.0);
  return double(kPi) * sum / double(seen.size());
}

// The area seen in a view centred on direction i, up to a factor; -infinity if the view has a gap.
double viewArea(const Panorama& seen, int i) {
  constexpr int kHalfView = 3;  // a view of 7/32 of a turn, 79 degrees
  double area = 0;
  for (int k = -kHalfView; k <= kHalfView; ++k) {
    const double sector = seen[size_t((i + k + kDirections) % kDirections)];
    area = sector < 0 ? -INFINITY : area + sector;
  }
  return area;
}

// The middle of the height between floor and ceiling, or the top of the box, where a person's eye
// would be; the eye's if it stands on nothing.
double heightWithin(const std::vector<Sight>& sights, const dvec3& eye, const Bounds& box) {
  const Sight &low = sights.front(), &high = sights.back();  // nearly vertical
  const double below = -low.direction.y * low.distance, above = high.direction.y * high.distance;
  if (below == INFINITY) return eye.y;
  const double top = above < INFINITY ? eye.y + above : double(box.max.y);
  return glm::mix(eye.y - below, top, kEyeHeight);
}

// Whether the eye stands on a floor: nearly everything below it is floor, walls and furniture,
// mostly level or upright. (Nothing is below an eye in the hole of a torus, and nothing is level
// within a body that is turned inside out.)
bool standsOnFloor(const std::vector<Sight>& sights) {
  constexpr double kBelow = -0.2, kLevel = 0.95, kUpright = 0.2;
  constexpr double kMinSeen = 0.9, kMinFlat = 0.6;
  double below = 0, seen = 0, flat = 0;
  for (const Sight& s : sights) {
    if (s.direction.y > kBelow) continue;
    ++below;
    seen += s.isWall();
    const double slope = std::fabs(s.normal.y);
    flat += s.isWall() && (slope > kLevel || slope < kUpright);
  }
  return seen > kMinSeen * below && flat > kMinFlat * seen;
}

bool contains(const Bounds& box, const dvec3& p) {
  return glm::all(glm::lessThanEqual(dvec3(box.min), p)) &&
         glm::all(glm::lessThanEqual(p, dvec3(box.max)));
}

// Whether most of the area of the walls is level or upright planes of a few directions. (Those of a
// bottle or of a body that is turned inside out have many.)
bool hasFlatWalls(const std::vector<Sight>& sights) {
  constexpr double kLevel = 0.95, kUpright = 0.2, kMinFlat = 0.6, kLeastCosine = 0.1;
  constexpr size_t kMostPlanes = 6;
  std::array<double, kDirections> upright{};  // by azimuth
  double walls = 0, flat = 0;
  for (const Sight& s : sights) {
    if (!s.isWall()) continue;
    const double cosine = std::fabs(glm::dot(s.normal, s.direction));
    const double area = s.distance * s.distance / std::max(cosine, kLeastCosine);
    walls += area;
    const double slope = std::fabs(s.normal.y);
    if (slope > kLevel) flat += area;
    const double turn = std::atan2(s.normal.x, s.normal.z) / (2 * kPiD) + 1;
    if (slope < kUpright) upright[size_t(std::lround(turn * kDirections)) % kDirections] += area;
  }
  std::ranges::sort(upright, std::greater());
  for (size_t i = 0; i < kMostPlanes; ++i) flat += upright[i];
  return flat > kMinFlat * walls;
}

// Whether the space that the eye sees is more than a part of the model, such as a trunk.
bool fills(const std::vector<Sight>& sights, const Bounds& box) {
  constexpr double kMinFilled = 0.2;
  double volume = 0;
  for (const Sight& s : sights)
    volume += std::pow(std::min(s.distance, glm::length(box.size())), 3);
  volume *= 4 * kPiD / 3 / double(sights.size());
  return volume > kMinFilled * box.size().x * box.size().y * box.size().z;
}

// Whether the eye sees furniture besides the walls.
bool seesSeveral(const std::vector<Sight>& sights) {
  constexpr size_t kMinSeen = 2;
  std::set<int> seen;
  for (const Sight& s : sights)
    if (s.isWall()) seen.insert(s.instance);
  return seen.size() >= kMinSeen;
}

}  // namespace

std::optional<dvec3> openSides(const std::vector<Sight>& sights, const dvec3& eye,
                               const Bounds& box, const OutsideViews& outside) {
  constexpr double kMaxShown = 0.5;
  constexpr int kSteps = 16;
  const double whole = glm::length(box.size());
  const bool isCovered = !outside[1].shows(eye, true);
  std::optional<dvec3> open;
  for (const int axis : {0, 2})
    for (const bool upper : {false, true}) {
      double space = 0, shown = 0;
      for (const Sight& s : sights)
        for (int k = 0; k < kSteps; ++k) {
          const double distance = (k + 0.5) / kSteps * std::min(s.distance, whole);
          const dvec3 point = eye + distance * s.direction;
          if (!contains(box, point)) break;
          if (isCovered && outside[1].shows(point, true)) continue;
          const double volume = distance * distance * std::min(s.distance, whole);
          space += volume;
          if (outside[size_t(axis)].shows(point, upper)) shown += volume;
        }
      if (!(shown > kMaxShown * space)) continue;
      if (!open) open = dvec3(0);
      (*open)[axis] += upper ? 1 : -1;
    }
  return open;
}

std::optional<InteriorView> interiorView(const Scene& scene, const std::vector<int>& instances,
                                         const Bounds& box, const OutsideViews& outside) {
  constexpr double kLeastRoom = 0.02;  // of the footprint; the legs of a table are smaller
  constexpr float kFov = kPi / 3;
  const bool isHollow = facesOf(outside).areBacks();
  const bool isFurnished = isFurnishedRoom(box, instances);
  if (!isFurnished && !isHollow) return std::nullopt;

  const double height = glm::mix(double(box.min.y), double(box.max.y), kEyeHeight);
  const Section section(scene, instances, box, height, outside[1]);
  const double footprint = double(box.size().x) * double(box.size().z);
  double maxArea = 0;
  bool isCovered = false;  // the best position
  dvec3 eye(0), target(0);
  for (int z = 0; z < Section::kSide; z += 4)
    for (int x = 0; x < Section::kSide; x += 4) {
      if (!section.isFree(x, z)) continue;
      Panorama seen;
      for (int i = 0; i < kDirections; ++i) {
        const auto distance = section.sightDistance(x, z, direction(i));
        seen[size_t(i)] = distance ? *distance * *distance : -1;
      }
      if (!isEnclosed(seen) || areaAround(seen) < kLeastRoom * footprint) continue;
      const dvec2 at = section.point(x, z);
      const bool hasRoof = section.hasRoof(x, z);
      if (isCovered && !hasRoof) continue;
      for (int i = 0; i < kDirections; ++i) {
        const double area = viewArea(seen, i);
        if (!(area > maxArea || (area > 0 && hasRoof && !isCovered))) continue;
        maxArea = area, isCovered = hasRoof;
        const dvec2 to = at + box.size().y * direction(i);
        eye = {at.x, height, at.y}, target = {to.x, height - 0.1 * box.size().y, to.y};
      }
    }
  if (maxArea == 0) return std::nullopt;
  const double rise = heightWithin(sightsFrom(scene, instances, eye), eye, box) - eye.y;
  eye.y += rise, target.y += rise;
  std::vector<Sight> sights = sightsFrom(scene, instances, eye);
  if (!standsOnFloor(sights) || openSides(sights, eye, box, outside)) return std::nullopt;
  const bool isBare = isHollow && hasFlatWalls(sights) && fills(sights, box);
  if (!isBare && !(isFurnished && seesSeveral(sights))) return std::nullopt;
  return InteriorView{Camera::lookAt(vec3(eye), vec3(target), vec3(0, 1, 0), kFov),
                      std::move(sights)};
}

}  // namespace chromeball
