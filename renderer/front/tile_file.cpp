// SPDX-License-Identifier: Apache-2.0
#include "front/tile_file.h"

#include <sstream>

#include "base/error.h"
#include "base/text.h"
#include "front/toml_section.h"
#include "image/io/output_file.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxTiles = 1000;

class TileReader {
 public:
  explicit TileReader(const std::string& path) : path_(path), table_(parseToml(path)) {}

  std::vector<TileEntry> tiles() const {
    check(table_, {"fov", "tile"});
    const toml::array* list = table_["tile"].as_array();
    if (!list || list->empty()) throwInput("{}: has no [[tile]]", path_);
    if (list->size() > kMaxTiles)
      throwInput("{}: has {} tiles; at most {} are stitched", path_, list->size(), kMaxTiles);
    std::vector<TileEntry> tiles;
    for (const toml::node& node : *list) {
      if (!node.is_table()) failAt(at(node), "`tile` must be a table, [[tile]]");
      tiles.push_back(tile(*node.as_table()));
    }
    return tiles;
  }

 private:
  std::string at(const toml::node& node) const {
    return fmt::format("{}:{}", path_, node.source().begin.line);
  }

  void check(const toml::table& table, const std::vector<std::string_view>& keys) const {
    for (const auto& [key, node] : table)
      if (std::ranges::count(keys, key.str()) == 0)
        failAt(fmt::format("{}:{}", path_, key.source().begin.line), "unknown key `{}`; {}",
               printableName(key.str()), didYouMean(key.str(), keys));
  }

  // Nullopt if there is no such key.
  std::optional<double> number(const toml::table& table, std::string_view key, double least,
                               double most) const {
    const toml::node* node = table.get(key);
    if (!node) return std::nullopt;
    const auto number = node->is_number() ? node->value<double>() : std::nullopt;
    if (!number || !(*number >= least && *number <= most))
      failAt(at(*node), "`{}` must be a number of degrees from {:g} to {:g}", key, least, most);
    return number;
  }
  std::optional<double> fov(const toml::table& table) const {
    return number(table, "fov", 0.01, 179);
  }

  TileEntry tile(const toml::table& table) const {
    check(table, {"file", "yaw", "pitch", "roll", "fov"});
    const Entry file{path_, "file", table.get("file")};
    if (!file) failAt(at(table), "[[tile]] needs `file`, the name of an image");
    constexpr double kMost = 3600;
    const auto angle = [&](const char* key) {
      return number(table, key, -kMost, kMost).value_or(0);
    };
    const std::optional<double> own = fov(table), common = fov(table_);
    if (!own && !common)
      failAt(at(table), "[[tile]] needs `fov`, vertical, or the list one for all");
    return {existingFile(file, "the list"),
            {angle("yaw"), angle("pitch"), angle("roll")},
            own ? *own : *common,
            at(table)};
  }

  const std::string& path_;
  toml::table table_;
};

}  // namespace

std::vector<TileEntry> readTiles(const std::string& path) { return TileReader(path).tiles(); }

void writeTiles(const std::string& path, const std::vector<TileEntry>& tiles) {
  const fs::path folder = fs::absolute(path).parent_path();
  std::string text;
  for (const TileEntry& tile : tiles) {
    toml::table table{{"file", fs::absolute(tile.file).lexically_proximate(folder).string()},
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
