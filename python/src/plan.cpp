// SPDX-License-Identifier: Apache-2.0
// Descriptions of renders, from scenes and keywords.
#include "plan.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "base/text.h"
#include "bindings.h"
#include "front/arguments.h"
#include "front/plan_render.h"
#include "front/scene_values.h"
#include "geometry.h"
#include "probe_map.h"
#include "python_light.h"
#include "study.h"
#include "values.h"

namespace chromeball::python {
namespace {

SceneFile sceneOf(nb::handle scene) {
  if (nb::isinstance<nb::str>(scene)) return openScene(textOf(scene, "scene"));
  SceneFile read = chromeball::sceneOf(tableOf(nb::cast<nb::dict>(scene), "scene"), "scene");
  read.path.clear();
  return read;
}

// A program has means of its own for files, and may have asked for none.
void keepToMemory(RenderDescription& description) {
  description.output.files.clear();
  description.output.stats.reset();
  description.run.checkpoint.reset();
}

// The probe takes the place of the scene's file, with a turn and a scale of its own: the
// description's are those of the light around the scene, which the probe is then part of.
void place(const ProbeMap& probe, RenderDescription& description) {
  ProbeDescription& light = description.probe;
  light.file.reset();
  light.map = probe.map;
  light.rotation = after(probe.rotation, light.rotation);
  light.scale *= probe.scale;
  for (int i = 0; i < 3; ++i)
    if (light.scale[i] != 0 && !isPositiveFloat(light.scale[i]))
      throwInput("{}: its scale times that of the scene, {}, should be 0, or {}", probe.name,
                 light.scale[i], kPositiveFloats);
}

Plan planOf(nb::handle scene, const Geometry* geometry, const ProbeMap* probe,
            const std::optional<Dict>& camera, const Dict& keywords, const nb::object& strategy,
            bool isCompared, const std::string& caller) {
  SceneFile file = sceneOf(scene);
  if (camera) replaceCamera(file, tableOf(*camera, "Camera()"), "Camera()");
  Settings settings = keywordSettings(tableOf(keywords, caller), caller);
  if (probe && settings.has("probe.mapping"))
    throwInput("{}: the probe is in memory; give its mapping to chromeball.Probe()",
               settings.location("probe.mapping"));
  if (isCompared) keepCompared(file, settings, caller);
  Plan plan{planRender(std::move(file), settings), size_t(settings.get<uint64_t>("threads")),
            strategy};
  RenderDescription& description = plan.description;
  keepToMemory(description);
  if (geometry) description.scene = geometry->share();
  if (probe) place(*probe, description);
  if (!strategy.is_none()) {
    description.lighting.strategy = textOf(strategy.attr("name"), "strategy");
    description.lighting.make = makerOf(strategy);
    description.origins.set("lighting.strategy", caller + ": strategy");
  }
  if (description.models.empty() && !description.scene)
    throwInput("{}: the scene has no models, and no meshes", caller);
  return plan;
}

void checkScene(const Dict& scene, const std::string& name) {
  chromeball::sceneOf(tableOf(scene, name), name);
}

void checkCamera(const Dict& camera, const std::string& name) {
  SceneFile scene;
  replaceCamera(scene, tableOf(camera, name), name);
}

std::vector<std::string> keywordNames() {
  std::vector<std::string> names;
  for (const std::string_view keyword : keywords()) names.emplace_back(keyword);
  return names;
}

std::string helpOf(const std::string& keyword) {
  const Setting* setting = findKeyword(keyword);
  if (!setting)
    throwInput("keywords(): unknown keyword `{}`; {}", printableName(keyword),
               didYouMean(keyword, keywords()));
  return fmt::format("{} Valid: {}.", setting->help, expected(*setting));
}

}  // namespace

void bindPlan(nb::module_& m) {
  nb::class_<Plan>(m, "Plan", "A render as it was asked for.");
  m.def("plan", planOf, nb::arg("scene"), nb::arg("geometry").none(), nb::arg("probe").none(),
        nb::arg("camera").none(), nb::arg("keywords"), nb::arg("strategy").none(),
        nb::arg("is_compared"), nb::arg("caller"));
  m.def("check_scene", checkScene, nb::arg("scene"), nb::arg("name"),
        "Throws InputError for a scene whose keys or values are wrong.");
  m.def("check_camera", checkCamera, nb::arg("camera"), nb::arg("name"),
        "Throws InputError for a camera whose keys or values are wrong.");
  m.def("keywords", keywordNames, "The keywords of chromeball.render().");
  m.def("help_of", helpOf, nb::arg("keyword"), "What a keyword means, and its valid values.");
}

}  // namespace chromeball::python
