// SPDX-License-Identifier: Apache-2.0
#include "scene/solve/solve_camera.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "math/dense_solvers.h"
#include "math/rotation.h"
#include "scene/solve/point_problem.h"

namespace chromeball {
namespace {

using glm::dmat3;
using FoundByPoints = Minimum<PointView>;

void checkCount(size_t count, const CameraKnowledge& known, const std::string& file) {
  if (count >= fewestPoints(known)) return;
  if (known.focalLength)
    throwInput("{}: {} points are too few for a camera's position and rotation; it takes {}", file,
               count, fewestPoints(known));
  throwInput(
      "{}: {} points are too few for a camera and its field of view; it takes {}, or {} if "
      "the field of view is given",
      file, count, fewestPoints(known), fewestPoints({.focalLength = 1}));
}

// The extents of the points along orthogonal axes, the largest first, and the last axis: the normal
// of the plane that they lie on, or are nearest to.
struct Extents {
  dvec3 lengths;
  dvec3 normal;

  explicit Extents(const std::vector<CentredPoint>& points) {
    Eigen::MatrixXd positions(points.size(), 3);
    for (size_t i = 0; i < points.size(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        positions(Eigen::Index(i), axis) = points[i].position[axis];
    const SymmetricEigen eigen = eigenOfSymmetric(normalMatrix(positions));
    for (int axis = 0; axis < 3; ++axis) {
      lengths[axis] = std::sqrt(std::max(eigen.values[2 - axis], 0.0));
      normal[axis] = eigen.vectors(axis, 0);
    }
  }
};

void checkSpread(const std::vector<ObservedPoint>& points, const Extents& extents,
                 const std::string& file) {
  constexpr double kThin = 1e-6;
  for (size_t i = 0; i < points.size(); ++i)
    for (size_t k = 0; k < i; ++k)
      if (points[i].position == points[k].position)
        throwInput("{}: `{}` is at the same position as `{}`", points[i].location, points[i].name,
                   points[k].name);
  if (!(extents.lengths[1] > kThin * extents.lengths[0]))
    throwInput("{}: the points lie on a line; a camera needs some beside it", file);
  if (std::ranges::all_of(points, [&](const auto& p) { return p.pixel == points[0].pixel; }))
    throwInput("{}: all points have the same place in the picture", file);
}

// A view that shows points of a plane at the same places, with depths and nearness reversed: q.z
// becomes -q.z if the points are reflected in their plane, which does not move them, and then in
// the picture's plane.
PointView reversed(const PointView& view, const dvec3& normal) {
  PointView other = view;
  other.nearness = -view.nearness;
  const dmat3 inPlane = dmat3(1) - 2.0 * glm::outerProduct(normal, normal);
  other.rotation = dmat3(dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, -1)) * view.rotation * inPlane;
  return other;
}

// Whether it fits equally well, up to rounding.
bool isAsGood(const FoundByPoints& found, const FoundByPoints& best, size_t points) {
  constexpr double kRounding = 1e-6;  // also pixels
  return found.squares <= (1 + kRounding) * best.squares + kRounding * kRounding * double(points);
}

// Minima of different rotations, the best first; among equal ones, those with the points in front
// of the camera.
std::vector<FoundByPoints> search(const std::vector<CentredPoint>& points, const dvec3& normal,
                                  const CameraKnowledge& known) {
  constexpr int kStarts = 128, kFirstSteps = 10, kMostSteps = 300;
  constexpr size_t kKept = 12;
  const double kDifferent = glm::radians(3.0);
  const auto distinct = [&](std::vector<FoundByPoints> all) {
    std::ranges::stable_sort(all, {}, &FoundByPoints::squares);
    std::vector<FoundByPoints> kept;
    for (FoundByPoints& one : all)
      if (kept.size() < kKept && std::ranges::none_of(kept, [&](const FoundByPoints& other) {
            return angleBetween(one.state.rotation, other.state.rotation) < kDifferent;
          }))
        kept.push_back(std::move(one));
    return kept;
  };
  const PointProblem simple(points, known.focalLength, false);
  std::vector<FoundByPoints> first, last;
  for (const dmat3& rotation : spreadRotations(kStarts))
    if (const auto start = simple.viewWith(rotation))
      first.push_back(minimise(simple, *start, kFirstSteps));
  const PointProblem whole(points, known.focalLength, known.findsDistortion);
  Eigen::VectorXd residual;
  for (const FoundByPoints& start : distinct(std::move(first))) {
    last.push_back(minimise(whole, start.state, kMostSteps));
    if (last.back().state.nearness > 0) continue;
    const PointView other = reversed(last.back().state, normal);
    if (whole.residuals(other, residual, nullptr))
      last.push_back(minimise(whole, other, kMostSteps));
  }
  std::vector<FoundByPoints> found = distinct(std::move(last));
  const FoundByPoints best = found.empty() ? FoundByPoints{} : found.front();
  std::stable_partition(found.begin(), found.end(), [&](const FoundByPoints& one) {
    return one.state.nearness > 0 && isAsGood(one, best, points.size());
  });
  return found;
}

SolvedCamera cameraOf(const PointView& view, const PointProblem& problem, const dvec3& middle,
                      const CameraKnowledge& known) {
  SolvedCamera camera;
  const double zoom = problem.zoomOf(view);
  camera.size = known.size;
  camera.principalPoint = known.principalPoint;
  camera.axes = glm::transpose(view.rotation);
  camera.distance = 1 / view.nearness;
  camera.focalLength = zoom / view.nearness;
  camera.position = middle - camera.axes * dvec3(view.centre / zoom, -camera.distance);
  camera.distortion.k1 = view.bend * camera.focalLength * camera.focalLength;
  return camera;
}

// How position (0 to 2), focal length (3) and k1 (4) change with the unknowns. With t the middle of
// all points as seen from the camera, position = middle - rotation^T t.
Eigen::MatrixXd cameraSlopes(const PointView& view, const PointProblem& problem,
                             const CameraKnowledge& known) {
  const double n = view.nearness, zoom = problem.zoomOf(view), f = zoom / n;
  const dvec3 t(view.centre / zoom, -1 / n);
  const dmat3 toScene = glm::transpose(view.rotation);
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(5, problem.unknowns());
  const auto setPosition = [&](int unknown, const dvec3& slope) {
    for (int i = 0; i < 3; ++i) slopes(i, unknown) = slope[i];
  };
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 turn(0);
    turn[axis] = 1;
    setPosition(axis, toScene * glm::cross(turn, t));
  }
  setPosition(3, toScene * dvec3(-1 / zoom, 0, 0));
  setPosition(4, toScene * dvec3(0, -1 / zoom, 0));
  const dvec3 byZoom = toScene * dvec3(view.centre / (zoom * zoom), 0);
  const dvec3 byNearness = toScene * dvec3(0, 0, -1 / (n * n));
  if (known.focalLength) {
    setPosition(5, byNearness + f * byZoom);
  } else {
    setPosition(5, byNearness);
    setPosition(problem.zoomAt(), byZoom);
    slopes(3, 5) = -f / n;
    slopes(3, problem.zoomAt()) = 1 / n;
  }
  if (known.findsDistortion) {
    slopes.row(4) = 2 * view.bend * f * slopes.row(3);
    slopes(4, problem.bendAt()) = f * f;
  }
  return slopes;
}

CameraErrors errorsOf(const FoundByPoints& found, const PointProblem& problem,
                      const CameraKnowledge& known, const SolvedCamera& camera, size_t count,
                      const std::string& file) {
  constexpr double kLeastPivot = 1e-13;
  // Scaled to a unit diagonal, so that the eigenvalues tell whether an unknown depends on others.
  const Eigen::VectorXd scale = found.normal.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * found.normal * scale.asDiagonal();
  const SymmetricEigen eigen = eigenOfSymmetric(
      scale.allFinite() ? scaled : Eigen::MatrixXd::Zero(scale.size(), scale.size()));
  if (!(eigen.values.minCoeff() > kLeastPivot))
    throwInput("{}: the points leave the camera open{}", file,
               known.focalLength ? "; it takes more of them, not all on one plane"
                                 : "; give the field of view, or points at different distances");
  const int freedom = int(2 * count) - problem.unknowns();
  const Eigen::MatrixXd inverse = scale.asDiagonal() * eigen.vectors *
                                  eigen.values.cwiseInverse().asDiagonal() *
                                  eigen.vectors.transpose() * scale.asDiagonal();
  const Eigen::MatrixXd covariance = found.squares / freedom * inverse;
  const Eigen::MatrixXd slopes = cameraSlopes(found.state, problem, known);
  const Eigen::VectorXd sigma =
      (slopes * covariance * slopes.transpose()).diagonal().cwiseMax(0).cwiseSqrt();
  CameraErrors errors;
  errors.position = dvec3(sigma[0], sigma[1], sigma[2]);
  for (int axis = 0; axis < 3; ++axis) errors.rotation[axis] = std::sqrt(covariance(axis, axis));
  // fov = 2 atan(h / 2f)
  const double f = camera.focalLength, half = 0.5 * camera.size.height;
  if (!known.focalLength) errors.fov = sigma[3] * 2 * half / (f * f + half * half);
  if (known.findsDistortion) errors.k1 = sigma[4];
  return errors;
}

// The distance in pixels, to first order, of the points from where a camera without perspective
// sees them. For a plane that faces the camera it is 0 at any distance.
double perspectiveOf(const FoundByPoints& found) {
  return found.state.nearness * std::sqrt(found.normal(5, 5));
}

}  // namespace

size_t fewestPoints(const CameraKnowledge& known) { return known.focalLength ? 4 : 6; }

CameraFit solveByPoints(const std::vector<ObservedPoint>& observed, const CameraKnowledge& known,
                        const std::string& file) {
  constexpr double kLeastPerspective = 1e-4;  // pixels
  checkCount(observed.size(), known, file);
  dvec3 middle(0);
  for (const ObservedPoint& p : observed) middle += p.position / double(observed.size());
  const dvec2 axis = known.principalPoint * dvec2(known.size.width, known.size.height);
  std::vector<CentredPoint> points;
  for (const ObservedPoint& p : observed)
    points.push_back({p.position - middle, {p.pixel.x - axis.x, axis.y - p.pixel.y}});

  const Extents extents(points);
  checkSpread(observed, extents, file);

  const std::vector<FoundByPoints> found = search(points, extents.normal, known);
  if (found.empty())
    throwInput("{}: no camera sees all points in front of it; check their positions", file);
  const FoundByPoints& best = found.front();
  if (!(best.state.nearness > 0) || !(perspectiveOf(best) > kLeastPerspective))
    throwInput(
        "{}: the points show no perspective, which leaves the field of view open; give it, "
        "or points at different distances",
        file);
  const PointProblem problem(points, known.focalLength, known.findsDistortion);
  CameraFit fit;
  fit.camera = cameraOf(best.state, problem, middle, known);
  fit.errors = errorsOf(best, problem, known, fit.camera, points.size(), file);
  if (!fillsImage(fit.camera.camera(), double(known.size.width) / known.size.height))
    throwInput(
        "{}: the distortion found, k1 = {:.3g}, folds the image inside the frame; it takes "
        "points near the corners, or none to be found",
        file, fit.camera.distortion.k1);
  Eigen::VectorXd residual;
  problem.residuals(best.state, residual, nullptr);
  for (size_t i = 0; i < points.size(); ++i)
    fit.distances.push_back(residual.segment<2>(Eigen::Index(2 * i)).norm());
  const auto rival = std::find_if(found.begin() + 1, found.end(),
                                  [](const FoundByPoints& f) { return f.state.nearness > 0; });
  if (rival != found.end()) fit.rivalRms = std::sqrt(rival->squares / double(points.size()));
  return fit;
}

}  // namespace chromeball
