// SPDX-License-Identifier: Apache-2.0
#include "geometry.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.h"
#include "material.h"

namespace chromeball::python {
namespace {

glm::dmat4 transformOf(const ArrayIn<double>& matrix) {
  glm::dmat4 transform;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      transform[column][row] = matrix.data()[4 * row + column];
  return transform;
}

}  // namespace

SceneBuilder& Geometry::builder() {
  if (!scene_ || scene_.use_count() > 1) {
    scene_ = scene_ ? std::make_shared<Scene>(*scene_) : std::make_shared<Scene>();
    builder_.emplace(*scene_);
  }
  return *builder_;
}

int Geometry::addMaterial(const Dict& keywords) {
  Scene attempt;  // so that an error leaves no textures behind
  SceneBuilder trial(attempt);
  trial.addMaterial(materialOf(keywords, trial));
  SceneBuilder& b = builder();
  return b.addMaterial(materialOf(keywords, b));
}

int Geometry::addMesh(const ArrayIn<float>& positions,
                      const std::optional<ArrayIn<uint32_t>>& triangles,
                      const std::optional<ArrayIn<float>>& normals,
                      const std::optional<ArrayIn<float>>& uvs,
                      const std::optional<ArrayIn<float>>& colors, int material) {
  Mesh mesh;
  mesh.positions = vectorsOf<vec3>(positions);
  if (triangles) mesh.triangles = vectorsOf<Triangle>(*triangles);
  if (normals) mesh.normals = vectorsOf<vec3>(*normals);
  if (uvs) mesh.uvs.push_back(vectorsOf<vec2>(*uvs));
  if (colors) mesh.colors = vectorsOf<vec4>(*colors);
  return builder().addMesh(std::move(mesh), material);
}

void Geometry::addInstance(int mesh, int material, const std::optional<ArrayIn<double>>& toWorld,
                           const std::string& name) {
  SceneBuilder& b = builder();
  const int node = b.addNode(name);
  toWorld ? b.addInstance(mesh, material, node, transformOf(*toWorld))
          : b.addInstance(mesh, material, node);
}

void bindGeometry(nb::module_& m) {
  m.def("material_keywords", materialKeywords, "The keywords of chromeball.Material.");
  nb::class_<Geometry>(m, "Geometry", "The part of a scene that was made of arrays.")
      .def(nb::init<>())
      .def("add_material", &Geometry::addMaterial, nb::arg("keywords"))
      .def("add_mesh", &Geometry::addMesh, nb::arg("positions").noconvert(),
           nb::arg("triangles").none(), nb::arg("normals").none(), nb::arg("uvs").none(),
           nb::arg("colors").none(), nb::arg("material"))
      .def("add_instance", &Geometry::addInstance, nb::arg("mesh"), nb::arg("material"),
           nb::arg("to_world").none(), nb::arg("name"));
}

}  // namespace chromeball::python
