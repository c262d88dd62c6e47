// SPDX-License-Identifier: Apache-2.0
#include "job/scene_file_composite.h"

#include <algorithm>
#include <map>

#include "job/setting_table.h"

namespace chromeball {
namespace {

void checkKeysOf(std::string_view shape, const Section& section) {
  static const std::map<std::string_view, std::vector<std::string_view>> kKeys = {
      {"box", {"min", "max", "capture"}},
      {"sphere", {"center", "radius", "capture"}},
      {"model", {"file", "capture"}}};
  const auto& keys = kKeys.at(shape);
  for (const std::string_view key : keysOf("surroundings"))
    if (const Entry e = section[key];
        e && key != "shape" && std::find(keys.begin(), keys.end(), key) == keys.end())
      failAt(e.location(), "surroundings of shape {} have no `{}`; they have {}", shape, key,
             fmt::join(keys, ", "));
}

}  // namespace

CompositeEntry readComposite(const Section& section, Settings& settings) {
  section.required("plate");
  section.read(settings);
  CompositeEntry composite;
  composite.location = section.location();
  const Entry local = section.required("local_scene");
  forEach(local, [&](const Entry& e) { composite.localScene.push_back(e.name()); });
  if (composite.localScene.empty())
    failAt(local.location(), "`local_scene` must name at least one node");
  return composite;
}

Surroundings readSurroundings(const Section& section) {
  const auto need = [&](const char* key) { return section.required(key); };
  const std::string shape = need("shape").choice();
  checkKeysOf(shape, section);
  Surroundings s;
  if (shape == "box") {
    s.shape = Surroundings::Shape::Box;
    s.min = need("min").vector(), s.max = need("max").vector();
    if (!glm::all(glm::lessThan(s.min, s.max)))
      failAt(section.location(), "[surroundings]: `max` must be above `min` along each axis");
    s.capture = 0.5f * (s.min + s.max);
  } else if (shape == "sphere") {
    s.shape = Surroundings::Shape::Sphere;
    s.capture = s.center = need("center").vector();
    s.radius = float(need("radius").number());
  } else {
    s.shape = Surroundings::Shape::Model;
    s.model = existingFile(need("file"));
    s.capture = need("capture").vector();
    return s;
  }
  if (const Entry e = section["capture"]) s.capture = e.vector();
  if (!s.contains(s.capture))
    failAt(section.location(),
           "[surroundings]: `capture`, where the probe was captured, lies outside");
  return s;
}

}  // namespace chromeball
