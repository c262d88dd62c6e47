// SPDX-License-Identifier: Apache-2.0
#include "scene/solve/solve_camera.h"

#include <Eigen/Core>

#include <array>

#include "base/error.h"
#include "math/dense_solvers.h"
#include "math/rotation.h"

namespace chromeball {
namespace {

// The distances of lines from the lines to their vanishing points, as a least-squares problem
// (minimise()).
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

  // The direction in which the image of a point at the line's middle moves if the point moves along
  // the axis, of any length. The vanishing point of the direction d is f (d.x, d.y) / -d.z; minus
  // the middle, times -d.z.
  static dvec2 flow(const LineView& view, const CentredLine& line) {
    const dvec3& d = view.rotation[line.axis];
    return view.focalLength * dvec2(d) + d.z * line.middle;
  }

  // The residuals are signed distances of the second ends. With the unit flow e, one is
  // cross(half, e); it changes by cross(half, n) dot(n, flow's change) / |flow| with n
  // perpendicular to e. The unknowns: rotation about the camera's axes, logarithm of the focal
  // length.
  bool residuals(const LineView& view, Eigen::VectorXd& residual, Eigen::MatrixXd* jacobian) const {
    residual.resize(Eigen::Index(lines_.size()));
    if (jacobian) jacobian->resize(residual.size(), findsFocalLength_ ? 4 : 3);
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

  LineView moved(const LineView& view, const Eigen::VectorXd& step) const {
    constexpr double kMost = 2;
    LineView moved = view;
    moved.rotation = rotationBy({step[0], step[1], step[2]}) * view.rotation;
    if (findsFocalLength_) moved.focalLength *= std::exp(std::clamp(step[3], -kMost, kMost));
    return moved;
  }

 private:
  const std::vector<CentredLine>& lines_;
  bool findsFocalLength_;
};

using glm::dmat3;
using FoundByLines = Minimum<LineView>;

constexpr char kAxes[] = "xyz";

void checkCount(const std::vector<ObservedLine>& lines, const std::string& file) {
  std::array<int, 3> counts{};
  for (const ObservedLine& line : lines) ++counts[size_t(line.axis)];
  if (std::ranges::count_if(counts, [](int count) { return count >= 2; }) < 2)
    throwInput(
        "{}: has {} lines along x, {} along y and {} along z; at least two axes need two "
        "lines each",
        file, counts[0], counts[1], counts[2]);
}

// The rotation, turned by half turns about the scene's axes so that lines run along the positive
// axes: the distances do not determine that.
dmat3 directed(const LineView& view, const std::vector<ObservedLine>& observed,
               const std::vector<CentredLine>& lines, const std::string& file) {
  std::array<std::optional<size_t>, 3> first;  // line of each axis
  std::array<double, 3> sign{};                // 0: no line tells it
  for (size_t i = 0; i < lines.size(); ++i) {
    const size_t axis = size_t(lines[i].axis);
    const double own = glm::dot(lines[i].half, LineProblem::flow(view, lines[i])) > 0 ? 1 : -1;
    if (sign[axis] * own < 0)
      throwInput(
          "{}: the line runs along {} in the opposite direction as that of {}; both should "
          "go from one end to the other along the positive axis",
          observed[i].location, kAxes[axis], observed[*first[axis]].location);
    sign[axis] = own;
    if (!first[axis]) first[axis] = i;
  }
  for (size_t axis = 0; axis < 3; ++axis)
    if (sign[axis] == 0) sign[axis] = sign[(axis + 1) % 3] * sign[(axis + 2) % 3];
  if (sign[0] * sign[1] * sign[2] < 0)
    throwInput(
        "{}: the lines run along the axes of a left-handed system; swap the ends of all "
        "lines of one axis",
        file);
  dmat3 rotation = view.rotation;
  for (int axis = 0; axis < 3; ++axis) rotation[axis] *= sign[size_t(axis)];
  return rotation;
}

FoundByLines search(const std::vector<CentredLine>& lines, const CameraKnowledge& known) {
  constexpr int kStarts = 128, kMostSteps = 100;
  const double guess = focalLengthOfFov(known.size, glm::radians(45.0));
  const LineProblem problem(lines, !known.focalLength);
  std::optional<FoundByLines> best;
  for (const dmat3& rotation : spreadRotations(kStarts)) {
    const LineView start{rotation, known.focalLength.value_or(guess)};
    Eigen::VectorXd residual;
    if (!problem.residuals(start, residual, nullptr)) continue;
    FoundByLines found = minimise(problem, start, kMostSteps);
    if (!best || found.squares < best->squares) best = std::move(found);
  }
  return *best;
}

CameraErrors errorsOf(const FoundByLines& found, const CameraKnowledge& known, size_t count,
                      const std::string& file) {
  constexpr double kLeastPivot = 1e-13, kExtreme = 500;  // kExtreme: f / h or h / f
  const double f = found.state.focalLength, h = 0.5 * known.size.height;
  const SymmetricEigen eigen = eigenOfSymmetric(found.normal);
  if (!(eigen.values.minCoeff() > kLeastPivot * eigen.values.maxCoeff()) ||
      !(f < kExtreme * h && h < kExtreme * f))
    throwInput(
        "{}: the lines do not tell the field of view; give it, or lines of another axis, or "
        "of axes that both are oblique to the picture",
        file);
  const int freedom = int(count) - int(found.normal.rows());
  CameraErrors errors;
  // A line has one equation, for two ends. Without any to spare, the error is unknown.
  const Eigen::MatrixXd covariance =
      (freedom > 0 ? found.squares / freedom : std::nan("")) * inverseOf(found.normal);
  for (int axis = 0; axis < 3; ++axis) errors.rotation[axis] = std::sqrt(covariance(axis, axis));
  if (!known.focalLength) errors.fov = std::sqrt(covariance(3, 3)) * f * 2 * h / (f * f + h * h);
  return errors;
}

// The point of the ground at y = -1 that is seen from the origin in this direction.
dvec3 onGround(const dvec3& direction, const std::string& location) {
  if (!(direction.y < -1e-6))
    throwInput("{}: is not below the horizon; it should show a point of the ground, y = 0",
               location);
  return direction / -direction.y;
}

// The coordinate along the axis through `from` at which it is nearest to the ray from the origin.
double alongAxis(const dvec3& from, int axis, const dvec3& direction) {
  dvec3 along(0);
  along[axis] = 1;
  const double b = glm::dot(along, direction);
  return (b * glm::dot(direction, from) - glm::dot(along, from)) / (1 - b * b);
}

dvec3 positionOf(const SolvedCamera& camera, const std::vector<ObservedLine>& lines,
                 const LinePlacement& placement, const std::string& file) {
  // The height from the lines of known length, by least squares.
  double product = 0, squares = 0;
  std::optional<dvec3> origin;  // on the ground, for a camera of height 1
  for (const ObservedLine& line : lines) {
    if (!line.length) continue;
    const dvec3 from = onGround(camera.directionAt(line.from), line.location);
    const double length = alongAxis(from, line.axis, camera.directionAt(line.to));
    if (!(length > 0))
      throwInput("{}: the line ends behind its beginning; check its ends", line.location);
    product += length * *line.length;
    squares += length * length;
    if (!origin) origin = from;
  }
  if (placement.height && squares > 0)
    throwInput(
        "{}: a line has a length, which gives the scale; leave out the height, or the length",
        file);
  if (!placement.height && squares == 0)
    throwInput(
        "{}: nothing tells the scale; give the camera's height above the ground, or a "
        "line's length in metres as sixth column",
        file);
  const double height = placement.height ? *placement.height : product / squares;
  if (placement.origin) origin = onGround(camera.directionAt(*placement.origin), "the origin");
  return -height * origin.value_or(dvec3(0, -1, 0));
}

}  // namespace

CameraFit solveByLines(const std::vector<ObservedLine>& observed, const CameraKnowledge& known,
                       const LinePlacement& placement, const std::string& file) {
  checkCount(observed, file);
  const dvec2 principal = known.principalPoint * dvec2(known.size.width, known.size.height);
  std::vector<CentredLine> lines;
  for (const ObservedLine& line : observed) {
    const dvec2 middle = 0.5 * (line.from + line.to) - principal,
                half = 0.5 * (line.to - line.from);
    lines.push_back({line.axis, {middle.x, -middle.y}, {half.x, -half.y}});
  }
  const FoundByLines found = search(lines, known);
  CameraFit fit;
  fit.errors = errorsOf(found, known, lines.size(), file);
  fit.camera.size = known.size;
  fit.camera.principalPoint = known.principalPoint;
  fit.camera.focalLength = found.state.focalLength;
  fit.camera.axes = glm::transpose(directed(found.state, observed, lines, file));
  fit.camera.position = positionOf(fit.camera, observed, placement, file);
  fit.camera.distance = glm::length(fit.camera.position);
  Eigen::VectorXd residual;
  LineProblem(lines, false).residuals(found.state, residual, nullptr);
  for (const double distance : residual) fit.distances.push_back(std::abs(distance));
  return fit;
}

}  // namespace chromeball
