// SPDX-License-Identifier: Apache-2.0
#include "scene/solve/point_problem.h"

#include "math/dense_solvers.h"
#include "math/rotation.h"

namespace chromeball {

using glm::dmat3, glm::dvec2, glm::dvec3;

namespace {

using ErrorRow = Eigen::RowVectorXd;

// The derivatives of one coordinate (0 right, 1 up) of c.
ErrorRow slopeOf(int axis, double c, const dvec3& q, double weight, double nearness, double zoom,
                 const std::optional<double>& focalLength, int unknowns) {
  dvec3 byPoint(0);
  byPoint[axis] = zoom;
  byPoint.z = c * nearness;
  const dvec3 byRotation = glm::cross(q, byPoint);
  ErrorRow row = ErrorRow::Zero(unknowns);
  for (int i = 0; i < 3; ++i) row[i] = byRotation[i];
  row[3 + axis] = 1;
  row[5] = c * q.z + (focalLength ? *focalLength * q[axis] : 0);
  if (!focalLength) row[6] = q[axis];
  return row / weight;
}

}  // namespace

bool PointProblem::residuals(const PointView& v, Eigen::VectorXd& residual,
                             Eigen::MatrixXd* jacobian) const {
  constexpr double kLeastWeight = 1e-9;  // of a distance: not behind the camera
  const double zoom = zoomOf(v);
  if (!(zoom > 0)) return false;
  residual.resize(Eigen::Index(2 * points_.size()));
  if (jacobian) jacobian->resize(residual.size(), unknowns());
  for (size_t i = 0; i < points_.size(); ++i) {
    const dvec3 q = v.rotation * points_[i].position;
    const double weight = 1 - v.nearness * q.z;
    if (!(weight > kLeastWeight)) return false;
    const dvec2 c = (zoom * dvec2(q) + v.centre) / weight;
    const double r2 = glm::dot(c, c);
    const dvec2 error = c * (1 + v.bend * r2) - points_[i].pixel;
    const Eigen::Index row = Eigen::Index(2 * i);
    residual[row] = error.x, residual[row + 1] = error.y;
    if (!jacobian) continue;
    ErrorRow slopes[2];
    for (int axis = 0; axis < 2; ++axis)
      slopes[axis] = slopeOf(axis, c[axis], q, weight, v.nearness, zoom, focalLength_, unknowns());
    for (int axis = 0; axis < 2; ++axis) {
      const dvec2 byC = 2 * v.bend * c[axis] * c;
      jacobian->row(row + axis) =
          byC.x * slopes[0] + byC.y * slopes[1] + (1 + v.bend * r2) * slopes[axis];
      if (bends_) (*jacobian)(row + axis, bendAt()) = c[axis] * r2;
    }
  }
  return true;
}

PointView PointProblem::moved(const PointView& view, const Eigen::VectorXd& step) const {
  PointView moved = view;
  moved.rotation = rotationBy({step[0], step[1], step[2]}) * view.rotation;
  moved.centre += dvec2(step[3], step[4]);
  moved.nearness += step[5];
  if (!focalLength_) moved.zoom += step[zoomAt()];
  if (bends_) moved.bend += step[bendAt()];
  return moved;
}

// For a given rotation, c weight = zoom q + centre is linear in the other unknowns.
std::optional<PointView> PointProblem::viewWith(const dmat3& rotation) const {
  const Eigen::Index rows = Eigen::Index(2 * points_.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, focalLength_ ? 3 : 4);
  Eigen::VectorXd right(rows), residual;
  dvec2 centre(0);
  for (const CentredPoint& p : points_) centre += p.pixel / double(points_.size());
  double spread = 0, spreadSeen = 0, nearest = 0;
  for (size_t i = 0; i < points_.size(); ++i) {
    const dvec3 q = rotation * points_[i].position;
    const dvec2 pixel = points_[i].pixel, offset = pixel - centre;
    spread += q.x * q.x + q.y * q.y;
    spreadSeen += glm::dot(offset, offset);
    nearest = std::max(nearest, q.z);
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Index row = Eigen::Index(2 * i) + axis;
      matrix(row, axis) = 1;
      matrix(row, 2) = pixel[axis] * q.z + (focalLength_ ? *focalLength_ * q[axis] : 0);
      if (!focalLength_) matrix(row, 3) = q[axis];
      right[row] = pixel[axis];
    }
  }
  const Eigen::VectorXd x = solveLeastSquares(matrix, right);
  PointView view{rotation, {x[0], x[1]}, x[2], focalLength_ ? 0 : x[3]};
  if (x.allFinite() && residuals(view, residual, nullptr)) return view;

  const double zoom = std::sqrt(spreadSeen / spread);
  view = {rotation, centre, 0, zoom};
  if (focalLength_) view.nearness = std::min(zoom / *focalLength_, 0.9 / nearest);
  if (!residuals(view, residual, nullptr)) return std::nullopt;
  return view;
}

}  // namespace chromeball
