// SPDX-License-Identifier: Apache-2.0
#include "image/io/color_channels.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>

#include "base/text.h"

namespace chromeball {
namespace {

// The segments of a name: "ViewLayer" and "Combined" of "ViewLayer.Combined".
std::vector<std::string_view> segmentsOf(std::string_view name) {
  std::vector<std::string_view> segments;
  for (size_t begin = 0; begin <= name.size();) {
    const size_t end = std::min(name.find('.', begin), name.size());
    segments.push_back(name.substr(begin, end - begin));
    begin = end + 1;
  }
  return segments;
}

bool isIn(const auto& list, std::string_view word) {
  return std::ranges::find(list, word) != std::end(list);
}

// The words of a name, in lower case: "denoising" and "albedo" of "Denoising Albedo", "crypto" and
// "object" of "CryptoObject00", "z" and "depth" of "ZDepth".
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

enum class Content { Light, Surface, Data };  // Surface: the colour of a material

// The content, judged by the layer names of this program, Blender, Arnold, V-Ray, Houdini,
// Cryptomatte and others.
Content contentOf(std::string_view segment) {
  constexpr std::array kDataSegments = {"node",    "clipped", "material", "ratio", "samples",
                                        "invalid", "zback",   "time",     "heat",  "noise"};
  constexpr std::array kSurfaceSegments = {"diffcol", "glosscol", "transcol", "subsurfacecol",
                                           "reflectance"};
  constexpr std::array kDataWords = {
      "alpha",     "ao",        "occlusion", "mist",     "normal",   "normals",      "position",
      "pref",      "velocity",  "motion",    "vector",   "vectors",  "tangent",      "uv",
      "shadow",    "id",        "ids",       "index",    "mask",     "masks",        "matte",
      "mattes",    "count",     "error",     "distance", "coverage", "opacity",      "roughness",
      "metallic",  "metalness", "disparity", "facing",   "st",       "motionvector", "var",
      "std",       "deviation", "sigma",     "mse",      "rmse",     "weight",       "weights",
      "shadowing", "heatmap",   "confidence"};
  constexpr std::array kDataPartsOfWords = {"depth", "crypto", "variance", "stddev", "samplecount"};
  // V-Ray's filters are factors of its raw light.
  constexpr std::array kSurfaceWords = {"basecolor", "filter", "wire"};
  constexpr std::array kSurfacePartsOfWords = {"albedo"};
  // Words before "color": "BaseColor", "diffuse_color".
  constexpr std::array kOfSurfaces = {"base",       "diffuse",      "specular", "wire",
                                      "subsurface", "transmission", "object",   "material",
                                      "surface",    "vertex"};
  // Spaces in names of normals and positions: "Pworld", "Nn", "Pref".
  constexpr std::array kSpaces = {"world", "camera", "cam",    "object", "obj", "ref", "rest",
                                  "eye",   "view",   "screen", "n",      "g",   "s",   "w"};
  const auto hasIn = [](const auto& list, const std::string& word) {
    return std::ranges::any_of(list,
                               [&](const char* part) { return word.find(part) != word.npos; });
  };
  const std::string lower = lowerCase(segment);
  if (isIn(kDataSegments, lower)) return Content::Data;
  const std::vector<std::string> words = wordsOf(segment);
  const auto isData = [&](const std::string& word) {
    return isIn(kDataWords, word) || hasIn(kDataPartsOfWords, word) ||
           ((word[0] == 'p' || word[0] == 'n') && isIn(kSpaces, std::string_view(word).substr(1)));
  };
  if (std::ranges::any_of(words, isData)) return Content::Data;
  if (isIn(kSurfaceSegments, lower)) return Content::Surface;
  for (size_t i = 0; i < words.size(); ++i)
    if (isIn(kSurfaceWords, words[i]) || hasIn(kSurfacePartsOfWords, words[i]) ||
        (i > 0 && (words[i] == "color" || words[i] == "colour") && isIn(kOfSurfaces, words[i - 1])))
      return Content::Surface;
  return Content::Light;
}

// Whether a letter names alpha, a normal, a position or a depth; also "N" of the channel
// "View.N.X". Elsewhere a letter has no meaning: the view "A".
bool isLetterOfNoLight(const std::vector<std::string_view>& segments) {
  const auto is = [](std::string_view segment) {
    return segment.size() == 1 && std::string_view("anpzANPZ").find(segment) != segment.npos;
  };
  const size_t count = segments.size();
  return is(segments.back()) ||
         (count > 1 && segments.back().size() == 1 && is(segments[count - 2]));
}

Content contentOf(const std::vector<std::string_view>& segments) {
  Content content = isLetterOfNoLight(segments) ? Content::Data : Content::Light;
  for (const std::string_view segment : segments) content = std::max(content, contentOf(segment));
  return content;
}

// The rank of a layer, the least being the best; nullopt: no light.
constexpr int kUnnamed = 0, kWithBeauty = 5, kOtherLayer = 6, kGrey = 7;
std::optional<int> colorRank(const std::string& layer) {
  constexpr std::array kLight = {"combined", "beauty", "rgba", "c"};
  if (layer.empty()) return kUnnamed;
  const std::vector<std::string_view> segments = segmentsOf(layer);
  const auto light = std::find(kLight.begin(), kLight.end(), lowerCase(segments.back()));
  if (light != kLight.end()) return 1 + int(light - kLight.begin());
  if (contentOf(segments) != Content::Light) return {};
  return isIn(wordsOf(segments.back()), "beauty") ? kWithBeauty : kOtherLayer;
}

// Y, or the only channel besides alpha, unless that is known to be something else.
std::optional<std::string> greyChannel(const std::vector<std::string>& channels) {
  constexpr std::array kPartsOfColor = {"R", "G", "B", "X", "Z", "RY", "BY", "U", "V"};
  if (isIn(channels, "Y")) {
    const bool hasOther = std::ranges::any_of(
        channels, [&](const auto& name) { return isIn(kPartsOfColor, name) && name != "Z"; });
    return hasOther ? std::nullopt : std::optional<std::string>("Y");
  }
  std::optional<std::string> only;
  for (const std::string& channel : channels) {
    if (channel == "A") continue;
    if (only || isIn(kPartsOfColor, channel) || !colorRank(channel)) return {};
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
  const std::set<std::string_view> names(part.channels.begin(), part.channels.end());
  for (const std::string& channel : part.channels) {
    if (channel != "R" && !channel.ends_with(".R")) continue;
    const std::string prefix = channel.substr(0, channel.size() - 1);
    if (!names.contains(prefix + "G") || !names.contains(prefix + "B")) continue;
    const std::string layer = prefix.empty() ? part.name : prefix.substr(0, prefix.size() - 1);
    if (const auto rank = colorRank(layer))
      candidates.push_back({*rank, {index, layer, {prefix + "R", prefix + "G", prefix + "B"}, {}}});
  }
  if (const auto grey = greyChannel(part.channels); grey && colorRank(part.name))
    candidates.push_back({kGrey, {index, part.name, {*grey}, {}}});
}

}  // namespace

bool isColorLayer(const std::string& layer) {
  return contentOf(segmentsOf(layer)) != Content::Data;
}

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
