// SPDX-License-Identifier: Apache-2.0
#include "approximate/probe_spheres.h"

#include "base/parallel.h"
#include "probe/convert.h"
#include "probe/edit.h"
#include "probe/irradiance.h"
#include "shading/metallic_roughness.h"

namespace chromeball {
namespace {

struct SpherePixel {
  int x, y;
  vec3 normal;
};

std::vector<SpherePixel> spherePixels(int diameter) {
  std::vector<SpherePixel> pixels;
  for (int y = 0; y < diameter; ++y)
    for (int x = 0; x < diameter; ++x) {
      if (!isOnSphere(x, y, diameter)) continue;
      const dvec2 p = (dvec2(x, y) + 0.5) * (2.0 / diameter) - 1.0;
      pixels.push_back({x, y, vec3(p.x, -p.y, std::sqrt(1 - glm::dot(p, p)))});
    }
  return pixels;
}

Image diffuseSphere(const Image& latLong, int diameter) {
  const std::vector<SpherePixel> pixels = spherePixels(diameter);
  std::vector<vec3> normals;
  for (const SpherePixel& pixel : pixels) normals.push_back(pixel.normal);
  const std::vector<dvec3> irradiance = exactIrradiance(latLong, normals);
  Image image(diameter, diameter, 3);
  for (size_t i = 0; i < pixels.size(); ++i)
    image.setRgb(pixels[i].x, pixels[i].y, Rgb(double(kSphereReflectance) / kPiD * irradiance[i]));
  return image;
}

constexpr ImageSize kCoarse{256, 128};

// Radiance x solid angle of the texels of a coarse map, row by row.
std::vector<Rgb> texelPowers(const Image& latLong) {
  const Image coarse = convert(latLong, Mapping::LatLong, Mapping::LatLong, kCoarse);
  std::vector<Rgb> powers;
  forTexels(coarse, [&](int, int, const Rgb& radiance, double solidAngle) {
    powers.push_back(float(solidAngle) * radiance);
  });
  return powers;
}

// All at once, since most of the time goes into the BSDF.
SphereImages silverSpheres(std::span<const Image> probes, int diameter) {
  const MaterialPoint silver{Rgb(kSphereReflectance), 1, kSilverRoughness, Rgb(0), 0};
  const Material metal;
  const BsdfTables tables(std::span(&metal, 1));
  std::vector<std::vector<Rgb>> powers;
  for (const Image& probe : probes) powers.push_back(texelPowers(probe));
  std::vector<vec3> directions;
  for (int y = 0; y < kCoarse.height; ++y)
    for (int x = 0; x < kCoarse.width; ++x) directions.emplace_back(texelDirection(kCoarse, x, y));

  const std::vector<SpherePixel> pixels = spherePixels(diameter);
  SphereImages images(probes.size(), Image(diameter, diameter, 3));
  parallelFor(0, int(pixels.size()), [&](int i) {
    const SpherePixel& pixel = pixels[size_t(i)];
    Surface surface{};
    surface.normal = surface.geometricNormal = pixel.normal;
    const MetallicRoughness bsdf(silver, surface, vec3(0, 0, 1), tables);
    std::vector<dvec3> sums(probes.size(), dvec3(0));
    for (size_t texel = 0; texel < directions.size(); ++texel) {
      if (glm::dot(pixel.normal, directions[texel]) <= 0) continue;
      const Rgb fCos = bsdf.evaluate(directions[texel]).fCos;
      for (size_t k = 0; k < sums.size(); ++k) sums[k] += dvec3(fCos * powers[k][texel]);
    }
    for (size_t k = 0; k < sums.size(); ++k) images[k].setRgb(pixel.x, pixel.y, Rgb(sums[k]));
  });
  return images;
}

// A ball reflects, at the place where the mapping shows (x, y, z), the direction (x, y, -z): the
// map mirrored left and right, and turned half around.
Image mirrorSphere(Image latLong, int diameter) {
  mirrorLeftAndRight(latLong);
  Image image =
      convert(latLong, Mapping::LatLong, Mapping::MirrorBall, {diameter, diameter}, Rotation(180));
  for (int y = 0; y < diameter; ++y)
    for (int x = 0; x < diameter; ++x)
      image.setRgb(x, y,
                   isOnSphere(x, y, diameter) ? kSphereReflectance * image.rgb(x, y) : Rgb(0));
  return image;
}

}  // namespace

bool isOnSphere(int x, int y, int diameter) {
  const dvec2 fromCentre = (dvec2(x, y) + 0.5) * (2.0 / diameter) - 1.0;
  return glm::dot(fromCentre, fromCentre) < 1;
}

std::array<SphereImages, 3> probeSpheres(std::span<const Image> probes, int diameter) {
  SphereImages diffuse, mirror;
  for (const Image& probe : probes) {
    diffuse.push_back(diffuseSphere(probe, diameter));
    mirror.push_back(mirrorSphere(probe, diameter));
  }
  return {std::move(diffuse), silverSpheres(probes, diameter), std::move(mirror)};
}

}  // namespace chromeball
