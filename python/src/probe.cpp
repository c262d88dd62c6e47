// SPDX-License-Identifier: Apache-2.0
// Probes in memory.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "arrays.h"
#include "bindings.h"
#include "front/arguments.h"
#include "image/size_limits.h"
#include "lighting/methods.h"
#include "messages.h"
#include "probe/convert.h"
#include "probe/edit.h"
#include "probe/irradiance.h"
#include "probe/load.h"
#include "probe/sun_extraction.h"
#include "probe_map.h"
#include "process.h"

namespace chromeball::python {
namespace {

ProbeMap probeOf(LoadedProbe loaded, const std::string& name) {
  Messages messages = loaded.messages;
  for (const std::string& line : warnings(loaded, name)) addWarning(messages, "{}", line);
  if (loaded.detected) addNote(messages, "{}", detection(loaded, name));
  const std::string mapping = mappingName(loaded.mapping);
  return {std::make_shared<const Image>(std::move(loaded.latLong)),
          {},
          glm::dvec3(1),
          name,
          mapping,
          std::move(messages)};
}

ProbeMap readProbe(const std::string& path, const std::string& mapping) {
  checkProcess();
  const nb::gil_scoped_release released;
  return probeOf(loadProbe(path, mapping), path);
}

ProbeMap probeOfArray(const ArrayIn<float>& array, const std::string& mapping) {
  checkProcess();
  checkImageSize("the array", int(array.shape(1)), int(array.shape(0)), 3);
  Image image = imageOf(array);
  const nb::gil_scoped_release released;
  return probeOf(loadProbe(std::move(image), mapping, "mapping", "the array"), "the array");
}

ProbeMap rotated(const ProbeMap& probe, const std::vector<double>& numbers) {
  ProbeMap turned = probe;
  turned.rotation = after(probe.rotation, parseRotation(numbers, "rotated()"));
  return turned;
}

ProbeMap scaled(const ProbeMap& probe, const std::vector<double>& factor) {
  for (const double channel : factor)
    if (channel != 0 && !isPositiveFloat(channel))
      throwInput("scaled(): {} should be 0, or {}", channel, kPositiveFloats);
  ProbeMap result = probe;
  result.scale *= colorOf(factor);
  return result;
}

// The map times the scale, not turned.
Image scaledMap(const ProbeMap& probe) {
  Image map = *probe.map;
  multiply(map, Rgb(probe.scale));
  for (const float texel : map.texels)
    if (!std::isfinite(texel))
      throwInput("{}: a texel times the scale exceeds the range of a float", probe.name);
  return map;
}

ArrayOut<float> radiance(const ProbeMap& map, const ArrayIn<float>& directions) {
  std::vector<vec3> found = vectorsOf<vec3>(directions);
  {
    const nb::gil_scoped_release released;
    const Probe probe(*map.map, map.rotation, Rgb(map.scale));
    for (vec3& direction : found) direction = probe.radiance(direction);
  }
  return arrayOf<float>(std::move(found));
}

ArrayOut<double> irradiance(const ProbeMap& probe, const ArrayIn<float>& given) {
  checkProcess();
  std::vector<vec3> normals = vectorsOf<vec3>(given);
  std::vector<dvec3> found;
  {
    const nb::gil_scoped_release released;
    for (vec3& normal : normals) normal = probe.rotation.back(normal);
    found = exactIrradiance(*probe.map, normals);
    for (dvec3& e : found) e *= probe.scale;
  }
  return arrayOf<double>(std::move(found));
}

// Directions, irradiances and diameters of lights, and the ambient radiance.
using LightArrays = std::tuple<ArrayOut<double>, ArrayOut<double>, std::vector<double>,
                               std::optional<std::vector<float>>>;

LightArrays arraysOf(const ProbeMap& probe, const std::vector<Sun>& lights,
                     const std::optional<Rgb>& ambient) {
  std::vector<dvec3> directions, irradiances;
  std::vector<double> angles;
  for (const Sun& light : lights) {
    directions.push_back(probe.rotation(light.direction));
    irradiances.push_back(light.irradiance * probe.scale);
    angles.push_back(light.angle);
  }
  std::optional<std::vector<float>> constant;
  if (ambient) {
    const Rgb c = *ambient * Rgb(probe.scale);
    constant = {c.x, c.y, c.z};
  }
  return {arrayOf<double>(std::move(directions)), arrayOf<double>(std::move(irradiances)),
          std::move(angles), std::move(constant)};
}

LightArrays lights(const ProbeMap& probe, const std::string& method, std::optional<int> count,
                   uint64_t seed, bool ambient) {
  checkProcess();
  LightRequest request{
      .count = count, .seed = seed, .ambient = ambient, .maxErrorPercent = {}, .levels = {}};
  const LightingMethod& row = lightMethod(method, "lights()");
  if (ambient && !row.lights.fitsAmbient)
    throwInput("lights(): {} fits no ambient light; use irradiance-fit", method);
  if (!count && !row.lights.countIsOptional) throwInput("lights(): {} needs a count", method);
  std::vector<Sun> found;
  MadeLights made;
  {
    const nb::gil_scoped_release released;
    made = makeLights(method, *probe.map, request);
    for (const DirectionalLight& l : made.lights)
      found.push_back({dvec3(l.direction), dvec3(l.irradiance), double(l.angle)});
  }
  return arraysOf(probe, found, made.ambient);
}

LightArrays suns(const ProbeMap& probe) {
  checkProcess();
  SunExtraction found;
  {
    const nb::gil_scoped_release released;
    found = extractSuns(*probe.map);
  }
  return arraysOf(probe, found.suns, {});
}

ArrayOut<float> converted(const ProbeMap& probe, const std::string& name,
                          std::optional<std::pair<int, int>> given) {
  checkProcess();
  Image result;
  {
    const nb::gil_scoped_release released;
    const ImageSize own{probe.map->width, probe.map->height};
    const Mapping mapping =
        given ? parseMapping(name, given->first, given->second, "to()").value_or(Mapping::LatLong)
              : parseMapping(name, "to()");
    const ImageSize size = given ? ImageSize{given->first, given->second} : sizeFor(mapping, own);
    checkImageSize("to()", size.width, size.height, 3);
    result = convert(scaledMap(probe), Mapping::LatLong, mapping, size, probe.rotation);
  }
  return arrayOf(std::move(result));
}

}  // namespace

void bindProbe(nb::module_& m) {
  nb::class_<ProbeMap>(m, "ProbeMap", "A lat-long map in memory, turned and scaled.")
      .def_static("read", readProbe, nb::arg("path"), nb::arg("mapping"))
      .def_static("of_array", probeOfArray, nb::arg("array").noconvert(), nb::arg("mapping"))
      .def("rotated", rotated, nb::arg("numbers"))
      .def("scaled", scaled, nb::arg("factor"))
      .def("radiance", radiance, nb::arg("directions").noconvert())
      .def("irradiance", irradiance, nb::arg("normals").noconvert())
      .def("lights", lights, nb::arg("method"), nb::arg("count").none(), nb::arg("seed"),
           nb::arg("ambient"))
      .def("suns", suns)
      .def("to", converted, nb::arg("mapping"), nb::arg("size").none())
      .def_prop_ro("size", [](const ProbeMap& p) { return std::pair(p.map->width, p.map->height); })
      .def_ro("name", &ProbeMap::name)
      .def_ro("mapping", &ProbeMap::mapping)
      .def_prop_ro("messages", [](const ProbeMap& p) { return pairsOf(p.messages); });
}

}  // namespace chromeball::python
