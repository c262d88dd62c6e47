// SPDX-License-Identifier: Apache-2.0
#include "lighting/constellation/penrose.h"

#include <numeric>

#include "probe/mapping.h"

namespace chromeball {
namespace {

constexpr double kSmall = 0.2;  // maximum radius / distance to a light of an undivided block

}  // namespace

struct BlockPyramid::Assignment {
  const std::vector<dvec3>& directions;
  std::vector<glm::ivec2> cells;  // of the lights
  std::vector<dvec3> powers;      // of the lights
  // [level]: the lights that may be the nearest one to some point of the current block.
  std::vector<std::vector<int>> candidates;
};

BlockPyramid::BlockPyramid(const TexelTable& table) : table_(table) {
  glm::ivec2 below(table.width(), table.height());
  for (int k = 1; below.x > 1 || below.y > 1; ++k) {
    Level level{(below + 1) / 2, {}};
    level.blocks.reserve(size_t(level.size.x) * level.size.y);
    for (int y = 0; y < level.size.y; ++y)
      for (int x = 0; x < level.size.x; ++x) {
        dvec3 power(0);
        for (int j = 2 * y; j < std::min(2 * y + 2, below.y); ++j)
          for (int i = 2 * x; i < std::min(2 * x + 2, below.x); ++i)
            power += block(k - 1, i, j).power;
        level.blocks.push_back(makeBlock(power, 1 << k, x, y));
      }
    below = level.size;
    levels_.push_back(std::move(level));
  }
}

BlockPyramid::Block BlockPyramid::makeBlock(const dvec3& power, int size, int x, int y) const {
  const dvec2 low = table_.uv(double(x) * size, double(y) * size);
  const dvec2 high = table_.uv((x + 1.0) * size, (y + 1.0) * size);
  const dvec2 middle = 0.5 * (low + high), half = kPiD * dvec2(1, 0.5) * (high - low);
  // chord^2 <= (max sin(theta) dphi)^2 + dtheta^2
  const double sine = std::fmin(std::sin(kPiD * middle.y) + half.y, 1.0);
  return {power, *uvToDirection(Mapping::LatLong, middle), std::hypot(sine * half.x, half.y)};
}

BlockPyramid::Block BlockPyramid::block(int level, int x, int y) const {
  if (level == 0) return makeBlock(table_.at(x, y).power, 1, x, y);
  const Level& at = levels_[level - 1];
  return at.blocks[size_t(y) * at.size.x + x];
}

std::vector<dvec3> BlockPyramid::assignToNearest(const std::vector<dvec3>& directions) const {
  const int top = int(levels_.size());
  Assignment assignment{directions, {}, std::vector<dvec3>(directions.size(), dvec3(0)), {}};
  for (const dvec3& direction : directions)
    assignment.cells.push_back(table_.cellAt(directionToUv(Mapping::LatLong, direction)));
  assignment.candidates.resize(top + 2);
  assignment.candidates[top + 1].resize(directions.size());
  std::iota(assignment.candidates[top + 1].begin(), assignment.candidates[top + 1].end(), 0);
  assign(assignment, top, 0, 0);
  return std::move(assignment.powers);
}

// Let d be the distance from the block's middle to the nearest light. By the triangle inequality
// only lights within d + 2 radius of the middle can be nearest to a point of the block.
void BlockPyramid::assign(Assignment& assignment, int level, int x, int y) const {
  const Block here = block(level, x, y);
  if (here.power == dvec3(0)) return;
  const auto distance = [&](int i) { return glm::distance(here.middle, assignment.directions[i]); };
  double minimum = 4;
  int nearest = -1;
  for (int i : assignment.candidates[level + 1])
    if (const double d = distance(i); d < minimum) minimum = d, nearest = i;
  std::vector<int>& candidates = assignment.candidates[level];
  candidates.clear();
  for (int i : assignment.candidates[level + 1])
    if (distance(i) <= minimum + 2 * here.radius) candidates.push_back(i);

  if (candidates.size() == 1 || here.radius < kSmall * minimum) {
    assignment.powers[nearest] += here.power;
  } else if (level > 0) {
    const glm::ivec2 below =
        level > 1 ? levels_[level - 2].size : glm::ivec2(table_.width(), table_.height());
    for (int j = 2 * y; j < std::min(2 * y + 2, below.y); ++j)
      for (int i = 2 * x; i < std::min(2 * x + 2, below.x); ++i)
        assign(assignment, level - 1, i, j);
  } else {
    const auto inside = [&](int i) { return assignment.cells[i] == glm::ivec2(x, y); };
    const auto lights = std::count_if(candidates.begin(), candidates.end(), inside);
    if (lights == 0) assignment.powers[nearest] += here.power;
    for (int i : candidates)
      if (inside(i)) assignment.powers[i] += here.power / double(lights);
  }
}

}  // namespace chromeball
