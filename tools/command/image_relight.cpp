// SPDX-License-Identifier: Apache-2.0
// chromeball image relight GROUPS.exr --gain sun=2,lamp=1,0.8,0.6 -o OUT.exr
// chromeball image relight AO.exr --probe PROBE -o OUT.exr
#include <array>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "commands.h"
#include "front/arguments.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "messages.h"
#include "probe/load.h"
#include "probe/probe.h"
#include "probe/sun_extraction.h"
#include "probe_options.h"
#include "relight/stage/light_layers.h"

namespace chromeball {
namespace {

constexpr std::string_view kPrefix = "light.";

struct ImageRelightArguments {
  std::string in, out, gains, tone = "none";
  float exposure = 0;
  // These are for relighting with a probe:
  std::string probe, mapping = "auto", scale = "1", added;
  Rotation rotation;
  bool bent = false, leavesSunsOut = false;
};

// "sun=2,lamp=1,0.8,0.6": a number (grey) or three for each name.
std::map<std::string, Rgb> parseGains(const std::string& text) {
  std::map<std::string, std::string> numbers;
  std::string name;
  for (size_t from = 0; from <= text.size();) {
    const size_t comma = std::min(text.find(',', from), text.size());
    std::string item = text.substr(from, comma - from);
    from = comma + 1;
    if (const size_t equals = item.find('='); equals != std::string::npos) {
      name = item.substr(0, equals);
      item.erase(0, equals + 1);
      if (numbers.contains(name)) throwInput("--gain: `{}` has two gains", name);
    } else if (name.empty()) {
      throwInput("--gain: `{}` is no NAME=GAIN or NAME=R,G,B", item);
    } else {
      numbers[name] += ',';
    }
    numbers[name] += item;
  }
  std::map<std::string, Rgb> gains;
  for (const auto& [group, list] : numbers) {
    const bool isGrey = list.find(',') == std::string::npos;
    const auto values = parseNumbers(list, isGrey ? 1 : 3, "--gain " + group);
    gains[group] =
        isGrey ? Rgb(float(values[0])) : Rgb(float(values[0]), float(values[1]), float(values[2]));
    if (!isFinite(gains[group])) throwInput("--gain {}: is too large", group);
    if (const Rgb& g = gains[group]; std::min({g.x, g.y, g.z}) < 0)
      throwInput("--gain {}: must not be negative", group);
  }
  return gains;
}

struct Groups {
  std::vector<std::string> names;
  std::vector<Image> layers;
};

Groups readGroups(const ImageFile& file, const std::string& path) {
  Groups groups;
  for (const std::string& layer : layerNames(file)) {
    if (!layer.starts_with(kPrefix)) continue;
    const std::optional<Image> image = findLayer(file, layer);
    if (!image || image->channels != 3) continue;
    groups.names.push_back(layer.substr(kPrefix.size()));
    groups.layers.push_back(*image);
  }
  if (groups.layers.empty())
    throwInput("{}: has no light groups; `render --aov light_groups` writes them", path);
  return groups;
}

// The gains in the order of the groups; 1 for groups that are not named.
std::vector<Rgb> gainsOf(const Groups& groups, const std::map<std::string, Rgb>& given) {
  std::vector<Rgb> gains(groups.names.size(), Rgb(1));
  for (const auto& [name, gain] : given) {
    const auto found = std::ranges::find(groups.names, name);
    if (found == groups.names.end())
      throwInput("--gain: there is no group `{}`; {}", name,
                 didYouMean(name, {groups.names.begin(), groups.names.end()}));
    gains[size_t(found - groups.names.begin())] = gain;
  }
  return gains;
}

// Takes the file's alpha: light does not change it.
Layer withAlphaOf(const ImageFile& file, const Image& color) {
  const std::optional<Image> before = findColorAndAlpha(file);
  if (!before || before->channels < 4) return {"", "RGB", color};
  Image both = *before;
  for (int y = 0; y < both.height; ++y)
    for (int x = 0; x < both.width; ++x) both.setRgb(x, y, color.rgb(x, y));
  return {"", "RGBA", std::move(both)};
}

Image neededLayer(const ImageFile& file, const std::string& path, const std::string& name,
                  int channels) {
  const std::optional<Image> layer = findLayer(file, name);
  if (!layer || layer->channels != channels)
    throwInput(
        "{}: has no layer `{}`; `render --aov albedo,normal,ao,bent_normal` writes what --probe "
        "needs",
        path, name);
  return *layer;
}

Image lightMap(const ImageRelightArguments& arguments) {
  Image map = openProbe(arguments.probe, arguments.mapping, "--probe-mapping").latLong;
  map = Probe(map, {}, parseColor(arguments.scale, "--probe-scale")).latLong();
  return arguments.leavesSunsOut ? extractSuns(map).remainder : map;
}

void checkFinite(const Image& color, const std::string& path) {
  for (const float texel : color.texels)
    if (!std::isfinite(texel))
      throwInput("{}: the picture exceeds the largest float, 3.4e38, or has such texels", path);
}

// "probe=dusk.exr rotation=30 scale=2".
std::string lightInWords(const ImageRelightArguments& a) {
  std::string text = "probe=" + a.probe;
  if (a.mapping != "auto") text += " mapping=" + a.mapping;
  if (a.rotation != Rotation())
    text += fmt::format(" rotation={}", fmt::join(a.rotation.numbers(), ","));
  if (a.scale != "1") text += " scale=" + a.scale;
  if (a.bent) text += " bent";
  if (a.leavesSunsOut) text += " suns";
  if (!a.added.empty()) text += " add=" + a.added;
  return text;
}

// "gain=sun=2,lamp=1,0.8,0.6", after the gains applied to the image before.
std::string gainsInWords(const ImageRelightArguments& a, const Metadata& metadata) {
  std::string text;
  if (const auto earlier = metadata.find("relit"); earlier != metadata.end())
    if (const auto* gains = std::get_if<std::string>(&earlier->second)) text = *gains + "; then ";
  return text + "gain=" + a.gains;
}

// The attributes of a render that are no longer true once its light is another: of how bright the
// sources are; of the sources, the paths from them, their samples and the file.
constexpr const char* kOfNoise[] = {"exposure",  "noise",          "noise_median",
                                    "noise_p95", "denoised_noise", "clamp_light_removed"};
constexpr auto kOfLight = std::to_array<const char*>({"probe",
                                                      "probe-mapping",
                                                      "probe-found",
                                                      "probe-rotation",
                                                      "probe-scale",
                                                      "files",
                                                      "lights",
                                                      "light-units",
                                                      "light-from",
                                                      "sun-angle",
                                                      "show-lights",
                                                      "strategy",
                                                      "mis",
                                                      "guide",
                                                      "regularize",
                                                      "clamp",
                                                      "denoise",
                                                      "integrator",
                                                      "ao",
                                                      "reflection-occlusion",
                                                      "irradiance-cache",
                                                      "max-depth",
                                                      "max-diffuse-depth",
                                                      "max-specular-depth",
                                                      "max-transmission-depth",
                                                      "glass-shadows",
                                                      "samples",
                                                      "samplesOfAll",
                                                      "adaptive",
                                                      "seed",
                                                      "shard",
                                                      "samples-limit",
                                                      "noise-limit",
                                                      "time-limit",
                                                      "rays",
                                                      "seconds",
                                                      "command",
                                                      "aov"});

// The file's attributes without those that are no longer true, and how it was relit.
Metadata relitMetadata(const ImageRelightArguments& arguments, const ImageFile& file) {
  Metadata kept = keptMetadata(file.metadata, arguments.in, arguments.out);
  for (const char* name : kOfNoise) kept.erase(name);
  if (!arguments.probe.empty())
    for (const char* name : kOfLight) kept.erase(name);
  kept["relit"] =
      arguments.probe.empty() ? gainsInWords(arguments, file.metadata) : lightInWords(arguments);
  return kept;
}

void runProbe(const ImageRelightArguments& arguments, const DisplayTransform& transform) {
  const ImageFile file = openImageFile(arguments.in);
  const OcclusionLayers layers{
      neededLayer(file, arguments.in, "albedo", 3),
      neededLayer(file, arguments.in, arguments.bent ? "bent_normal" : "normal", 3),
      neededLayer(file, arguments.in, "ao", 1)};
  Image color = relit(layers, lightMap(arguments), arguments.rotation);
  if (!arguments.added.empty()) {
    ImageFile addedFile = openImageFile(arguments.added);
    const bool isInPlace = addedFile.placement == file.placement;
    const Image added = colorOfData(std::move(addedFile), arguments.added);
    if (added.width != color.width || added.height != color.height)
      throwInput("{}: has {} x {} pixels; {} has {} x {}", arguments.added, added.width,
                 added.height, arguments.in, color.width, color.height);
    if (!isInPlace)
      throwInput("{}: its pixels are at another place of the picture than those of {}",
                 arguments.added, arguments.in);
    color = sumOf(std::array{std::move(color), added});
  }
  checkFinite(color, arguments.in);
  OutputImage output;
  output.metadata = relitMetadata(arguments, file);
  output.placement = file.placement;
  output.layers.push_back(withAlphaOf(file, color));
  writeKept(arguments.out, std::move(output), arguments.in, transform);
}

void runGains(const ImageRelightArguments& arguments, const DisplayTransform& transform) {
  const std::map<std::string, Rgb> given = parseGains(arguments.gains);
  const ImageFile file = openImageFile(arguments.in);
  Groups groups = readGroups(file, arguments.in);
  const std::vector<Rgb> gains = gainsOf(groups, given);
  for (size_t i = 0; i < gains.size(); ++i) groups.layers[i] = scaled(groups.layers[i], gains[i]);
  OutputImage output;
  output.metadata = relitMetadata(arguments, file);
  output.placement = file.placement;
  output.layers.push_back(withAlphaOf(file, sumOf(groups.layers)));
  checkFinite(output.layers.front().image, arguments.in);
  for (size_t i = 0; i < gains.size(); ++i)
    output.layers.push_back(
        {std::string(kPrefix) + groups.names[i], "RGB", std::move(groups.layers[i])});
  writeKept(arguments.out, std::move(output), arguments.in, transform);
}

void checkEffects(const ImageRelightArguments& arguments, const Command& command) {
  if (!arguments.gains.empty())
    command.refuse(
        {"--bent", "--suns", "--add", "--probe-rotation", "--probe-scale", "--probe-mapping"},
        "has no effect with --gain; it is for --probe, leave it out");
  if (lowerExtension(arguments.out) == ".png") return;
  for (const auto& [given, option] : {std::pair(arguments.exposure != 0, "--exposure"),
                                      std::pair(arguments.tone != "none", "--tonemap")})
    if (given) throwInput("{}: is for a .png; other images are linear", option);
}

void run(const ImageRelightArguments& arguments, const Command& command) {
  checkWritable(arguments.out);
  checkDistinct({arguments.out}, {arguments.in, arguments.probe, arguments.added});
  const DisplayTransform transform{parseToneOperator(arguments.tone), arguments.exposure};
  if (!std::isfinite(arguments.exposure))
    throwInput("--exposure: must be a finite number of stops");
  if (arguments.gains.empty() == arguments.probe.empty())
    throwInput("--gain, --probe: give one of the two");
  checkEffects(arguments, command);
  arguments.probe.empty() ? runGains(arguments, transform) : runProbe(arguments, transform);
}

}  // namespace

void addImageRelightCommand(Command image) {
  auto [command, a] = image.addCommand<ImageRelightArguments>(
      "relight",
      "Mix the light groups of a render anew (`render --aov light_groups`), or light its surfaces "
      "by another probe (`render --aov albedo,normal,ao,bent_normal`).",
      run);
  command.addRequired("GROUPS", a.in, "the .exr with the layers");
  command.addJoinedOption("--gain", a.gains,
                          "NAME=GAIN or NAME=R,G,B for each group to change: sun=2,lamp=1,0.8,0.6");
  command.addOption("--probe", a.probe,
                    "light by this probe: albedo / pi times ambient occlusion times irradiance");
  command.addFlag("--bent", a.bent, "with --probe: irradiance on the bent normals");
  command.addFlag("--suns", a.leavesSunsOut,
                  "with --probe: without its suns, which `render --light-from suns` renders with "
                  "their shadows");
  command.addOption("--add", a.added, "with --probe: a picture to add, such as that of the suns");
  addRotationOption(command, a.rotation);
  command.addWithDefault("--probe-scale", a.scale, "X or R,G,B: factor of the probe");
  command.addWithDefault("--probe-mapping", a.mapping, "of the probe; auto detects it");
  command.addRequired("-o,--output", a.out,
                      "the image to write: .exr (with the changed groups), .hdr, .pfm or .png");
  command.addOption("--exposure", a.exposure, "of a .png, in stops");
  command.addWithDefault("--tonemap", a.tone,
                         fmt::format("of a .png: {}", fmt::join(toneOperatorNames(), ", ")));
}

}  // namespace chromeball
