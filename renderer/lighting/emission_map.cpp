// SPDX-License-Identifier: Apache-2.0
#include "lighting/emission_map.h"

#include <algorithm>
#include <cmath>

namespace chromeball {

EmissionMap::EmissionMap(const Scene& scene, const Material& material)
    : slot_(material.emissiveTexture), texture_(scene.textures[size_t(slot_.texture)]) {
  const TexelGrid& grid = *texture_.grid;
  cellSize_ = (std::max(grid.width, grid.height) + kMaxCells - 1) / kMaxCells;
  columns_ = (grid.width + cellSize_ - 1) / cellSize_;
  rows_ = (grid.height + cellSize_ - 1) / cellSize_;
  sums_.resize(size_t(columns_ + 1) * size_t(rows_ + 1));
  for (int row = 0; row < rows_; ++row) {
    std::vector<Sums> cells(static_cast<size_t>(columns_));
    for (int y = row * cellSize_; y < std::min((row + 1) * cellSize_, grid.height); ++y)
      for (int x = 0; x < grid.width; ++x) {
        const Rgb texel(linearTexel(grid, texture_.srgb, x, y));
        const double emitted = double(std::max(luminance(material.emission * texel), 0.0f));
        Sums& cell = cells[size_t(x / cellSize_)];
        cell.luminance += emitted;
        cell.lit += !isBlack(material.emission * texel);
        largest_ = std::max(largest_, emitted);
      }
    Sums ofRow;
    const size_t above = size_t(row) * size_t(columns_ + 1), here = above + size_t(columns_ + 1);
    for (size_t i = 0; i < cells.size(); ++i) {
      ofRow.luminance += cells[i].luminance, ofRow.lit += cells[i].lit;
      sums_[here + i + 1] = {sums_[above + i + 1].luminance + ofRow.luminance,
                             sums_[above + i + 1].lit + ofRow.lit};
    }
  }
}

// The cells of all texels that lookups between two coordinates read: two ranges where the texture
// repeats in between, of which one may be empty.
std::array<EmissionMap::Range, 2> EmissionMap::cellsOf(float from, float to, float error,
                                                       int texels, Wrap wrap) const {
  const auto cells = [&](double first, double last) -> Range {
    return {int(first) / cellSize_, int(last) / cellSize_ + 1};
  };
  const double size = texels, end = size - 1;
  double first = std::floor((double(from) - double(error)) * size - 0.5);
  double last = std::floor((double(to) + double(error)) * size - 0.5) + 1;
  if (!(last - first < size)) return {cells(0, end), {0, 0}};
  if (wrap == Wrap::ClampToEdge)
    return {cells(std::clamp(first, 0.0, end), std::clamp(last, 0.0, end)), {0, 0}};
  const double period = std::floor(first / size);
  first -= period * size, last -= period * size;  // last may be in the next period
  const bool isMirrored = wrap == Wrap::MirroredRepeat && std::fmod(period, 2) != 0;
  if (last < size)
    return {isMirrored ? cells(end - last, end - first) : cells(first, last), {0, 0}};
  if (wrap == Wrap::Repeat) return {cells(first, end), cells(0, last - size)};
  return {isMirrored ? cells(0, std::max(end - first, last - size))
                     : cells(std::min(first, end - (last - size)), end),
          {0, 0}};
}

EmissionMap::Sums EmissionMap::sumOf(Range columns, Range rows) const {
  const auto at = [&](int column, int row) -> const Sums& {
    return sums_[size_t(row) * size_t(columns_ + 1) + size_t(column)];
  };
  const Sums &a = at(columns.begin, rows.begin), &b = at(columns.end, rows.begin),
             &c = at(columns.begin, rows.end), &d = at(columns.end, rows.end);
  return {d.luminance - b.luminance - c.luminance + a.luminance, d.lit - b.lit - c.lit + a.lit};
}

double EmissionMap::mean(const Mesh& mesh, const Triangle& triangle) const {
  vec2 uv[3]{vec2(0), vec2(0), vec2(0)};  // as lookup() (scene/surface.h) without coordinates
  if (slot_.uvSet < int(mesh.uvs.size()) && !mesh.uvs[size_t(slot_.uvSet)].empty())
    for (int i = 0; i < 3; ++i) uv[i] = mesh.uvs[size_t(slot_.uvSet)][size_t(triangle[i])];
  vec2 error(0);  // of interpolated and transformed coordinates: rounding
  for (vec2& corner : uv) {
    const vec2 sizes(glm::dot(glm::abs(slot_.uvRow0), glm::abs(corner)),
                     glm::dot(glm::abs(slot_.uvRow1), glm::abs(corner)));
    error = glm::max(error, 1e-6f * (sizes + glm::abs(slot_.uvOffset)));
    corner = slot_.transform(corner);
  }
  const vec2 all = uv[0] + uv[1] + uv[2];
  if (!std::isfinite(all.x) || !std::isfinite(all.y)) return largest_;  // read as texel 0
  const vec2 low = glm::min(glm::min(uv[0], uv[1]), uv[2]);
  const vec2 high = glm::max(glm::max(uv[0], uv[1]), uv[2]);
  const TexelGrid& grid = *texture_.grid;
  Sums sum;
  double texels = 0;
  for (const Range rows : cellsOf(low.y, high.y, error.y, grid.height, texture_.wrapT))
    for (const Range columns : cellsOf(low.x, high.x, error.x, grid.width, texture_.wrapS)) {
      const Sums part = sumOf(columns, rows);
      sum.luminance += part.luminance, sum.lit += part.lit;
      texels += double(columns.end - columns.begin) * double(rows.end - rows.begin) *
                double(cellSize_) * double(cellSize_);
    }
  if (sum.lit == 0) return 0;
  // A thin diagonal triangle may have all light of its rectangle.
  const glm::dvec2 a(uv[1] - uv[0]), b(uv[2] - uv[0]), extent(high - low);
  const double area = 0.5 * std::fabs(a.x * b.y - a.y * b.x), box = extent.x * extent.y;
  const double share = box > 0 && area > 0 ? area / box : 0.5;  // a half: of most triangles
  constexpr double kLeast = 1e-6;  // of the largest: the sums have rounding errors
  return std::clamp(sum.luminance / (share * texels), kLeast * largest_, largest_);
}

}  // namespace chromeball
