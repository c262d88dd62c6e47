// SPDX-License-Identifier: Apache-2.0
// The reprojection error of known points, as a least-squares problem (minimise() of
// math/dense_solvers.h).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "math/vec.h"

namespace chromeball {

struct CentredPoint {
  glm::dvec3 position;  // relative to the middle of all
  glm::dvec2 pixel;     // right and up from the principal point
};

// The camera shows the point q = rotation x position (x right, y up, z back) at
//   c (1 + bend |c|^2)  with  c = (zoom (q.x, q.y) + centre) / (1 - nearness q.z):
// an affine view (nearness 0) with perspective. Compared with position and focal length f, these
// values depend little on each other even for distant cameras and flat objects, so that descents
// from wrong rotations find the way: nearness = 1 / distance, zoom = f / distance, k1 = bend f^2.
struct PointView {
  glm::dmat3 rotation{1};  // from the scene to the camera
  glm::dvec2 centre{0};    // pixels: where the middle of all appears
  double nearness = 0;     // 1 / metres
  double zoom = 0;         // pixels per metre; unused if f is given
  double bend = 0;         // 1 / pixels^2
};

class PointProblem {
 public:
  using State = PointView;

  // `points` must outlive this. `focalLength` in pixels; nullopt: to be found.
  PointProblem(const std::vector<CentredPoint>& points, std::optional<double> focalLength,
               bool bends)
      : points_(points), focalLength_(focalLength), bends_(bends) {}

  int unknowns() const { return bendAt() + bends_; }
  int zoomAt() const { return 6; }
  int bendAt() const { return focalLength_ ? 6 : 7; }
  double zoomOf(const PointView& v) const {
    return focalLength_ ? *focalLength_ * v.nearness : v.zoom;
  }

  // Right and up of each point. The unknowns: rotation about the camera's axes (0 to 2), centre (3,
  // 4), nearness (5), zoom, bend.
  bool residuals(const PointView& view, Eigen::VectorXd& residual, Eigen::MatrixXd* jacobian) const;
  PointView moved(const PointView& view, const Eigen::VectorXd& step) const;

  // The linear solution for a given rotation, or else a view without perspective; nullopt if that
  // is behind a point.
  std::optional<PointView> viewWith(const glm::dmat3& rotation) const;

 private:
  const std::vector<CentredPoint>& points_;
  std::optional<double> focalLength_;
  bool bends_;
};

}  // namespace chromeball
