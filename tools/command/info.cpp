// SPDX-License-Identifier: Apache-2.0
// chromeball info MODEL
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "commands.h"
#include "image/io/cube_files.h"
#include "image/io/image_format.h"
#include "info_json.h"
#include "scene/gltf/model_info.h"
#include "session/memory_estimate.h"

namespace chromeball {
namespace {

struct InfoArguments {
  std::string file;
  bool json = false, all = false, allowsExternal = false;
};

bool hasTriangles(const ModelInfo::Node& node) { return node.triangles > 0; }

// As text: a line for each subject, and below it the first elements of its list.

// "1234", "12.3 k", "1.23 M"
std::string inShort(size_t count) {
  if (count < 10000) return fmt::format("{}", count);
  return count < 1000000 ? fmt::format("{:.3g} k", 1e-3 * double(count))
                         : fmt::format("{:.3g} M", 1e-6 * double(count));
}

std::string megabytes(double bytes) { return fmt::format("{:.3g} MB", 1e-6 * bytes); }

template <class Vector>
std::string joined(const Vector& v, const char* separator = " ") {
  return fmt::format("{1:.4g}{0}{2:.4g}{0}{3:.4g}", separator, v.x, v.y, v.z);
}

void printSubjectLine(std::string_view subject, const std::string& text) {
  fmt::print("{:<12} {}\n", subject, printable(text));
}

// With four digits of the largest side of a box.
vec3 rounded(const vec3& v, const Bounds& box) {
  const double largest = std::max({box.size().x, box.size().y, box.size().z});
  if (!(largest > 0)) return v;
  const double step = std::pow(10, std::floor(std::log10(largest)) - 3);
  return vec3(glm::round(glm::dvec3(v) / step) * step + 0.0);  // and no -0
}

// `describe(element)` is what follows its name.
template <class Element, class Describe>
void printList(const std::vector<Element>& list, bool all, const Describe& describe) {
  constexpr size_t kShown = 8;
  const size_t shown = all || list.size() <= kShown + 1 ? list.size() : kShown;
  for (size_t i = 0; i < shown; ++i) {
    const auto [name, text] = describe(list[i]);
    fmt::print("  {:<28} {}\n", printableName(name), printable(text));
  }
  if (shown < list.size()) fmt::print("  and {} more; see --all\n", list.size() - shown);
}

using ModelRow = std::pair<std::string, std::string>;

ModelRow rowOf(const ModelInfo::Node& node) {
  return {
      node.name,
      fmt::format("{:>7} triangles, {} m around ({})", inShort(node.triangles),
                  joined(rounded(vec3(node.bounds.size()), node.bounds), " x "),
                  joined(rounded(0.5f * (node.bounds.min + node.bounds.max), node.bounds), ", "))};
}

ModelRow rowOf(const ModelInfo::Material& m) {
  std::vector<std::string> words;
  for (const std::string& name : m.extensions)
    words.push_back(name.starts_with("KHR_materials_") ? name.substr(14) : name);
  if (m.emits) words.push_back("emits");
  if (m.alphaMode != "OPAQUE") words.push_back("alpha " + lowerCase(m.alphaMode));
  if (m.isDoubleSided) words.push_back("double-sided");
  if (m.textures > 0)
    words.push_back(fmt::format("{} texture{}", m.textures, m.textures == 1 ? "" : "s"));
  return {m.name, words.empty() ? "plain" : fmt::format("{}", fmt::join(words, ", "))};
}

ModelRow rowOf(const ModelInfo::Texture& t) {
  return {t.image, fmt::format("{} x {}, {}", t.width, t.height, megabytes(double(t.bytes)))};
}

ModelRow rowOf(const Camera& c) {
  const std::string lens = c.orthographic
                               ? fmt::format("orthographic, {:.4g} m high", 2 * c.halfHeight)
                               : fmt::format("{:.4g} degrees high", glm::degrees(c.fov));
  return {c.name, fmt::format("{}, at ({})", lens, joined(c.position, ", "))};
}

ModelRow rowOf(const PunctualLight& light) {
  const bool isDistant = light.kind == PunctualLight::Kind::Directional;
  return {light.name, fmt::format("{}, {} {}", lightKind(light), joined(light.intensity),
                                  isDistant ? "W/m^2" : "W/sr")};
}

ModelRow rowOf(const ModelInfo::Animation& a) {
  return {a.name, fmt::format("{:.4g} s, {} channels", a.seconds, a.channels)};
}

template <class Element>
void printSubject(std::string_view subject, const std::vector<Element>& list, bool all,
                  const std::string& more = "") {
  printSubjectLine(subject, list.empty() ? "none" : fmt::format("{}{}", list.size(), more));
  printList(list, all, [](const Element& element) { return rowOf(element); });
}

void printNodes(const ModelInfo& info, bool all) {
  std::vector<ModelInfo::Node> nodes;
  std::ranges::copy_if(info.nodes, std::back_inserter(nodes), hasTriangles);
  std::ranges::stable_sort(nodes, {}, &ModelInfo::Node::depth);
  printSubjectLine("nodes", fmt::format("{}, with triangles in or below them: {}",
                                        info.nodes.size(), nodes.size()));
  printList(nodes, all, [](const ModelInfo::Node& node) { return rowOf(node); });
}

void printExtensions(const ModelInfo& info) {
  std::vector<std::string> used, ignored;
  for (const auto& e : info.extensions) (e.isSupported ? used : ignored).push_back(e.name);
  printSubjectLine("extensions", used.empty() ? "none" : fmt::format("{}", fmt::join(used, ", ")));
  printSubjectLine("unsupported",
                   ignored.empty() ? "none" : fmt::format("{}", fmt::join(ignored, ", ")));
}

void print(const ModelInfo& info, const std::string& file, bool all) {
  const Scene& scene = info.scene;
  const Bounds box = bounds(scene);
  printSubjectLine(
      "file", fmt::format("{}: {} in {} file{}", file, megabytes(double(byteCountOf(scene.files))),
                          scene.files.size(), scene.files.size() == 1 ? "" : "s"));
  if (!info.generator.empty()) printSubjectLine("made by", info.generator);
  printSubjectLine("size", box.empty() ? "nothing to render"
                                       : fmt::format("{} m, from ({}) to ({})",
                                                     joined(rounded(vec3(box.size()), box), " x "),
                                                     joined(rounded(box.min, box), ", "),
                                                     joined(rounded(box.max, box), ", ")));
  printSubjectLine(
      "geometry",
      fmt::format("triangles {}, meshes {}, instances {}", inShort(scene.triangleCount()),
                  inShort(scene.meshes.size()), inShort(scene.instances.size())));
  printSubjectLine("memory",
                   fmt::format("geometry {}, textures {}", megabytes(geometryBytes(scene)),
                               megabytes(double(scene.texelByteCount()))));
  printNodes(info, all);
  const auto emitting = std::ranges::count_if(info.materials, &ModelInfo::Material::emits);
  printSubject("materials", info.materials, all,
               emitting > 0 ? fmt::format(", of which {} emit", emitting) : "");
  printSubject("textures", info.textures, all);
  printSubject("cameras", scene.cameras, all);
  printSubject("lamps", scene.lights, all);
  printSubject("animations", info.animations, all);
  printSubjectLine("variants", info.variants.empty() ? "none" : firstNames(info.variants));
  printSubjectLine("own probe", scene.environment ? "yes" : "none");
  printExtensions(info);
  for (const std::string& warning : info.warnings) printSubjectLine("warning", warning);
}

bool isProbe(const std::string& path) {
  if (std::filesystem::is_directory(path)) return !cubeFilesIn(path).empty();
  return std::filesystem::is_regular_file(path) && imageFormat(path) != ImageFormat::Unknown;
}

// What else the file may be, as the end of a message.
std::string_view otherKind(const std::string& path) {
  if (isProbe(path)) return "; see `chromeball probe info` for a light probe";
  return lowerExtension(path) == ".toml" ? ", but a scene file: `chromeball render` shows it, and "
                                           "`chromeball info` the models that it names"
                                         : "";
}

void run(const InfoArguments& a) {
  if (std::filesystem::exists(a.file) && !beginsAsGltf(a.file))
    throwInput("{}: is no glTF model (.gltf, .glb){}", a.file, otherKind(a.file));
  const ModelInfo info =
      modelInfo(a.file, a.allowsExternal ? ExternalFiles::Allow : ExternalFiles::Refuse);
  if (a.json)
    printJson(modelToJson(info, a.file));
  else
    print(info, a.file, a.all);
}

}  // namespace

void addInfoCommand(Command app) {
  auto [command, a] = app.addCommand<InfoArguments>(
      "info", "Show what is in a model: nodes, materials, cameras, lamps, animations.", run);
  command.addRequired("MODEL", a.file, "the model: .gltf or .glb");
  command.addFlag("--json", a.json, "print JSON, with all of every list");
  command.addFlag("--all", a.all, "print all of every list, and not its beginning");
  command.addFlag("--allow-external", a.allowsExternal,
                  "also read buffers and images outside the model's folder");
  command.footer(
      "A node's triangles and bounds are with those of all nodes below it, in the rest pose. "
      "Memory is that of a render: with the acceleration structure, and textures decoded.\n");
}

}  // namespace chromeball
