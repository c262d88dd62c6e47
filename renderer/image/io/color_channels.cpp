// SPDX-License-Identifier: Apache-2.0
#include "image/io/color_channels.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace chromeball {
namespace {

std::string inLowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = char(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

// "combined" of "ViewLayer.Combined".
std::string lastWord(const std::string& layer) {
  return inLowerCase(layer.substr(layer.rfind('.') + 1));
}

// The least is the best; nullopt: no light.
constexpr int kUnnamed = 0, kOtherLayer = 5, kGrey = 6;
std::optional<int> colorRank(const std::string& layer) {
  constexpr std::array kLight = {"combined", "beauty", "rgba", "c"};
  constexpr std::array kNoLight = {"a",        "alpha",  "ao",     "z",       "depth",  "mist",
                                   "albedo",   "n",      "normal", "normals", "p",      "position",
                                   "velocity", "motion", "vector", "uv",      "shadow", "id"};
  if (layer.empty()) return kUnnamed;
  const std::string word = lastWord(layer);
  const auto light = std::find(kLight.begin(), kLight.end(), word);
  if (light != kLight.end()) return 1 + int(light - kLight.begin());
  if (std::find(kNoLight.begin(), kNoLight.end(), word) != kNoLight.end()) return {};
  return kOtherLayer;
}

bool hasChannel(const std::vector<std::string>& channels, const std::string& name) {
  return std::find(channels.begin(), channels.end(), name) != channels.end();
}

// Y, or the only channel besides alpha, unless that is known to be something else.
std::optional<std::string> greyChannel(const std::vector<std::string>& channels) {
  constexpr std::array kPartsOfColor = {"R", "G", "B", "X", "Z", "RY", "BY", "U", "V"};
  const auto isPart = [&](const std::string& channel) {
    return std::find(kPartsOfColor.begin(), kPartsOfColor.end(), channel) != kPartsOfColor.end();
  };
  const bool hasY = hasChannel(channels, "Y");
  if (hasY && std::ranges::none_of(
                  channels, [&](const auto& channel) { return isPart(channel) && channel != "Z"; }))
    return "Y";
  if (hasY) return {};
  std::optional<std::string> only;
  for (const std::string& channel : channels) {
    if (channel == "A") continue;
    if (only || isPart(channel) || !colorRank(channel)) return {};
    only = channel;
  }
  return only;
}

struct ColorCandidate {
  int rank;
  ColorChannels color;
};

void addCandidates(const PartChannels& part, size_t index,
                   std::vector<ColorCandidate>& candidates) {
  std::vector<std::string> layers;
  for (const std::string& channel : part.channels) {
    if (channel != "R" && !channel.ends_with(".R")) continue;
    const std::string prefix = channel.substr(0, channel.size() - 1);
    if (!hasChannel(part.channels, prefix + "G") || !hasChannel(part.channels, prefix + "B"))
      continue;
    const std::string layer = prefix.empty() ? part.name : prefix.substr(0, prefix.size() - 1);
    if (const auto rank = colorRank(layer))
      candidates.push_back({*rank, {index, layer, {prefix + "R", prefix + "G", prefix + "B"}, {}}});
  }
  if (const auto grey = greyChannel(part.channels); grey && colorRank(part.name))
    candidates.push_back({kGrey, {index, part.name, {*grey}, {}}});
}

}  // namespace

std::optional<ColorChannels> findColorChannels(std::span<const PartChannels> parts) {
  std::vector<ColorCandidate> candidates;
  for (size_t i = 0; i < parts.size(); ++i) addCandidates(parts[i], i, candidates);
  const auto best = std::ranges::min_element(candidates, {}, &ColorCandidate::rank);
  if (best == candidates.end()) return {};
  ColorChannels chosen = best->color;
  for (const ColorCandidate& candidate : candidates)
    if (&candidate != &*best && !candidate.color.layer.empty())
      chosen.others.push_back(candidate.color.layer);
  return chosen;
}

}  // namespace chromeball
