// SPDX-License-Identifier: Apache-2.0
#include "bake/shown_color.h"

namespace chromeball {

vec4 shownColor(const PointLight& light, const BakePoint& point, const Rgb& baked) {
  const Scene& scene = light.scene();
  const Instance& instance = scene.instances[size_t(point.instance)];
  const float alpha = surfaceAlpha(scene, instance, point.triangle, point.barycentric);
  if (light.what() != BakedLight::Irradiance) return vec4(baked, alpha);
  const vec3 normal = light.surfaceAt(point).geometricNormal;
  const Surface surface = surfaceAt(scene, instance, point.triangle, point.barycentric, normal,
                                    point.extent * point.extent);
  const Rgb emitted = surface.material->emits()
                          ? emittedRadiance(scene, instance, surface, surface.normal)
                          : Rgb(0);
  if (surface.material->unlit) return vec4(emitted, alpha);
  return vec4(materialAt(scene, surface).baseColor * baked * kInvPi + emitted, alpha);
}

bool countsForScale(const Scene& scene, int instance) {
  return !scene.materials[size_t(scene.instances[size_t(instance)].material)].emits();
}

float scaleOf(float maximum) {
  float scale = 1;
  while (scale < maximum && scale < 1e30f) scale *= 2;
  return scale;
}

}  // namespace chromeball
