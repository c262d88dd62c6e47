#include "scene/scene_file.h"

#include <toml++/toml.h>
#include <cfloat>
#include <climits>
#include <filesystem>
#include <functional>

#include "image/file.h"
#include "math/error.h"
#include "math/suggest.h"

namespace chromeball {
namespace {

constexpr size_t kMaxFileBytes = size_t(4) << 20;

template <class... Args>
[[noreturn]] void failAt(const std::string& place, fmt::format_string<Args...> format,
                         Args&&... args) {
  std::string what = fmt::format(format, std::forward<Args>(args)...);
  for (char& c : what)
    if (uint8_t(c) < ' ') c = '?';  // a quoted key may hold a line break; an error is one line
  throwInput("{}: {}", place, what);
}

// One value of the file with what an error about it has to say.
struct Entry {
  const std::string& file;
  std::string key;
  const toml::node* node;  // nullptr: the file does not give it

  explicit operator bool() const { return node; }
  std::string place() const { return fmt::format("{}:{}", file, node->source().begin.line); }

  [[noreturn]] void mustBe(std::string_view what) const {
    std::string found;
    if (node->is_integer())
      found = fmt::format("{}", node->as_integer()->get());
    else if (node->is_floating_point())
      found = fmt::format("{}", node->as_floating_point()->get());
    else if (node->is_string())
      found = fmt::format("\"{}\"", node->as_string()->get());
    else if (node->is_array())
      found = fmt::format("an array of {}", node->as_array()->size());
    else if (node->is_table())
      found = "a table";
    else if (node->is_boolean())
      found = "a boolean";
    else
      found = "a date or time";
    failAt(place(), "`{}` must be {}, not {}", key, what, found);
  }

  Entry element(size_t i) const { return {file, key, node->as_array()->get(i)}; }
  bool isArrayOf(size_t count) const {
    return node->is_array() && node->as_array()->size() == count;
  }

  std::string text() const {
    if (!node->is_string() || node->as_string()->get().empty()) mustBe("a string");
    return node->as_string()->get();
  }
  NamedSetting name() const { return {text(), place()}; }

  int64_t integer(int64_t least, int64_t most) const {
    const auto* number = node->as_integer();
    if (!number || number->get() < least || number->get() > most)
      mustBe(fmt::format("a whole number from {} to {}", least, most));
    return number->get();
  }

  // A finite number that a float can hold.
  double number(std::string_view what, const std::function<bool(double)>& valid) const {
    const auto number = node->is_number() ? node->value<double>() : std::nullopt;
    if (!number || !(std::abs(*number) <= FLT_MAX) || !valid(*number)) mustBe(what);
    return *number;
  }
  float number() const {
    return float(number("a finite number", [](double) { return true; }));
  }
  double positive() const {
    return number("a finite number above 0", [](double x) { return x > 0; });
  }

  vec3 vector() const {
    if (!isArrayOf(3)) mustBe("three numbers");
    return {element(0).number(), element(1).number(), element(2).number()};
  }
};

// A table that knows all its keys.
class Section {
 public:
  Section(const std::string& file, std::string name, const toml::table& table,
          const std::vector<std::string_view>& keys)
      : file_(file), name_(std::move(name)), table_(table) {
    for (const auto& [key, node] : table)
      if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
        failAt(fmt::format("{}:{}", file, key.source().begin.line), "unknown key `{}`{}; {}",
               key.str(), name_.empty() ? "" : " in [" + name_ + "]", didYouMean(key.str(), keys));
  }

  Entry operator[](std::string_view key) const {
    return {file_, std::string(key), table_.get(key)};
  }
  std::string place() const { return fmt::format("{}:{}", file_, table_.source().begin.line); }

  Section section(std::string_view key, const std::vector<std::string_view>& keys) const {
    static const toml::table kEmpty;
    const Entry entry = (*this)[key];
    if (entry && !entry.node->is_table()) entry.mustBe("a table");
    return Section(file_, std::string(key), entry ? *entry.node->as_table() : kEmpty, keys);
  }

