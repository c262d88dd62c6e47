// SPDX-License-Identifier: Apache-2.0
// Photographs of one place, taken from several sides, matched in exposure and orientation.
#pragma once

#include <memory>
#include <vector>

#include "probe/capture/optics.h"
#include "probe/capture/photograph.h"

namespace chromeball {

// One photograph of several that show the world around a point.

class CaptureView {
 public:
  // Keeps references to `image` and `mask` (empty for none).
  CaptureView(const Image& image, const Image& mask, const Circle& circle,
              std::shared_ptr<const CaptureOptics> optics, const CameraPosition& camera);

  struct Sample {
    dvec3 radiance;
    double weight;  // 0: the photograph does not show the direction
  };
  // The sample in a unit direction in the world.
  Sample sample(const dvec3& direction) const;

  void setCamera(const CameraPosition& camera);
  const CameraPosition& camera() const { return camera_; }
  // A factor on all radiance.
  void setGain(double gain) { gain_ = gain; }

  // The number of pixels that the whole sphere would have.
  double pixelsOfSphere() const;

 private:
  PhotographDisc disc_;
  double radius_;  // of the circle, in pixels
  std::shared_ptr<const CaptureOptics> optics_;
  CameraPosition camera_;
  glm::dmat3 toCamera_;
  double gain_ = 1;
};

// The weighted mean over the views that show a direction.
CaptureView::Sample merged(const std::vector<CaptureView>& views, const dvec3& direction);

// The match of a view with all views before it. The first view is the standard.
struct ViewMatch {
  double overlap = 0;                    // the share of the sphere that both show well
  double correlation = 0;                // of the logarithms of luminance there, at `turn`
  double turn = 0;                       // degrees, added to the azimuth of the camera
  double gain = 1;                       // multiplies the radiance
  bool turned = false, exposed = false;  // whether turn and gain were found; else they are 0 and 1
};

// The largest turn that is looked for, in degrees to both sides.
inline constexpr double kLargestTurn = 5;

// Matches each view to those before it and changes its camera and gain accordingly. The turn is the
// maximum of the correlation of the logarithms of luminance, where both views show a direction
// well, between steps of half a degree by a parabola; none is found if the views overlap in less
// than 2% of the sphere, if the correlation stays below 0.5, or is largest at the limit. The gain
// is the median ratio of luminance over cells of 4 degrees, weighted by solid angle.
std::vector<ViewMatch> matchViews(std::vector<CaptureView>& views, bool exposure, bool rotation);

}  // namespace chromeball
