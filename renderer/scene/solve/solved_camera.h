// SPDX-License-Identifier: Apache-2.0
// The camera of a photograph.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/message.h"
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

}  // namespace chromeball
