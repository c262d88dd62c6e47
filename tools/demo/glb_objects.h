// SPDX-License-Identifier: Apache-2.0
// Named surfaces with simple materials, in a glTF document.
#pragma once

#include <filesystem>
#include <string>

#include "bake/gltf_document.h"
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
  bool glass = false;       // smooth glass of the colour that 0.2 m of it transmit
  float anisotropy = 0;     // of a metal whose scratches run along the texture's u
  float clearcoat = 0;      // a layer of smooth lacquer
};

// Where a mesh stands: scaled, turned about the vertical (radians), then moved.
struct Placement {
  vec3 position{0, 0, 0};
  float turn = 0;
  vec3 scale{1, 1, 1};
};

// Each appends to the document. A mesh may have many nodes.
int addMesh(GltfDocument& document, const Object& object);
void addNode(GltfDocument& document, const std::string& name, int mesh, const Placement& at);
void addObject(GltfDocument& document, const Object& object);  // a mesh and its node
int addTexture(GltfDocument& document, const Image& color);    // returns its index

// Adds the camera, makes a scene of all nodes, and writes the file. Throws RunError.
void writeScene(GltfDocument& document, const char* cameraName, const Camera& camera,
                const std::filesystem::path& path);

}  // namespace chromeball::demo
