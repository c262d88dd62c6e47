// SPDX-License-Identifier: Apache-2.0
// The BSDF of a material, on a plane whose front has the normal +z and the tangent +x.
#include <nanobind/stl/tuple.h>

#include "arrays.h"
#include "base/error.h"
#include "base/parallel.h"
#include "bindings.h"
#include "material.h"
#include "process.h"
#include "scene/extended_surface.h"
#include "shading/bsdf.h"
#include "transport/media.h"
#include "values.h"

namespace chromeball::python {
namespace {

constexpr size_t kRange = 1024;  // directions of a task

class MaterialBsdf {
 public:
  explicit MaterialBsdf(const Dict& keywords) : scene_(sceneOf(keywords)) {
    checkProcess();
    const nb::gil_scoped_release released;
    tables_.emplace(scene_.materials);
  }

  // f |cos| and pdf.
  std::tuple<ArrayOut<float>, ArrayOut<float>> evaluate(const ArrayIn<float>& wi,
                                                        const ArrayIn<float>& wo) const {
    std::vector<vec3> in = vectorsOf<vec3>(wi), out = vectorsOf<vec3>(wo);
    std::vector<float> pdfs(in.size());
    forMany(in.size(), [&](size_t i) {
      const BsdfValue value = bsdfFor(out[i]).evaluate(in[i]);
      in[i] = value.fCos, pdfs[i] = value.pdf;
    });
    return {arrayOf<float>(std::move(in)), listOf(std::move(pdfs))};
  }

  // Directions, weights and pdfs; `u`: [N,3], the last one chooses the lobe.
  std::tuple<ArrayOut<float>, ArrayOut<float>, ArrayOut<float>> sample(
      const ArrayIn<float>& wo, const ArrayIn<float>& u) const {
    std::vector<vec3> out = vectorsOf<vec3>(wo), numbers = vectorsOf<vec3>(u);
    std::vector<float> pdfs(out.size());
    forMany(out.size(), [&](size_t i) {
      BsdfSample found;
      if (!bsdfFor(out[i]).sample(vec2(numbers[i]), numbers[i].z, found))
        found.wi = vec3(0, 0, 1), found.weight = Rgb(0), found.pdf = 0;
      out[i] = found.wi, numbers[i] = found.weight, pdfs[i] = found.pdf;
    });
    return {arrayOf<float>(std::move(out)), arrayOf<float>(std::move(numbers)),
            listOf(std::move(pdfs))};
  }

 private:
  static Scene sceneOf(const Dict& keywords) {
    Scene scene;
    SceneBuilder builder(scene);
    const int material = builder.addMaterial(materialOf(keywords, builder));
    if (!scene.textures.empty())
      throwInput("Material(): the BSDF of a textured material differs from point to point");
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.uvs.push_back({{0, 0}, {1, 0}, {0, 1}});
    mesh.triangles = {{0, 1, 2}};
    builder.addInstance(builder.addMesh(std::move(mesh), material), material,
                        builder.addNode("plane"));
    return scene;
  }
  Bsdf bsdfFor(const vec3& wo) const {
    const Instance& instance = scene_.instances[0];
    const Surface surface = surfaceAt(scene_, instance, 0, vec2(1.0f / 3), wo);
    const MaterialPoint material = materialAt(scene_, surface);
    if (!surface.material->extended) return {material, surface, wo, *tables_};
    return {material,
            extendedMaterialAt(scene_, instance, surface),
            Media().refractiveIndex(surface, Rgb(1)),
            surface,
            wo,
            *tables_};
  }
  template <class Body>
  static void forMany(size_t count, const Body& body) {
    checkProcess();
    const nb::gil_scoped_release released;
    const auto part = [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) body(i);
    };
    if (count <= kRange) return part(0, count);
    parallelRanges(count, kRange, part);
  }

  Scene scene_;
  std::optional<BsdfTables> tables_;
};

}  // namespace

void bindMaterialBsdf(nb::module_& m) {
  nb::class_<MaterialBsdf>(m, "MaterialBsdf", "The BSDF of a material on a plane.")
      .def(nb::init<const Dict&>(), nb::arg("keywords"))
      .def("evaluate", &MaterialBsdf::evaluate, nb::arg("wi"), nb::arg("wo"))
      .def("sample", &MaterialBsdf::sample, nb::arg("wo"), nb::arg("u"));
}

}  // namespace chromeball::python
