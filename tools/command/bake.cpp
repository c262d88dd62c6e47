// SPDX-License-Identifier: Apache-2.0
// chromeball bake SCENE -o MODEL_BAKED.glb: lightmaps and vertex colours for real-time viewers.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "bake/atlas.h"
#include "bake/bake.h"
#include "bake/baked_file.h"
#include "bake/lightmap.h"
#include "bake/vertex_light.h"
#include "base/error.h"
#include "base/progress.h"
#include "base/text.h"
#include "commands.h"
#include "front/arguments.h"
#include "front/plan_render.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "messages.h"
#include "progress_bar.h"
#include "scene_options.h"
#include "session/memory_estimate.h"
#include "session/render_loaded.h"

namespace chromeball {
namespace {

constexpr int kMinPage = 16, kMaxPadding = 256;

template <size_t N>
size_t indexOf(const std::string& name, const char* const (&names)[N], const char* option) {
  const auto found = std::ranges::find(names, name);
  if (found == std::end(names))
    throwInput("{}: `{}` is not one of {}", option, name, fmt::join(names, ", "));
  return size_t(found - std::begin(names));
}

void checkTexels(const char* option, const std::optional<int64_t>& number, int least, int most) {
  if (number && (*number < least || *number > most))
    throwInput("{}: should be a whole number from {} to {} (texels)", option, least, most);
}

struct BakeOptions : SceneOptions {
  std::string what = "irradiance", to = "lightmap", output;
  std::optional<int64_t> size, padding;  // texels
  std::optional<double> texel;           // metres
  std::optional<double> scale;           // the light that white stands for
  bool denoises = false, keepsNoise = false, keepsMaterials = false;

  bool toVertices() const { return to == "vertices"; }
  // Throws InputError for an unknown name.
  BakedLight light() const { return BakedLight(indexOf(what, kBakedLightNames, "--what")); }
  std::filesystem::path lightmapPath() const {
    return std::filesystem::path(output).replace_extension(".exr");
  }
};

// Values out of range, options that exclude each other, and outputs that cannot be written.
void check(const BakeOptions& a, const Command& command) {
  constexpr const char* kTargets[] = {"lightmap", "vertices"};
  const BakedLight what = a.light();
  indexOf(a.to, kTargets, "--to");
  checkTexels("--size", a.size, kMinPage, kMaxPage);
  checkTexels("--padding", a.padding, 0, kMaxPadding);
  if (a.size && a.texel) throwInput("--texel: excludes --size; give one");
  if (a.texel && !(*a.texel > 0 && std::isfinite(*a.texel)))
    throwInput("--texel: should be a length above 0 (metres)");
  if (a.scale && !isPositiveFloat(*a.scale)) throwInput("--white: should be {}", kPositiveFloats);
  if (a.scale && (what == BakedLight::AmbientOcclusion || a.keepsMaterials))
    throwInput("--white: is of colours that the file shows without light; leave it out");
  if (a.toVertices())
    command.refuse({"--size", "--padding", "--texel", "--denoise", "--no-denoise"},
                   "is for lightmaps; leave it out with --to vertices");
  if (a.settings.has("render.ao_distance") && a.what != "ambient-occlusion")
    throwInput("--ao-distance: is for --what ambient-occlusion");
  if (a.settings.get<uint64_t>("render.samples") < 2) throwInput("--samples: should be 2 or more");
  checkOutputFile(a.output, {".glb", ".gltf"});
  if (!a.toVertices()) checkWritable(a.lightmapPath());
}

// Takes the distance of ambient occlusion out of the settings: it is the map's, not a layer's.
std::optional<double> takeDistance(SceneFile& scene, Settings& settings) {
  constexpr std::string_view kName = "render.ao_distance";
  std::optional<double> distance = settings.getIfGiven<double>(kName);
  if (!distance) distance = scene.settings.getIfGiven<double>(kName);
  settings.erase(kName);
  scene.settings.erase(kName);
  return distance;
}

// `distance`: output, of ambient occlusion.
RenderDescription plannedRender(const BakeOptions& a, std::optional<double>& distance) {
  SceneFile scene = openScene(a.scene);
  if (scene.composite)
    throwInput("{}: a composite cannot be baked; bake its model",
               scene.origins.of("composite.entry"));
  Settings settings = a.settings;
  const bool isOcclusion = a.light() == BakedLight::AmbientOcclusion;
  if (isOcclusion) distance = takeDistance(scene, settings);
  dropUnheeded(scene, SceneCommand::Bake);
  if (isOcclusion) dropLight(scene, settings);
  RenderDescription description = planRender(std::move(scene), settings);
  description.run.makesImage = false;
  return description;
}

BakeSettings bakeSettings(const BakeOptions& a, const RenderDescription& description,
                          std::optional<double> distance) {
  BakeSettings settings;
  settings.what = a.light();
  settings.samples = description.settings.samples;
  settings.seed = description.settings.seed;
  settings.maxDepth = description.settings.maxDepth;
  settings.mis = description.settings.mis;
  if (distance) settings.distance = float(*distance);
  return settings;
}

class Bake {
 public:
  explicit Bake(const BakeOptions& options)
      : options_(options),
        loaded_(loadScene(plannedRender(options, distance_))),
        settings_(bakeSettings(options, loaded_.description, distance_)),
        meshes_(placedWithinMemory(loaded_)) {
    checkDistinct({options.output, options.toVertices() ? "" : options.lightmapPath()},
                  loaded_.files);
  }

