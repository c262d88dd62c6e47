// SPDX-License-Identifier: Apache-2.0
// The built-in strategies, sampled at many points.
#include "lighting/strategy.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <atomic>

#include "arrays.h"
#include "base/error.h"
#include "base/parallel.h"
#include "bindings.h"
#include "probe_map.h"
#include "process.h"

namespace chromeball::python {
namespace {

constexpr size_t kRange = 1024;  // points of a task

using Vectors = std::optional<ArrayIn<float>>;  // [N,3]

vec3 vectorAt(const Vectors& vectors, size_t i, const vec3& otherwise) {
  return vectors ? reinterpret_cast<const vec3*>(vectors->data())[i] : otherwise;
}

class BuiltIn {
 public:
  BuiltIn(const std::string& name, const ProbeMap& map, bool mis)
      : name_(name), probe_(*map.map, map.rotation, Rgb(map.scale)) {
    checkProcess();
    const nb::gil_scoped_release released;
    source_ = makeStrategy(name, probe_, {mis ? Mis::Balance : Mis::Off}, "Strategy()");
  }
  BuiltIn(const BuiltIn&) = delete;

  bool needsNormals() const { return name_ == "uniform" || name_ == "product"; }

  // Directions, radiances and pdfs; `u`: [N,2].
  std::tuple<ArrayOut<float>, ArrayOut<float>, ArrayOut<float>> sample(
      const Vectors& positions, const Vectors& normals, const ArrayIn<double>& u) const {
    checkProcess();
    const size_t count = u.shape(0);
    std::vector<vec3> directions(count, vec3(0, 1, 0)), radiances(count, vec3(0));
    std::vector<float> pdfs(count, 0);
    {
      const nb::gil_scoped_release released;
      const SobolTable table(1, dimension::tabulated(1), 0);
      forMany(count, [&](size_t begin, size_t end) {
        PixelSampler sampler(table, 0);
        PixelNumbers numbers;
        sampler.set(numbers, 0, 0, 0);
        std::vector<DirectionSample> found;
        for (size_t i = begin; i < end; ++i) {
          // The shifts turn the only point of the table into u.
          for (int k = 0; k < 2; ++k) {
            const size_t d = dimension::kVertex + dimension::kLight + k;
            numbers.shifts[d] = table.point(0)[d] ^ uint32_t(u.data()[2 * i + k] * 0x1p32);
          }
          sampler.startSample(numbers, 0);
          sampler.startVertex(0);
          found.clear();
          source_->sample(pointAt(positions, normals, i), sampler, found);
          checkSamples(found);
          if (found.empty()) continue;
          directions[i] = found[0].wi;
          radiances[i] = found[0].irradiance * found[0].pdf;
          pdfs[i] = found[0].pdf;
        }
      });
    }
    return {arrayOf<float>(std::move(directions)), arrayOf<float>(std::move(radiances)),
            listOf(std::move(pdfs))};
  }

  ArrayOut<float> pdf(const ArrayIn<float>& directions, const Vectors& positions,
                      const Vectors& normals) const {
    checkProcess();
    std::vector<float> pdfs(directions.shape(0));
    {
      const nb::gil_scoped_release released;
      const auto* wi = reinterpret_cast<const vec3*>(directions.data());
      forMany(pdfs.size(), [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
          pdfs[i] = source_->escaped(pointAt(positions, normals, i), wi[i]).pdf;
      });
    }
    return listOf(std::move(pdfs));
  }

 private:
  template <class Body>
  static void forMany(size_t count, const Body& body) {
    if (count <= kRange) return body(size_t(0), count);
    parallelRanges(count, kRange, body);
  }
  static LightPoint pointAt(const Vectors& positions, const Vectors& normals, size_t i) {
    return {vectorAt(positions, i, vec3(0)), vectorAt(normals, i, vec3(0, 1, 0)), nullptr, 0};
  }
  void checkSamples(const std::vector<DirectionSample>& found) const {
    if (found.size() > 1)
      throwInput(
          "sample(): `{}` takes {} samples of a point; only strategies that take one are "
          "functions of u",
          name_, found.size());
    if (!found.empty() && found[0].isDelta)
      throwInput(
          "sample(): `{}` replaces the probe by lights, which have no pdf; Probe.lights() "
          "returns them",
          name_);
  }

  std::string name_;
  Probe probe_;
  std::unique_ptr<LightSource> source_;
};

}  // namespace

void bindStrategy(nb::module_& m) {
  nb::class_<BuiltIn>(m, "BuiltIn", "A strategy of the library.")
      .def(nb::init<const std::string&, const ProbeMap&, bool>(), nb::arg("name"), nb::arg("probe"),
           nb::arg("mis"))
      .def_prop_ro("needs_normals", &BuiltIn::needsNormals)
      .def("sample", &BuiltIn::sample, nb::arg("positions").none(), nb::arg("normals").none(),
           nb::arg("u"))
      .def("pdf", &BuiltIn::pdf, nb::arg("directions"), nb::arg("positions").none(),
           nb::arg("normals").none());
}

}  // namespace chromeball::python
