// SPDX-License-Identifier: Apache-2.0
// The three spheres by which papers compare estimated with true light: grey diffuse, matte silver
// and mirror (LeGendre et al. 2019, "DeepLight"; Wang et al. 2022, "StyleLight").
#pragma once

#include <array>
#include <span>
#include <vector>

#include "image/image.h"

namespace chromeball {

// The reflectance of all spheres, and the perceptual roughness of matte silver: those of
// StyleLight's scenes.
inline constexpr float kSphereReflectance = 0.8f, kSilverRoughness = 0.3271f;

inline constexpr std::array kSphereNames = {"diffuse", "matte silver", "mirror"};

// One sphere under each of the probes: square images of `diameter` pixels, black around it.
using SphereImages = std::vector<Image>;

// Each sphere alone, in the order of kSphereNames, under each of the probes (lat-long maps).
// Parallel projection along -Z, with +Y up. Nothing is random, and all is linear in the probe:
// - diffuse: Lambertian, exactIrradiance() at the centre of each pixel;
// - silver: the sum over the texels of the map at 256 x 128 of radiance x BSDF x cosine x solid
//   angle, with the BSDF of `render` for a metal;
// - mirror: each pixel the mean of the map over the directions that it reflects.
std::array<SphereImages, 3> probeSpheres(std::span<const Image> probes, int diameter);

// Whether the centre of a pixel is on the sphere.
bool isOnSphere(int x, int y, int diameter);

}  // namespace chromeball