  void run() {
    options_.toVertices() ? bakeVertices() : bakeLightmap();
    report();
  }

 private:
  void bakeLightmap() {
    std::vector<Chart> charts;
    for (const PlacedMesh& placed : meshes_)
      for (Chart& chart : makeCharts(placed)) charts.push_back(std::move(chart));
    if (charts.empty()) refuseEmpty();
    const int padding = int(options_.padding.value_or(4));
    const Atlas atlas =
        options_.texel ? atlasOfTexels(charts, *options_.texel, padding, "--texel")
                       : fitAtlas(charts, int(options_.size.value_or(1024)), padding, "--size");
    checkPageMemory(atlas.size);
    const std::vector<BakePoint> points = texelPoints(meshes_, charts, atlas);
    const BakeResult baked = bakePoints(points);
    std::vector<Rgb> light(points.size());
    if (!options_.keepsNoise)
      light = filteredLight(points, baked, atlas.size);
    else
      for (size_t i = 0; i < points.size(); ++i) light[i] = baked.points[i].mean();
    const Lightmap map = makeLightmap(*light_, points, baked, light, atlas);

    BakedFile file = bakedFile();
    if (!options_.scale) file.scale = scaleOf(map.brightest);
    const std::filesystem::path path = options_.lightmapPath();
    describe(file, baked);
    file.extras["chromeball"]["lightmap"] = path.filename().string();
    file.extras["chromeball"]["texelsPerMetre"] = atlas.density;
    print(writeImage(path,
                     OutputImage{{{"", "RGB", map.light}}, {{"baked", options_.what}}, {}, {}}));
    writeBaked(options_.output, loaded_.scene, lightmappedGeometry(meshes_, charts, atlas),
               pageOf(map, file), file);
    summary_ =
        fmt::format("{} charts, {} texels of {:.3g} m, scale {:g}: {}, {}", charts.size(),
                    points.size(), 1 / atlas.density, file.scale, options_.output, path.string());
  }

  void bakeVertices() {
    const std::vector<BakePoint> points = vertexPoints(meshes_);
    if (points.empty()) refuseEmpty();
    const BakeResult baked = bakePoints(points);
    std::vector<BakedGeometry> geometry = colouredGeometry(*light_, meshes_, points, baked);
    BakedFile file = bakedFile();
    if (!options_.scale) file.scale = scaleOf(brightestOf(*light_, geometry));
    if (options_.keepsMaterials)
      for (BakedGeometry& part : geometry) part.colors.clear();
    describe(file, baked);
    writeBaked(options_.output, loaded_.scene, geometry, {}, file);
    summary_ =
        fmt::format("{} vertices, scale {:g}: {}", points.size(), file.scale, options_.output);
  }

  BakeResult bakePoints(const std::vector<BakePoint>& points) {
    prepared_ = prepareScene(loaded_);
    tracer_.emplace(*prepared_.world, *prepared_.lighting, PathSettings{});
    light_.emplace(*tracer_, settings_.what, settings_.distance);
    print(loaded_.messages);  // after the last error that input can cause
    ProgressBar bar(progressStyle(), "baking");
    BakeResult baked = bake(*prepared_.world, *prepared_.lighting, meshes_, points, settings_,
                            [&](double fraction) { bar.update(fraction); });
    if (baked.invalid.total() > 0)
      warn("{} invalid samples were left out; the first is of {} {}, {}", baked.invalid.total(),
           options_.toVertices() ? "vertex" : "texel", baked.invalid.x, baked.invalid.y);
    return baked;
  }