 private:
  const std::string& file_;
  std::string name_;
  const toml::table& table_;
};

// As the user would write it from where the program runs.
std::string resolved(const Entry& entry) {
  const auto folder = std::filesystem::path(entry.file).parent_path();
  return (folder / entry.text()).lexically_normal().string();
}

std::string existing(const Entry& entry) {
  const std::string path = resolved(entry);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    failAt(entry.place(), "`{}`: no such file: {} (paths are relative to the scene file)",
           entry.key, path);
  return path;
}

glm::quat readRotation(const Entry& entry) {
  if (entry.isArrayOf(4)) {
    const glm::quat q(entry.element(3).number(), entry.element(0).number(),
                      entry.element(1).number(), entry.element(2).number());
    if (!(glm::length(q) > 1e-6f) || !std::isfinite(glm::length(q)))
      entry.mustBe("a quaternion x, y, z, w of a length above 0");
    return glm::normalize(q);
  }
  if (!entry.isArrayOf(3)) entry.mustBe("three angles in degrees or a quaternion x, y, z, w");
  const vec3 angles = glm::radians(entry.vector());
  return glm::angleAxis(angles.z, vec3(0, 0, 1)) * glm::angleAxis(angles.y, vec3(0, 1, 0)) *
         glm::angleAxis(angles.x, vec3(1, 0, 0));
}

vec3 readScale(const Entry& entry) {
  const vec3 scale = entry.node->is_array() ? entry.vector() : vec3(entry.number());
  if (scale.x * scale.y * scale.z == 0) entry.mustBe("other than 0");
  return scale;
}

ModelEntry readModel(const Entry& entry) {
  if (entry.node->is_string()) return {existing(entry), {}, {}};
  if (!entry.node->is_table()) entry.mustBe("a file name or a table");
  const Section model(entry.file, "model", *entry.node->as_table(),
                      {"file", "translation", "rotation", "scale", "animation", "time", "variant"});
  if (!model["file"]) failAt(model.place(), "[model] has no `file`");

  ModelEntry result{existing(model["file"]), {}, {}};
  Transform& placement = result.placement;
  if (const Entry e = model["rotation"]) placement.linear = glm::mat3_cast(readRotation(e));
  if (const Entry e = model["scale"]) {
    const vec3 scale = readScale(e);
    for (int axis = 0; axis < 3; ++axis) placement.linear[axis] *= scale[axis];
  }
  if (const Entry e = model["translation"]) placement.translation = e.vector();
  const Entry animation = model["animation"], time = model["time"];
  if (animation || time) {
    AnimationTime& when = result.choice.animation.emplace();
    when.place = (animation ? animation : time).place();
    if (animation) when.name = animation.text();
    if (time) when.seconds = time.number();
  }
  if (const Entry e = model["variant"]) result.choice.variant = {e.text(), e.place()};
  return result;
}

void readLens(const Section& camera, SceneFile& scene) {
  const Entry aperture = camera["aperture"], focus = camera["focus"];
  if (!aperture && !focus) return;
  if (!aperture || !focus)
    failAt((aperture ? aperture : focus).place(),
           "`aperture` (the lens's diameter) and `focus` (a distance) go together, in metres");
  scene.lens = {float(aperture.positive()), float(focus.positive()), aperture.place()};
}

void readCamera(const Section& camera, SceneFile& scene) {
  readLens(camera, scene);
  const Entry name = camera["name"], position = camera["position"], target = camera["look_at"];
  if (name) {
    for (const char* key : {"position", "look_at", "up", "fov", "orthographic"})
      if (const Entry e = camera[key])
        failAt(e.place(), "[camera] has `name`, a camera of the model; it cannot have `{}` too",
               key);
    scene.cameraName = name.name();
    return;
  }
  const Entry orthographic = camera["orthographic"];
  if (!position && !target && !camera["up"] && !camera["fov"] && !orthographic) return;
  if (!position || !target)
    failAt(camera.place(), "[camera] needs `name`, or both `position` and `look_at`");

  const vec3 from = position.vector(), to = target.vector();
  const Entry upEntry = camera["up"], fovEntry = camera["fov"];
  if (orthographic && fovEntry)
    failAt(fovEntry.place(), "[camera] is `orthographic`; it has no `fov`");
  const vec3 up = upEntry ? upEntry.vector() : vec3(0, 1, 0);
  const float fov = fovEntry ? glm::radians(float(fovEntry.number(
                                   "degrees between 0 and 180",
                                   [](double degrees) { return degrees > 0 && degrees < 180; })))
                             : Camera().fov;
  try {
    scene.camera = Camera::lookAt(from, to, up, fov);
  } catch (const InputError& error) {
    failAt(camera.place(), "{}", error.what());
  }
  if (orthographic) {
    scene.camera->orthographic = true;
    scene.camera->halfHeight = 0.5f * float(orthographic.positive());
  }
}

void readProbe(const Section& probe, SceneFile& scene) {
  if (const Entry e = probe["file"]) scene.probe = existing(e);
  if (const Entry e = probe["mapping"]) scene.probeMapping = e.name();
  if (const Entry e = probe["rotation"]) scene.probeRotation = e.number();
  if (const Entry e = probe["scale"])
    scene.probeScale =
        float(e.number("a finite number, 0 or above", [](double x) { return x >= 0; }));
}

void readRender(const Section& render, SceneFile& scene) {
  if (const Entry e = render["size"]) {
    if (!e.isArrayOf(2)) e.mustBe("[width, height]");
    scene.size = {int(e.element(0).integer(1, 65536)), int(e.element(1).integer(1, 65536))};
  }
  if (const Entry e = render["samples"]) scene.samples = int(e.integer(1, INT_MAX));
  if (const Entry e = render["max_depth"]) scene.maxDepth = int(e.integer(0, INT_MAX));
  if (const Entry e = render["seed"]) scene.seed = uint64_t(e.integer(0, INT64_MAX));
  if (const Entry e = render["time"]) scene.timeLimit = e.positive();
  if (const Entry e = render["noise"]) scene.noiseLimit = e.positive();
}

// A value, or an array of such values, one at a time.
template <class Read>
void forEach(const Entry& entry, const Read& read) {
  if (!entry) return;
  if (!entry.node->is_array()) return read(entry);
  for (size_t i = 0; i < entry.node->as_array()->size(); ++i) read(entry.element(i));
}

toml::table parse(const std::string& path) {
  checkReadable(path);
  if (const auto bytes = std::filesystem::file_size(path); bytes > kMaxFileBytes)
    throwInput("{}: {} bytes; a scene file has at most {}", path, bytes, kMaxFileBytes);
  const std::vector<uint8_t> bytes = readFile(path);
  try {
    return toml::parse(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
                       path);
  } catch (const toml::parse_error& error) {
    failAt(fmt::format("{}:{}", path, error.source().begin.line), "not valid TOML: {}",
           error.description());
  }
}

}  // namespace

SceneFile readSceneFile(const std::string& path) {
  const toml::table table = parse(path);
  if (const toml::node* composite = table.get("composite"))
    failAt(fmt::format("{}:{}", path, composite->source().begin.line),
           "[composite] (differential rendering) is not supported yet; take the section out");
  const Section root(path, "", table, {"model", "camera", "probe", "lighting", "render", "output"});

  SceneFile scene;
  forEach(root["model"], [&](const Entry& e) { scene.models.push_back(readModel(e)); });
  if (scene.models.empty()) throwInput("{}: no `model`; name a .gltf or .glb file", path);
  readCamera(root.section("camera", {"name", "position", "look_at", "up", "fov", "orthographic",
                                     "aperture", "focus"}),
             scene);
  readProbe(root.section("probe", {"file", "mapping", "rotation", "scale"}), scene);
  const Section lighting = root.section("lighting", {"strategy", "mis"});
  if (const Entry e = lighting["strategy"]) scene.strategy = e.name();
  if (const Entry e = lighting["mis"]) scene.mis = e.name();
  readRender(root.section("render", {"size", "samples", "max_depth", "seed", "time", "noise"}),
             scene);
  const Section output = root.section("output", {"file", "aovs"});
  forEach(output["file"], [&](const Entry& e) { scene.outputs.push_back(resolved(e)); });
  forEach(output["aovs"], [&](const Entry& e) { scene.aovs.push_back(e.name()); });
  return scene;
}

}  // namespace chromeball
