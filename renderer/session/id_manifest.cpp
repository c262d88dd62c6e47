// SPDX-License-Identifier: Apache-2.0
#include "session/id_manifest.h"

#include <set>

#include "base/json.h"
#include "base/json_text.h"

namespace chromeball {
namespace {

using nlohmann::ordered_json;

constexpr size_t kMaxBytes = 1 << 20, kLongestName = 256;

std::string dumped(const ordered_json& json) {
  return json.dump(-1, ' ', true,
                   ordered_json::error_handler_t::replace);  // names may hold any byte
}

// `name(id - 1)`: the name of the number `id`.
template <class Name>
std::string manifestOf(const Image& ids, const Name& name) {
  const std::set<float> present(ids.texels.begin(), ids.texels.end());
  ordered_json names = ordered_json::object();
  size_t bytes = 0, omitted = 0;
  for (const float id : present) {
    if (!(id >= 1)) continue;  // 0: nothing was hit
    const ordered_json text = name(size_t(id) - 1).substr(0, kLongestName);
    bytes += dumped(text).size() + 16;
    if (bytes > kMaxBytes)
      ++omitted;
    else
      names[std::to_string(size_t(id))] = text;
  }
  if (omitted) names["omitted"] = omitted;
  return dumped(names);
}

}  // namespace

Metadata idManifests(const OutputImage& output, const Scene& scene) {
  Metadata manifests;
  for (const Layer& layer : output.layers) {
    if (layer.name == "node")
      manifests["manifest/node"] =
          manifestOf(layer.image, [&](size_t node) { return scene.nodeNames.at(node); });
    if (layer.name == "material")
      manifests["manifest/material"] = manifestOf(
          layer.image, [&](size_t material) { return scene.materials.at(material).name; });
  }
  return manifests;
}

std::map<int, std::string> readManifest(const Metadata& metadata, const std::string& layer) {
  std::map<int, std::string> names;
  const auto found = metadata.find("manifest/" + layer);
  if (found == metadata.end() || !std::holds_alternative<std::string>(found->second)) return names;
  const auto json = readJson(std::get<std::string>(found->second));
  if (!json.is_object()) return names;
  for (const auto& [id, name] : json.items())
    if (name.is_string() && !id.empty() && id.size() < 9 &&
        id.find_first_not_of("0123456789") == std::string::npos)
      names[std::stoi(id)] = name.get<std::string>();
  return names;
}

}  // namespace chromeball
