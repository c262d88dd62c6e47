#include "probe/bake.h"

#include <tbb/parallel_for.h>

#include "probe/solid_angle.h"

namespace chromeball {

Image bake(Mapping mapping, const ImageSize& size, int samplesPerSide,
           const std::function<dvec3(const dvec3&)>& radiance) {
  Image out(size.width, size.height, 3);
  const auto meanOverTexel = [&](int x, int y) {
    dvec3 sum(0);
    double sumWeight = 0;
    for (int j = 0; j < samplesPerSide; ++j)
      for (int i = 0; i < samplesPerSide; ++i) {
        const dvec2 uv((x + (i + 0.5) / samplesPerSide) / size.width,
                       (y + (j + 0.5) / samplesPerSide) / size.height);
        const std::optional<dvec3> direction = uvToDirection(mapping, uv);
        if (!direction) continue;
        const double weight = solidAngleDensity(mapping, uv);
        sum += weight * radiance(*direction);
        sumWeight += weight;
      }
    return sumWeight > 0 ? Rgb(sum / sumWeight) : Rgb(0);
  };
  tbb::parallel_for(0, size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) out.setRgb(x, y, meanOverTexel(x, y));
  });
  return out;
}

}  // namespace chromeball
