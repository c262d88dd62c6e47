// SPDX-License-Identifier: Apache-2.0
#include "capture_photographs.h"

#include "base/parallel.h"
#include "math/icosphere.h"
#include "probe/irradiance.h"

namespace chromeball {

CameraAxes::CameraAxes(const CameraPosition& camera) {
  const double a = camera.azimuth * kPiD / 180, e = camera.elevation * kPiD / 180;
  backwards = {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
  right = {std::cos(a), 0, -std::sin(a)};
  up = glm::cross(backwards, right);
}

dvec3 ballRadiance(const BallScene& scene, const dvec2& p) {
  const CameraAxes axes(scene.camera);
  dvec3 origin = p.x * axes.right + p.y * axes.up + 2.0 * axes.backwards, ray = -axes.backwards;
  if (std::isfinite(scene.distance)) {
    const double rim = 1 / std::sqrt(scene.distance * scene.distance - 1);  // tangent of its angle
    origin = scene.distance * axes.backwards;
    ray = glm::normalize(rim * (p.x * axes.right + p.y * axes.up) - axes.backwards);
  }
  const double b = glm::dot(origin, ray), c = glm::dot(origin, origin) - 1;
  const double discriminant = b * b - c;
  if (discriminant < 0) return dvec3(double(scene.background));
  const dvec3 normal = origin + (-b - std::sqrt(discriminant)) * ray;
  const dvec3 reflected = glm::reflect(ray, normal);
  return scene.reflectance.at(-glm::dot(ray, normal)) *
         dvec3(scene.probe.radiance(vec3(glm::normalize(reflected))));
}

Image photographOf(const std::function<dvec3(const dvec2&)>& radiance, int width, int height,
                   const Circle& circle, int samples) {
  Image image(width, height, 3);
  parallelFor(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      dvec3 sum(0);
      for (int j = 0; j < samples; ++j)
        for (int i = 0; i < samples; ++i) {
          const dvec2 p =
              (dvec2(x + (i + 0.5) / samples, y + (j + 0.5) / samples) - circle.centre) /
              circle.radius;
          sum += radiance({p.x, -p.y});
        }
      image.setRgb(x, y, Rgb(sum / double(samples * samples)));
    }
  });
  return image;
}

Image photographOf(const BallScene& scene, int width, int height, const Circle& circle) {
  return photographOf([&](const dvec2& p) { return ballRadiance(scene, p); }, width, height, circle,
                      scene.samples);
}

IrradianceError irradianceError(const Image& map, const Image& truth, int subdivisions) {
  const std::vector<vec3> normals = icosphereNormals(subdivisions);
  const std::vector<dvec3> a = exactIrradiance(map, normals), b = exactIrradiance(truth, normals);
  dvec3 sum(0);
  for (const dvec3& e : b) sum += e;
  const dvec3 mean = sum / double(normals.size());
  IrradianceError error;
  for (size_t i = 0; i < normals.size(); ++i) {
    const dvec3 d = glm::abs(a[i] - b[i]) / mean;
    const double worst = std::max({d.x, d.y, d.z});
    error.mean += worst / double(normals.size());
    error.largest = std::max(error.largest, worst);
  }
  return error;
}

}  // namespace chromeball
