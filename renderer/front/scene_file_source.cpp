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

std::vector<SourceEntry> readSources(const Entry& entry, std::vector<std::string>& files) {
  if (!entry.node->is_table()) entry.mustBe("a table, [[source]]");
  const Section source(entry.file, "source", *entry.node->as_table());
  const Entry polygon = source["probe_polygon"], file = source["file"];
  if (!polygon == !file)
    failAt(source.location(), "[[source]] needs either `probe_polygon` or `file`");
  SourceEntry common;
  common.location = source.location();
  common.name = source["name"] ? source["name"].text() : "source";
  if (const Entry illum = source["illum"]) common.isIllum = illum.flag();
  if (const Entry offset = source["offset"]) offset.number();
  std::vector<SourceEntry> sources;
  if (polygon) {
    sources.push_back(common);
    sources.back().corners = readCorners(polygon);
    return sources;
  }
  files.push_back(existingFile(file));
  for (const PolygonCorners& corners : readPolygons(files.back())) {
    SourceEntry& added = sources.emplace_back(common);
    added.name += fmt::format("_{}", sources.size() - 1);
    added.corners = corners;
    added.location = fmt::format("{}: polygons[{}]", files.back(), sources.size() - 1);
  }
  return sources;
}

}  // namespace chromeball
