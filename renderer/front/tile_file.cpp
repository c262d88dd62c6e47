// SPDX-License-Identifier: Apache-2.0
#include "front/tile_file.h"

#include <sstream>

#include "base/error.h"
#include "front/toml_section.h"
#include "image/io/output_file.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxTiles = 1000;

// Nullopt if there is no such key.
std::optional<double> degreesIn(const Section& table, std::string_view key, double least,
                                double most) {
  const Entry entry = table[key];
  if (!entry) return std::nullopt;
  const auto number = entry.node->is_number() ? entry.node->value<double>() : std::nullopt;
  if (!number || !(*number >= least && *number <= most))
    failAt(entry.location(), "`{}` must be a number of degrees from {:g} to {:g}", key, least,
           most);
  return number;
}

std::optional<double> fovIn(const Section& table) { return degreesIn(table, "fov", 0.01, 179); }

TileEntry readTile(const Entry& entry, const Section& list) {
  if (!entry.node->is_table()) failAt(entry.location(), "`tile` must be a table, [[tile]]");
  const Section tile(entry.file, *entry.node->as_table(), {"file", "yaw", "pitch", "roll", "fov"});
  const Entry file = tile["file"];
  if (!file) failAt(tile.location(), "[[tile]] needs `file`, the name of an image");
  constexpr double kMost = 3600;
  const auto angle = [&](const char* key) {
    return degreesIn(tile, key, -kMost, kMost).value_or(0);
  };
  const std::optional<double> own = fovIn(tile), common = fovIn(list);
  if (!own && !common)
    failAt(tile.location(), "[[tile]] needs `fov`, vertical, or the list one for all");
  return {existingFile(file, "the list"),
          {angle("yaw"), angle("pitch"), angle("roll")},
          own ? *own : *common,
          tile.location()};
}

}  // namespace

std::vector<TileEntry> readTiles(const std::string& path) {
  const toml::table table = parseToml(path);
  const Section list(path, table, {"fov", "tile"});
  const toml::array* entries = table["tile"].as_array();
  if (!entries || entries->empty()) throwInput("{}: has no [[tile]]", path);
  if (entries->size() > kMaxTiles)
    throwInput("{}: has {} tiles; at most {} are stitched", path, entries->size(), kMaxTiles);
  std::vector<TileEntry> tiles;
  forEach(list["tile"], [&](const Entry& entry) { tiles.push_back(readTile(entry, list)); });
  return tiles;
}

void writeTiles(const std::string& path, const std::vector<TileEntry>& tiles) {
  const fs::path file = path, folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::string text;
  for (const TileEntry& tile : tiles) {
    toml::table table{{"file", fs::proximate(tile.file, folder).string()},
                      {"yaw", tile.pose.yaw},
                      {"pitch", tile.pose.pitch},
                      {"roll", tile.pose.roll},
                      {"fov", tile.fov}};
    std::ostringstream written;
    written << table;
    text += fmt::format("[[tile]]\n{}\n\n", written.str());
  }
  writeText(path, text);
}

}  // namespace chromeball
