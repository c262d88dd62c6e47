// SPDX-License-Identifier: Apache-2.0
// One photograph of several that show the world around a point.
#pragma once

#include <memory>

#include "probe/capture/optics.h"
#include "probe/capture/photograph.h"

namespace chromeball {

class CaptureView {
 public:
  // Keeps references to `image` and `mask` (empty for none).
  CaptureView(const Image& image, const Image& mask, const Circle& circle,
              std::shared_ptr<const CaptureOptics> optics, const CameraPosition& camera);

  struct Sample {
    dvec3 radiance;
    double weight;  // 0: the photograph does not show the direction
  };
  // Of a unit direction in the world.
  Sample sample(const dvec3& direction) const;

  void setCamera(const CameraPosition& camera);
  const CameraPosition& camera() const { return camera_; }
  // A factor on all radiance.
  void setGain(double gain) { gain_ = gain; }

  // As many pixels as the whole sphere would have.
  double pixelsOfSphere() const;

 private:
  PhotographDisc disc_;
  double radius_;  // of the circle, in pixels
  std::shared_ptr<const CaptureOptics> optics_;
  CameraPosition camera_;
  glm::dmat3 toCamera_;
  double gain_ = 1;
};

// The weighted mean of the views that show a direction.
CaptureView::Sample merged(const std::vector<CaptureView>& views, const dvec3& direction);

}  // namespace chromeball
