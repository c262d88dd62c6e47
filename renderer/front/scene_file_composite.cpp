// SPDX-License-Identifier: Apache-2.0
#include "front/scene_file_sections.h"

namespace chromeball {
namespace {

void readGround(const Section& section, CompositeEntry& composite, Origins& origins) {
  if (const Entry e = section["ground_reflectance"]) composite.groundReflectance = e.oneOrThree();
  if (const Entry e = section["ground_reflectance_range"]) {
    if (!e.isArrayOf(2)) e.mustBe(e.setting->form);
    origins.set("composite.ground_reflectance_range", e.location());
    composite.groundReflectanceRange = vec2(e.element(0).number(), e.element(1).number());
    if (!(composite.groundReflectanceRange.x <= composite.groundReflectanceRange.y))
      e.mustBe("two numbers, the smaller one first");
  }
  if (const Entry e = section["ground_in_plate"]) {
    if (!e.isArrayOf(4)) e.mustBe(e.setting->form);
    origins.set("composite.ground_in_plate", e.location());
    vec4 part;
    for (int i = 0; i < 4; ++i) part[i] = float(e.element(size_t(i)).number());
    if (!(part.x < part.z && part.y < part.w))
      e.mustBe("[left, top, right, bottom], left before right and top before bottom");
    composite.groundInPlate = part;
  }
}

}  // namespace

void readComposite(const Section& section, SceneFile& scene) {
  Settings& settings = scene.settings;
  section.read(settings);
  if (!isShadowCatcher(settings)) section.required("plate");
  CompositeEntry& composite = scene.composite.emplace();
  scene.origins.set("composite.entry", section.location());
  const bool hasGround = settings.get<bool>("composite.ground");
  const Entry local = section["local_scene"];
  if (!local && !hasGround)
    failAt(section.location(),
           "[composite] has no `local_scene`; name its nodes, or give `ground = true` for a plane");
  forEach(local, [&](const Entry& e) {
    scene.origins.set(elementName("composite.entry.localScene", composite.localScene.size()),
                      e.location());
    composite.localScene.push_back(e.text());
  });
  if (local && composite.localScene.empty())
    failAt(local.location(), "`local_scene` must name at least one node");
  for (const char* key :
       {"ground_height", "ground_reflectance", "ground_reflectance_range", "ground_in_plate"})
    if (const Entry e = section[key]; e && !hasGround)
      failAt(e.location(), "`{}` needs `ground = true`", key);
  readGround(section, composite, scene.origins);
}

SurroundingsEntry readSurroundings(const Section& section) {
  const auto need = [&](const char* key) { return section.required(key); };
  const std::string shape = need("shape").choice();
  SurroundingsEntry s;
  if (shape == "box") {
    section.allowOnly({"shape", "min", "max", "capture"}, "a box");
    s.shape.shape = Surroundings::Shape::Box;
    s.min = need("min").point(), s.max = need("max").point();
    if (!glm::all(glm::lessThan(s.min, s.max)))
      failAt(section.location(), "[surroundings]: `max` must be above `min` along each axis");
    s.capture = 0.5 * (s.min + s.max);
  } else if (shape == "sphere") {
    section.allowOnly({"shape", "center", "radius", "capture"}, "a sphere");
    s.shape.shape = Surroundings::Shape::Sphere;
    s.capture = s.center = need("center").point();
    s.shape.radius = float(need("radius").number());
  } else {
    section.allowOnly({"shape", "file", "capture"}, "a model");
    s.shape.shape = Surroundings::Shape::Model;
    s.shape.model = existingFile(need("file"));
    s.capture = need("capture").point();
    return s;
  }
  if (const Entry e = section["capture"]) s.capture = e.point();
  const Surroundings here = s.relativeTo(s.capture);
  if (!here.contains(here.capture))
    failAt(section.location(),
           "[surroundings]: `capture`, where the probe was captured, lies outside");
  return s;
}

}  // namespace chromeball
