// SPDX-License-Identifier: Apache-2.0
// The camera of a photograph by points of known positions, or by lines along the axes of the scene.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/message.h"
#include "math/vec.h"
#include "probe/mapping.h"
#include "scene/bounds.h"
#include "scene/camera.h"
#include "scene/solve/observations.h"

namespace chromeball {

// The same as `Camera`, in double precision and for a photograph of a certain size.
struct SolvedCamera {
  ImageSize size{};                // of the photograph, in pixels
  glm::dvec3 position{0};          // metres
  glm::dmat3 axes{1};              // columns: right, up and back, orthonormal
  double focalLength = 1;          // in pixels
  glm::dvec2 principalPoint{0.5};  // as Camera::principalPoint
  Distortion distortion;
  double distance = 1;  // metres along the axis to what was observed

  double fov() const;  // vertical, radians: Camera::fov
  Camera camera() const;
  // The unit direction in which the pixel at this position (observations.h) looks.
  glm::dvec3 directionAt(const glm::dvec2& pixel) const;
};

// Errors of one standard deviation; nullopt if the value was given and not found.
struct CameraErrors {
  std::optional<glm::dvec3> position;  // metres
  glm::dvec3 rotation{0};              // radians about the camera's right, up and back axes
  std::optional<double> fov, k1;       // fov: vertical, radians
};

struct CameraFit {
  SolvedCamera camera;
  CameraErrors errors;
  // In pixels: for each point, its distance from where the camera sees it; for each line, the
  // distance of its ends from a line through its middle with the right vanishing point.
  std::vector<double> distances;
  // The root mean square distance of the best camera that differs from this one, if there is one:
  // four points on a plane may allow two.
  std::optional<double> rivalRms;

  double rms() const;
  size_t worst() const;  // the index of the largest distance
};

// The focal length in pixels for a vertical field of view in radians, and for the focal length in
// millimetres that has the same diagonal field of view on 35 mm film (36 x 24 mm; CIPA DCG-001).
double focalLengthOfFov(const ImageSize& size, double fov);
double focalLengthOf35mm(const ImageSize& size, double millimetres);
double equivalentOn35mm(const ImageSize& size, double focalLength);  // its inverse

// Warnings about observations that no camera fits, that two cameras fit, or that leave the field of
// view uncertain.
Messages doubtsAbout(const CameraFit& fit);

// Warnings about points outside the picture.
Messages doubtsAbout(const std::vector<ObservedPoint>& points, const ImageSize& size);

// Warnings about a camera that does not see the model.
Messages doubtsAbout(const SolvedCamera& camera, const Bounds& model);

// The camera of a file of fSpy (fspy.io): its menu Export, Camera parameters as JSON.

// The file has, among others, cameraTransform (from the camera, which looks along -Z with +Y up, to
// the scene; rows), verticalFieldOfView (radians), principalPoint (from the middle of the image, in
// units of half its longer side, y up), imageWidth and imageHeight. `zUp`: the scene's z axis is
// up, as in Blender, and becomes Y: (x, y, z) is (x, z, -y) here. Throws InputError.
SolvedCamera readFspy(const std::filesystem::path& path, bool zUp);

// Ways to find it.

struct CameraKnowledge {
  ImageSize size{};                        // of the photograph
  glm::dvec2 principalPoint{0.5};          // as Camera::principalPoint
  std::optional<double> focalLength = {};  // in pixels; nullopt: to be found
  bool findsDistortion = false;            // k1
};

// The fewest points: 4 for position and rotation, 6 if the focal length is to be found too.
size_t fewestPoints(const CameraKnowledge& known);

// The camera with the least sum of squared distances, in pixels, between the points and where it
// sees them (HDRI book, 9.7). The starting points are spread over all rotations, so that no guess
// is needed and that a second solution is found (CameraFit::rivalRms): for each, the other unknowns
// solve a linear problem; the Levenberg-Marquardt method refines the best. The errors follow from
// the covariance s^2 (J^T J)^-1, with s^2 the squares' sum over the degrees of freedom. Throws
// InputError, begun by `file` or by the location of a point, if the points are too few, coincide or
// lie on a line, if no camera sees all of them in front of it, if they do not determine the camera,
// and if the distortion found folds the image.
CameraFit solveByPoints(const std::vector<ObservedPoint>& points, const CameraKnowledge& known,
                        const std::string& file);

// The data that place the camera, once its rotation is known. The ground is the plane y = 0.
struct LinePlacement {
  std::optional<double> height = {};      // of the camera above the ground, metres, > 0
  std::optional<glm::dvec2> origin = {};  // the pixel that shows (0, 0, 0)
};

// Rotation and focal length from at least two axes with two lines each: lines along an axis meet at
// its vanishing point (HDRI book, 9.7). Minimises the squared distances of the lines' ends from
// lines through their middles to the vanishing points, which the three axes share at right angles.
// The order of the ends tells the direction of an axis.
//
// Position: the scale comes from the height, or from the lines of known length, whose first ends
// must be on the ground. The origin is the given pixel, else the first end of the first line of
// known length, else below the camera. CameraErrors has no position.
//
// Throws InputError, begun by `file` or by the location of a line, if the lines are too few, do not
// fit any focal length or contradict each other in order, if nothing tells the scale, and if a
// point of the ground is above the horizon.
CameraFit solveByLines(const std::vector<ObservedLine>& lines, const CameraKnowledge& known,
                       const LinePlacement& placement, const std::string& file);

}  // namespace chromeball
