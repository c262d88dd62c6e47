// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/tile.h"

#include "base/parallel.h"
#include "probe/mapping.h"
#include "probe/solid_angle.h"

namespace chromeball {

TileView::TileView(const Tile& tile)
    : image_(tile.image),
      pose_(tile.pose.quaternion()),
      halfWidth_(std::tan(glm::radians(tile.fov) / 2) * tile.image.width / tile.image.height),
      halfHeight_(std::tan(glm::radians(tile.fov) / 2)) {}

TileView::Seen TileView::at(const glm::dvec3& direction, const glm::dquat& pose) const {
  const glm::dvec3 d = glm::conjugate(pose) * direction;
  if (!(d.z < 0)) return {};
  const double right = d.x / -d.z / halfWidth_, up = d.y / -d.z / halfHeight_;
  if (!(std::fabs(right) < 1 && std::fabs(up) < 1)) return {};
  const double x = std::clamp((1 + right) / 2 * image_.width - 0.5, 0.0, image_.width - 1.0);
  const double y = std::clamp((1 - up) / 2 * image_.height - 0.5, 0.0, image_.height - 1.0);
  const int x0 = int(x), y0 = int(y);
  const int x1 = std::min(x0 + 1, image_.width - 1), y1 = std::min(y0 + 1, image_.height - 1);
  const float s = float(x - x0), t = float(y - y0);
  Seen seen;
  seen.radiance = (1 - t) * ((1 - s) * image_.rgb(x0, y0) + s * image_.rgb(x1, y0)) +
                  t * ((1 - s) * image_.rgb(x0, y1) + s * image_.rgb(x1, y1));
  seen.weight = float(std::cos(0.5 * kPiD * right) * std::cos(0.5 * kPiD * up));
  return seen;
}

double TileView::pixelAngle() const { return 2 * halfHeight_ / image_.height; }

std::vector<Overlap> overlapsOf(std::span<const TileView> views, int height) {
  const ImageSize size{2 * height, height};
  std::vector<std::vector<Overlap>> rows(static_cast<size_t>(height));
  forRows(size.width, height, views.size(), [&](int y) {
    std::vector<std::pair<int, float>> seen;
    const double solidAngle = texelSolidAngle(y, size.width, height);
    for (int x = 0; x < size.width; ++x) {
      const dvec3 d = texelDirection(size, x, y);
      seen.clear();
      for (size_t i = 0; i < views.size(); ++i)
        if (const float weight = views[i].at(d).weight; weight > 0)
          seen.emplace_back(int(i), weight);
      for (size_t i = 0; i < seen.size(); ++i)
        for (size_t j = i + 1; j < seen.size(); ++j)
          rows[size_t(y)].push_back({seen[i].first, seen[j].first, d,
                                     float(solidAngle) * seen[i].second * seen[j].second});
    }
  });
  std::vector<Overlap> all;
  for (const auto& row : rows) all.insert(all.end(), row.begin(), row.end());
  return all;
}

}  // namespace chromeball
