// SPDX-License-Identifier: Apache-2.0
// Named surfaces with simple materials, as a .glb.
#pragma once

#include "glb_writer.h"
#include "image/image.h"
#include "scene/camera.h"
#include "shapes.h"

namespace chromeball::demo {

struct Object {
  std::string name;
  Surface surface;
  Rgb color;
  float metallic = 0, roughness = 1;
  float glow = 0;           // strength of its emission
  int texture = -1;         // of the base colour, as addTexture() returned it
  bool lambertian = false;  // purely diffuse
  bool glass = false;       // smooth glass
};

// Each appends to the file; the texture's index is returned.
void addObject(GlbWriter& glb, const Object& object);
int addTexture(GlbWriter& glb, const Image& color);
void addCamera(GlbWriter& glb, const Camera& camera);  // by its name

// Makes a scene of all nodes, and writes the file. Throws RunError.
void writeScene(GlbWriter& glb, const std::string& path);

}  // namespace chromeball::demo
