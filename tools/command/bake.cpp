// SPDX-License-Identifier: Apache-2.0
// chromeball bake SCENE -o MODEL_BAKED.glb: lightmaps and vertex colours for real-time viewers.
#include <filesystem>

#include "bake/baked_file.h"
#include "bake/lightmap.h"
#include "bake/vertex_light.h"
#include "bake_options.h"
#include "base/error.h"
#include "base/progress.h"
#include "commands.h"
#include "front/plan_render.h"
#include "heeded_settings.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "messages.h"
#include "progress_bar.h"
#include "session/memory_estimate.h"
#include "session/render_loaded.h"
#include "thread_limit.h"

namespace chromeball {
namespace {

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
  return planRender(std::move(scene), settings);
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
        meshes_(placedMeshes(loaded_.scene)) {
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
    print(loaded_.messages, options_.quiet());  // after the last error that input can cause
    ProgressBar bar(options_.showsProgress(), "baking");
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
    const double needed = kBytesPerTexel * size * size + estimateMemory(loaded_).peak;
    if (needed > memoryLimit(loaded_.description))
      throw InputError(fmt::format("{}: a page of {} x {} texels takes {:.3g} GB of memory with "
                                   "all else; the limit is {:.3g} GB",
                                   options_.texel ? "--texel" : "--size", size, size, 1e-9 * needed,
                                   1e-9 * memoryLimit(loaded_.description)),
                       Remedy{"memory", {}});
  }

  void report() const {
    for (const Instance& instance : loaded_.scene.instances)
      if (const Material& m = loaded_.scene.materials[size_t(instance.material)];
          m.extended && bakedFile().look != BakedLook::Unlit) {
        warn("{}: material `{}` has extensions that the baked model lacks", options_.output,
             m.name);
        break;
      }
    if (!options_.quiet())
      fmt::print("baked {} in {:.2f} s, {} samples: {}\n", options_.what, watch_.seconds(),
                 settings_.samples, summary_);
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

void run(const BakeOptions& options) {
  checkBakeOptions(options);
  const ThreadLimit threads = threadLimit(options.settings);
  Bake(options).run();
}

}  // namespace

void addBakeCommand(Command app) {
  auto [command, a] = app.addCommand<BakeOptions>(
      "bake", "Bake light into a lightmap or vertex colours, for real-time viewers", run);
  addBakeOptions(command, a);
}

}  // namespace chromeball
