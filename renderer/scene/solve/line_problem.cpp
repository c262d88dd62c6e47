// SPDX-License-Identifier: Apache-2.0
#include "scene/solve/line_problem.h"

#include "scene/solve/spread_rotations.h"

namespace chromeball {

using glm::dvec2, glm::dvec3;

namespace {

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

}  // namespace

// The vanishing point of the direction d is f (d.x, d.y) / -d.z; minus the middle, times -d.z.
dvec2 LineProblem::flow(const LineView& view, const CentredLine& line) {
  const dvec3& d = view.rotation[line.axis];
  return view.focalLength * dvec2(d) + d.z * line.middle;
}

// With the unit flow e, the residual is cross(half, e); it changes by cross(half, n) dot(n, flow's
// change) / |flow| with n perpendicular to e.
bool LineProblem::residuals(const LineView& view, Eigen::VectorXd& residual,
                            Eigen::MatrixXd* jacobian) const {
  residual.resize(Eigen::Index(lines_.size()));
  if (jacobian) jacobian->resize(residual.size(), unknowns());
  const double f = view.focalLength;
  for (size_t i = 0; i < lines_.size(); ++i) {
    const CentredLine& line = lines_[i];
    const dvec2 along = flow(view, line);
    const double length = glm::length(along);
    if (!(length > 0) || !std::isfinite(length)) return false;
    const dvec2 e = along / length, n(-e.y, e.x);
    const Eigen::Index row = Eigen::Index(i);
    residual[row] = cross(line.half, e);
    if (!jacobian) continue;
    const double byFlow = cross(line.half, n) / length;
    const dvec3 d = view.rotation[line.axis];
    const dvec3 byRotation = glm::cross(d, dvec3(f * n, glm::dot(n, line.middle)));
    for (int k = 0; k < 3; ++k) (*jacobian)(row, k) = byFlow * byRotation[k];
    if (findsFocalLength_) (*jacobian)(row, 3) = byFlow * f * glm::dot(n, dvec2(d));
  }
  return true;
}

LineView LineProblem::moved(const LineView& view, const Eigen::VectorXd& step) const {
  constexpr double kMost = 2;
  LineView moved = view;
  moved.rotation = rotationBy({step[0], step[1], step[2]}) * view.rotation;
  if (findsFocalLength_) moved.focalLength *= std::exp(std::clamp(step[3], -kMost, kMost));
  return moved;
}

}  // namespace chromeball