  BakedFile bakedFile() const {
    BakedFile file;
    file.look = options_.keepsMaterials                          ? BakedLook::Lit
                : settings_.what == BakedLight::AmbientOcclusion ? BakedLook::Occluded
                                                                 : BakedLook::Unlit;
    file.what = settings_.what;
    file.scale = float(options_.scale.value_or(1));
    file.origin = loaded_.origin;
    file.camera = loaded_.camera;
    file.aspect =
        float(loaded_.description.settings.width) / float(loaded_.description.settings.height);
    return file;
  }

  void describe(BakedFile& file, const BakeResult& baked) const {
    GltfDocument::Json& extras = file.extras["chromeball"];
    extras = {{"baked", options_.what},
              {"to", options_.to},
              {"scale", file.scale},
              {"samples", settings_.samples},
              {"maxDepth", settings_.maxDepth},
              {"seed", settings_.seed},
              {"invalidSamples", baked.invalid.total()}};
    if (const auto& probe = loaded_.description.probe.file)
      extras["probe"] = std::filesystem::path(*probe).filename().string();
  }

  [[noreturn]] void refuseEmpty() const {
    throwInput("{}: has no triangle with an area; there is nothing to bake", options_.scene);
  }

  // Pages as floats and bytes, and the data kept for each texel's point.
  void checkPageMemory(int size) const {
    constexpr double kBytesPerTexel = 7 * sizeof(float) + 20 + sizeof(BakePoint) +
                                      sizeof(PointResult) + 2 * sizeof(Rgb) + sizeof(int);
    checkMemoryWithScene(loaded_, kBytesPerTexel * size * size,
                         fmt::format("{}: a page of {} x {} texels takes",
                                     options_.texel ? "--texel" : "--size", size, size));
  }

  void report() const {
    for (const Instance& instance : loaded_.scene.instances)
      if (const Material& m = loaded_.scene.materials[size_t(instance.material)];
          m.extended && bakedFile().look != BakedLook::Unlit) {
        warn("{}: material `{}` has extensions that the baked model lacks", options_.output,
             m.name);
        break;
      }
    say("baked {} in {:.2f} s, {} samples: {}\n", options_.what, watch_.seconds(),
        settings_.samples, printable(summary_));
  }

  const BakeOptions& options_;
  Stopwatch watch_;
  std::optional<double> distance_;  // set by the next one's initialisation
  LoadedScene loaded_;
  BakeSettings settings_;
  std::vector<PlacedMesh> meshes_;
  PreparedScene prepared_;
  std::optional<PathTracer> tracer_;
  std::optional<PointLight> light_;
  std::string summary_;
};

void run(const BakeOptions& options, const Command& command) {
  check(options, command);
  const ThreadLimit threads = threadLimit(options.settings);
  Bake(options).run();
}

}  // namespace

void addBakeCommand(Command app) {
  auto [command, a] = app.addCommand<BakeOptions>(
      "bake", "Bake light into a lightmap or vertex colours, for real-time viewers", run);
  command.addOption("--white,--scale", a.scale,
                    "the light that the file's white stands for; by default a power of two that "
                    "clips only what emits");
  addSceneOptions(command, a, SceneCommand::Bake);
  command.addRequired(
      "-o,--output", a.output,
      "the model to write: .glb or .gltf; a lightmap is also written as .exr beside it");
  command.addWithDefault("--what", a.what,
                         "irradiance, ambient-occlusion, or radiance along the normal");
  command.addWithDefault("--to", a.to, "lightmap (TEXCOORD_1) or vertices (COLOR_0)");
  command.addOption("--size", a.size,
                    "of the lightmap, in texels along an edge, up to 16384; 1024 by default");
  command.addOption("--texel", a.texel, "in place of --size: metres along the edge of a texel");
  command.addOption("--padding", a.padding, "texels around each chart; 4 by default");
  Option denoises =
      command.addFlag("--denoise", a.denoises, "remove noise from lightmaps: the default");
  command.addFlag("--no-denoise", a.keepsNoise, "do not").excludes(denoises);
  command.addFlag("--keep-materials", a.keepsMaterials,
                  "write the model's own materials; engines take the light from the .exr or from "
                  "_IRRADIANCE of the vertices");
}

}  // namespace chromeball
