// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/capture_view.h"

namespace chromeball {

CaptureView::CaptureView(const Image& image, const Image& mask, const Circle& circle,
                         std::shared_ptr<const CaptureOptics> optics, const CameraPosition& camera)
    : disc_(image, circle, mask), radius_(circle.radius), optics_(std::move(optics)) {
  setCamera(camera);
}

void CaptureView::setCamera(const CameraPosition& camera) {
  camera_ = camera;
  toCamera_ = glm::transpose(camera.axes());
}

CaptureView::Sample CaptureView::sample(const dvec3& direction) const {
  const std::optional<DiscPoint> point = optics_->locate(toCamera_ * direction);
  if (!point) return {dvec3(0), 0};
  const PhotographDisc::Sample seen = disc_.at(point->position);
  return {gain_ * seen.radiance / point->reflectance, point->weight * seen.coverage};
}

double CaptureView::pixelsOfSphere() const {
  return kPiD * radius_ * radius_ / optics_->shareShown();
}

CaptureView::Sample merged(const std::vector<CaptureView>& views, const dvec3& direction) {
  CaptureView::Sample sum{dvec3(0), 0};
  for (const CaptureView& view : views) {
    const CaptureView::Sample sample = view.sample(direction);
    sum.radiance += sample.weight * sample.radiance;
    sum.weight += sample.weight;
  }
  if (sum.weight > 0) sum.radiance /= sum.weight;
  return sum;
}

}  // namespace chromeball
