// SPDX-License-Identifier: Apache-2.0
#include "front/scene_file_source.h"

#include <fmt/format.h>

#include "front/polygon_file.h"

namespace chromeball {
namespace {

PolygonCorners readCorners(const Entry& entry) {
  if (!entry.isArray()) entry.mustBe(entry.setting->form);
  PolygonCorners corners;
  for (size_t i = 0; i < entry.node->as_array()->size(); ++i) {
    const Entry corner = entry.element(i);
    if (!corner.isArrayOf(2)) corner.mustBe("two numbers, [u, v]");
    corners.push_back({corner.element(0).number(), corner.element(1).number()});
  }
  return corners;
}

}  // namespace

void readSources(const Entry& entry, SceneFile& scene) {
  if (!entry.node->is_table()) entry.mustBe("a table, [[source]]");
  const Section source(entry.file, "source", *entry.node->as_table());
  const Entry polygon = source["probe_polygon"], file = source["file"];
  if (!polygon == !file)
    failAt(source.location(), "[[source]] needs either `probe_polygon` or `file`");
  SourceEntry common;
  common.name = source["name"] ? source["name"].text() : "source";
  if (const Entry illum = source["illum"]) common.isIllum = illum.flag();
  if (const Entry offset = source["offset"]) offset.number();
  const auto add = [&](const PolygonCorners& corners, const std::string& location) {
    scene.origins.set(elementName("sources", scene.sources.size()), location);
    SourceEntry& added = scene.sources.emplace_back(common);
    added.corners = corners;
    return &added;
  };
  if (polygon) {
    add(readCorners(polygon), source.location());
    return;
  }
  const std::string path = existingFile(file);
  scene.lightLists.push_back(path);
  size_t i = 0;
  for (const PolygonCorners& corners : readPolygons(path)) {
    add(corners, fmt::format("{}: {}", path, elementName("polygons", i)))->name +=
        fmt::format("_{}", i);
    ++i;
  }
}

}  // namespace chromeball
