// SPDX-License-Identifier: Apache-2.0
#include "front/polygon_file.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/json.h"
#include "image/io/output_file.h"

namespace chromeball {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr size_t kMaxPolygons = 1000, kMaxMegabytes = 10;

PolygonCorners readCorners(const json& polygon, const std::string& where) {
  const auto points = polygon.is_object() ? polygon.find("probe_polygon") : polygon.end();
  if (!polygon.is_object() || points == polygon.end() || !points->is_array())
    throwInput("{}: has no array `probe_polygon`", where);
  PolygonCorners corners;
  for (const json& point : *points) {
    if (!point.is_array() || point.size() != 2 || !point[0].is_number() || !point[1].is_number())
      throwInput("{}: `probe_polygon` should be pairs of numbers, [u, v]", where);
    corners.push_back({point[0].get<double>(), point[1].get<double>()});
  }
  return corners;
}

ordered_json arrayOf(const dvec3& v) { return {float(v.x), float(v.y), float(v.z)}; }

}  // namespace

std::vector<PolygonCorners> readPolygons(const std::filesystem::path& path) {
  const json root = readJsonFile(path, kMaxMegabytes, "lists of polygons");
  const auto polygons = root.is_object() ? root.find("polygons") : root.end();
  if (!root.is_object() || polygons == root.end() || !polygons->is_array())
    throwInput("{}: has no array `polygons`; `chromeball lights --suggest` writes such lists",
               path.string());
  if (polygons->size() > kMaxPolygons)
    throwInput("{}: has more than {} polygons", path.string(), kMaxPolygons);
  std::vector<PolygonCorners> result;
  for (size_t i = 0; i < polygons->size(); ++i)
    result.push_back(
        readCorners((*polygons)[i], fmt::format("{}: polygons[{}]", path.string(), i)));
  return result;
}

void writePolygons(const std::filesystem::path& path, const std::string& probe,
                   const std::vector<PolygonCorners>& polygons,
                   const std::vector<PolygonSource>& sources) {
  ordered_json list = ordered_json::array();
  for (size_t i = 0; i < polygons.size(); ++i) {
    ordered_json corners = ordered_json::array();
    for (const glm::dvec2& c : polygons[i]) corners.push_back({float(c.x), float(c.y)});
    list.push_back({{"probe_polygon", corners},
                    {"solid_angle", float(sources[i].polygon.solidAngle())},
                    {"radiance", arrayOf(sources[i].radiance)},
                    {"irradiance", arrayOf(sources[i].irradiance())}});
  }
  writeText(path, jsonText(ordered_json{{"probe", probe}, {"polygons", list}}, 2) + "\n");
}

}  // namespace chromeball
