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

// "ViewLayer" and "Combined" of "ViewLayer.Combined".
std::vector<std::string_view> segmentsOf(std::string_view name) {
  std::vector<std::string_view> segments;
  for (size_t begin = 0; begin <= name.size();) {
    const size_t end = std::min(name.find('.', begin), name.size());
    segments.push_back(name.substr(begin, end - begin));
    begin = end + 1;
  }
  return segments;
}

// In lower case: "denoising" and "albedo" of "Denoising Albedo", "crypto" and "object" of
// "CryptoObject00", "z" and "depth" of "ZDepth".
std::vector<std::string> wordsOf(std::string_view segment) {
  const auto is = [&](size_t i, int (*kind)(int)) {
    return i < segment.size() && kind(static_cast<unsigned char>(segment[i])) != 0;
  };
  std::vector<std::string> words;
  for (size_t i = 0; i < segment.size(); ++i) {
    if (!is(i, std::isalpha)) continue;
    const bool begins =
        i == 0 || !is(i - 1, std::isalpha) ||
        (is(i, std::isupper) && (is(i - 1, std::islower) || is(i + 1, std::islower)));
    if (begins) words.emplace_back();
    words.back() += char(std::tolower(static_cast<unsigned char>(segment[i])));
  }
  return words;
}

// By the names of our own layers and of those of Blender, Arnold, V-Ray, Cryptomatte and others.
bool isNoLight(std::string_view segment) {
  constexpr std::array kSegments = {"node",     "clipped",       "diffcol", "glosscol", "transcol",
                                    "material", "subsurfacecol", "ratio",   "samples",  "variance",
                                    "invalid",  "reflectance",   "zback"};
  constexpr std::array kWords = {
      "alpha",    "ao",        "occlusion", "mist",      "normal",      "normals", "position",
      "pref",     "velocity",  "motion",    "vector",    "vectors",     "tangent", "uv",
      "shadow",   "id",        "ids",       "index",     "mask",        "masks",   "matte",
      "mattes",   "count",     "error",     "distance",  "coverage",    "opacity", "roughness",
      "metallic", "metalness", "basecolor", "disparity", "motionvector"};
  constexpr std::array kPartsOfWords = {"depth", "albedo", "crypto"};
  const auto isIn = [](const auto& list, const std::string& word) {
    return std::find(list.begin(), list.end(), word) != list.end();
  };
  if (isIn(kSegments, inLowerCase(segment))) return true;
  return std::ranges::any_of(wordsOf(segment), [&](const std::string& word) {
    return isIn(kWords, word) || std::ranges::any_of(kPartsOfWords, [&](const char* part) {
             return word.find(part) != word.npos;
           });
  });
}

// Alpha, a normal, a position, a depth; also "N" of the channel "View.N.X". Elsewhere a letter says
// nothing: the view "A".
bool isLetterOfNoLight(const std::vector<std::string_view>& segments) {
  const auto is = [](std::string_view segment) {
    return segment.size() == 1 && std::string_view("anpzANPZ").find(segment) != segment.npos;
  };
  const size_t count = segments.size();
  return is(segments.back()) ||
         (count > 1 && segments.back().size() == 1 && is(segments[count - 2]));
}

// The least is the best; nullopt: no light.
constexpr int kUnnamed = 0, kOtherLayer = 5, kGrey = 6;
std::optional<int> colorRank(const std::string& layer) {
  constexpr std::array kLight = {"combined", "beauty", "rgba", "c"};
  if (layer.empty()) return kUnnamed;
  const std::vector<std::string_view> segments = segmentsOf(layer);
  const auto light = std::find(kLight.begin(), kLight.end(), inLowerCase(segments.back()));
  if (light != kLight.end()) return 1 + int(light - kLight.begin());
  if (isLetterOfNoLight(segments) || std::ranges::any_of(segments, isNoLight)) return {};
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
