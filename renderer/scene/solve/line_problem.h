// SPDX-License-Identifier: Apache-2.0
// The distances of lines from those to their vanishing points, as a least-squares problem
// (levenberg_marquardt.h).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "math/vec.h"

namespace chromeball {

struct CentredLine {
  int axis;
  glm::dvec2 middle, half;  // half: from the middle to the second end; pixels, right and up
};

// The rotation from the scene to the camera (x right, y up, z back).
struct LineView {
  glm::dmat3 rotation{1};
  double focalLength = 1;  // pixels
};

class LineProblem {
 public:
  using State = LineView;

  // `lines` must outlive this.
  LineProblem(const std::vector<CentredLine>& lines, bool findsFocalLength)
      : lines_(lines), findsFocalLength_(findsFocalLength) {}

  int unknowns() const { return findsFocalLength_ ? 4 : 3; }

  // The direction in which the picture of a point at the line's middle moves, if the point moves
  // along the axis; of any length.
  static glm::dvec2 flow(const LineView& view, const CentredLine& line);

  // Signed distances of the second ends. The unknowns: rotation about the camera's axes, logarithm
  // of the focal length.
  bool residuals(const LineView& view, Eigen::VectorXd& residual, Eigen::MatrixXd* jacobian) const;
  LineView moved(const LineView& view, const Eigen::VectorXd& step) const;

 private:
  const std::vector<CentredLine>& lines_;
  bool findsFocalLength_;
};

}  // namespace chromeball
