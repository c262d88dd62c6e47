// SPDX-License-Identifier: Apache-2.0
// Helpers that build small scenes and render them without files.
#pragma once

#include "all_tables.h"
#include "math/warp.h"
#include "render/render.h"

namespace chromeball {

Material lambert(Rgb albedo);
int addMaterial(Scene& scene, const Material& material);
void addMesh(Scene& scene, int material, Mesh mesh);

// corner + u a + v b, u and v in [0, 1]; faces along cross(a, b).
void addQuad(Scene& scene, int material, vec3 corner, vec3 a, vec3 b);

// A sphere of 2 n^2 x 2 triangles; faces outwards, or inwards for a negative radius. `smooth`: with
// the sphere's normals.
void addSphere(Scene& scene, int material, vec3 centre, float radius, int n = 32,
               bool smooth = true);

// Looks down at the origin from `height`; -Z is up in the image.
Camera topCamera(float height, float fovDegrees);

RenderResult renderScene(const Scene& scene, const Camera& camera, const Probe& probe,
                         const std::string& strategy, const RenderSettings& settings);

RenderSettings smallRender(int width, int height, uint32_t samples, int maxDepth,
                           uint64_t seed = 0);

Rgb meanColor(const Image& image);

}  // namespace chromeball
