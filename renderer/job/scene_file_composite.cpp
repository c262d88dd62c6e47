// SPDX-License-Identifier: Apache-2.0
#include "job/scene_file_composite.h"

namespace chromeball {
namespace {

float fraction(const Entry& entry) {
  return float(entry.number("a number from 0 to 1", [](double x) { return x >= 0 && x <= 1; }));
}

}  // namespace

CompositeEntry readComposite(const Section& root) {
  const Section section = root.section("composite", {"plate", "local_scene", "mode", "reflectance",
                                                     "iterations", "specular", "roughness"});
  CompositeEntry composite;
  composite.location = section.location();
  for (const char* key : {"plate", "local_scene"})
    if (!section[key]) failAt(composite.location, "[composite] has no `{}`", key);
  composite.plate = existing(section["plate"]);
  forEach(section["local_scene"],
          [&](const Entry& e) { composite.localScene.push_back(e.name()); });
  if (const Entry e = section["mode"]) composite.mode = e.name();
  if (const Entry e = section["reflectance"]) composite.reflectance = e.name();
  if (const Entry e = section["iterations"]) composite.iterations = int(e.integer(1, 20));
  if (const Entry e = section["specular"]) composite.specular = fraction(e);
  if (const Entry e = section["roughness"]) composite.roughness = fraction(e);
  return composite;
}

Surroundings readSurroundings(const Section& root) {
  const Section section =
      root.section("surroundings", {"shape", "min", "max", "center", "radius", "file", "capture"});
  const auto need = [&](const char* key) {
    const Entry entry = section[key];
    if (!entry) failAt(section.location(), "[surroundings] has no `{}`", key);
    return entry;
  };
  const Entry shape = need("shape");
  Surroundings s;
  if (shape.text() == "box") {
    s.shape = Surroundings::Shape::Box;
    s.min = need("min").vector(), s.max = need("max").vector();
    if (!glm::all(glm::lessThan(s.min, s.max)))
      failAt(section.location(), "[surroundings]: `max` must be above `min` along each axis");
    s.capture = 0.5f * (s.min + s.max);
  } else if (shape.text() == "sphere") {
    s.shape = Surroundings::Shape::Sphere;
    s.capture = s.center = need("center").vector();
    s.radius = float(need("radius").positive());
  } else if (shape.text() == "model") {
    s.shape = Surroundings::Shape::Model;
    s.model = existing(need("file"));
    s.capture = need("capture").vector();
    return s;
  } else {
    failAt(shape.location(), "`shape` is \"box\", \"sphere\" or \"model\", not \"{}\"",
           shape.text());
  }
  if (const Entry e = section["capture"]) s.capture = e.vector();
  if (!s.contains(s.capture))
    failAt(section.location(),
           "[surroundings]: `capture`, where the probe was taken, lies outside");
  return s;
}

}  // namespace chromeball
