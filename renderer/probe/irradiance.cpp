// SPDX-License-Identifier: Apache-2.0
#include "probe/irradiance.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "probe/solid_angle.h"
#include "probe/spherical_harmonics.h"

namespace chromeball {
namespace {

// Eight normals in one register. This vector extension of GCC and Clang vectorises the sum below
// without permission to reorder floating-point operations.
constexpr int kLanes = 8;
typedef float Lanes __attribute__((vector_size(kLanes * sizeof(float))));

// One texel as a light.
struct TexelLight {
  float x, y, z;  // mean direction over the texel: its length is just below 1
  float r, g, b;  // radiance x solid angle
};

// The texels of rows [firstRow, endRow) that are not black. The mean direction follows from, over a
// texel from theta0 to theta1 and of width d about the azimuth phi:
//   integral of sin^2(theta) = (theta1 - theta0 - sin(theta1 - theta0) cos(theta1 + theta0)) / 2
//   integral of (-sin, cos)  = 2 sin(d / 2) (-sin(phi), cos(phi))
std::vector<TexelLight> texelLights(const Image& latLong, int firstRow, int endRow) {
  const int w = latLong.width, h = latLong.height;
  const double dTheta = kPiD / h, dPhi = 2 * kPiD / w;
  std::vector<dvec2> azimuths(w);  // x, z
  for (int x = 0; x < w; ++x) {
    const double phi = (x + 0.5) * dPhi;
    azimuths[x] = {-std::sin(phi), std::cos(phi)};
  }
  std::vector<TexelLight> lights;
  for (int y = firstRow; y < endRow; ++y) {
    const double solidAngle = texelSolidAngle(y, w, h), theta = (y + 0.5) * dTheta;
    const double horizontal =
        std::sin(dPhi / 2) * (dTheta - std::sin(dTheta) * std::cos(2 * theta)) / solidAngle;
    const double vertical = std::cos(theta) * std::cos(dTheta / 2);
    for (int x = 0; x < w; ++x) {
      const Rgb radiance = latLong.rgb(x, y);
      if (isBlack(radiance)) continue;
      const dvec2 xz = horizontal * azimuths[x];
      const dvec3 flux = solidAngle * dvec3(radiance);
      lights.push_back(
          {float(xz.x), float(vertical), float(xz.y), float(flux.x), float(flux.y), float(flux.z)});
    }
  }
  return lights;
}

// Normals as a structure of arrays; unused lanes of the last group are zero.
struct NormalGroup {
  Lanes x[2]{}, y[2]{}, z[2]{};
  static constexpr int kSize = 2 * kLanes;
};

struct IrradianceGroup {
  double r[NormalGroup::kSize]{}, g[NormalGroup::kSize]{}, b[NormalGroup::kSize]{};
};

Lanes positivePart(Lanes a) { return a > 0 ? a : Lanes{}; }

void addTo(double* sums, const Lanes (&addends)[2]) {
  for (int i = 0; i < NormalGroup::kSize; ++i) sums[i] += addends[i / kLanes][i % kLanes];
}

// Number of terms summed in float before adding to a double: the rounding error stays near that of
// one product.
constexpr size_t kFloatSum = 256;

void addIrradiance(const NormalGroup& normals, std::span<const TexelLight> lights,
                   IrradianceGroup& irradiance) {
  for (size_t begin = 0; begin < lights.size(); begin += kFloatSum) {
    Lanes r[2]{}, g[2]{}, b[2]{};
    for (const TexelLight& t : lights.subspan(begin, std::min(kFloatSum, lights.size() - begin)))
      for (int i = 0; i < 2; ++i) {
        const Lanes cosine =
            positivePart(normals.x[i] * t.x + normals.y[i] * t.y + normals.z[i] * t.z);
        r[i] += cosine * t.r;
        g[i] += cosine * t.g;
        b[i] += cosine * t.b;
      }
    addTo(irradiance.r, r);
    addTo(irradiance.g, g);
    addTo(irradiance.b, b);
  }
}

// Blocked: sums of a group of normals stay in registers, a block of lights (24 KiB) stays in the
// first-level cache.
void addIrradiance(std::span<const vec3> normals, std::span<const TexelLight> lights,
                   std::span<dvec3> irradiance) {
  constexpr size_t kLightsInCache = 4 * kFloatSum, kGroup = NormalGroup::kSize;
  std::vector<NormalGroup> groups((normals.size() + kGroup - 1) / kGroup);
  std::vector<IrradianceGroup> sums(groups.size());
  for (size_t i = 0; i < normals.size(); ++i) {
    NormalGroup& group = groups[i / kGroup];
    const size_t half = i % kGroup / kLanes, lane = i % kLanes;
    group.x[half][lane] = normals[i].x;
    group.y[half][lane] = normals[i].y;
    group.z[half][lane] = normals[i].z;
  }
  for (size_t l = 0; l < lights.size(); l += kLightsInCache) {
    const auto near = lights.subspan(l, std::min(kLightsInCache, lights.size() - l));
    for (size_t g = 0; g < groups.size(); ++g) addIrradiance(groups[g], near, sums[g]);
  }
  for (size_t i = 0; i < normals.size(); ++i) {
    const IrradianceGroup& sum = sums[i / kGroup];
    irradiance[i] += dvec3(sum.r[i % kGroup], sum.g[i % kGroup], sum.b[i % kGroup]);
  }
}

Image toImage(const ImageSize& size, const std::vector<dvec3>& colors) {
  Image image(size.width, size.height, 3);
  for (size_t i = 0; i < colors.size(); ++i)
    for (int c = 0; c < 3; ++c) image.texels[3 * i + c] = float(colors[i][c]);
  return image;
}

}  // namespace

std::vector<dvec3> exactIrradiance(const Image& latLong, std::span<const vec3> normals) {
  constexpr size_t kNormalsOfTask = 16 * NormalGroup::kSize;
  constexpr int kTexelsOfBand = 1 << 20;  // bounds the memory for large maps
  const int bandRows = std::max(1, kTexelsOfBand / latLong.width);
  const size_t tasks = (normals.size() + kNormalsOfTask - 1) / kNormalsOfTask;
  std::vector<dvec3> irradiance(normals.size(), dvec3(0));
  for (int y = 0; y < latLong.height; y += bandRows) {
    const std::vector<TexelLight> lights =
        texelLights(latLong, y, std::min(y + bandRows, latLong.height));
    tbb::parallel_for(size_t(0), tasks, [&](size_t task) {
      const size_t begin = task * kNormalsOfTask;
      const size_t count = std::min(kNormalsOfTask, normals.size() - begin);
      addIrradiance(normals.subspan(begin, count), lights,
                    std::span(irradiance).subspan(begin, count));
    });
  }
  return irradiance;
}

std::vector<dvec3> shIrradiance(const Image& latLong, std::span<const vec3> normals) {
  const ShCoefficients radiance = projectSh(latLong);
  std::vector<dvec3> irradiance;
  irradiance.reserve(normals.size());
  for (const vec3& normal : normals) irradiance.push_back(shIrradiance(radiance, dvec3(normal)));
  return irradiance;
}

std::vector<vec3> texelDirections(const ImageSize& latLong) {
  std::vector<vec3> directions;
  directions.reserve(size_t(latLong.width) * latLong.height);
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x) directions.emplace_back(texelDirection(latLong, x, y));
  return directions;
}

Image irradianceMap(const Image& latLong, const ImageSize& size) {
  return toImage(size, exactIrradiance(latLong, texelDirections(size)));
}

Image shIrradianceMap(const Image& latLong, const ImageSize& size) {
  return toImage(size, shIrradiance(latLong, texelDirections(size)));
}

}  // namespace chromeball
