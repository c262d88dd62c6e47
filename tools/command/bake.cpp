// SPDX-License-Identifier: Apache-2.0
// chromeball bake SCENE -o MODEL_BAKED.glb: lightmaps and vertex colours for real-time viewers.
#include <filesystem>

#include "bake/baked_file.h"
#include "bake/shown_color.h"
#include "bake/texel_filter.h"
#include "bake/vertex_light.h"
#include "base/error.h"
#include "base/stopwatch.h"
#include "commands.h"
#include "image/io/write_image.h"
#include "job/arguments.h"
#include "job/job.h"
#include "job/memory_estimate.h"
#include "job/output_file.h"
#include "messages.h"
#include "progress_bar.h"
#include "scene_options.h"
#include "thread_limit.h"

namespace chromeball {
namespace {

constexpr int kMinPage = 16, kMaxPadding = 256;

struct Arguments : SceneOptions {
  std::string what = "irradiance", to = "lightmap", output;
  std::optional<int64_t> size, padding;
  std::optional<double> texel, scale;
  bool denoises = false, keepsNoise = false, keepsMaterials = false;

  bool toVertices() const { return to == "vertices"; }
  std::filesystem::path lightmapPath() const {
    return std::filesystem::path(output).replace_extension(".exr");
  }
};

template <size_t N>
size_t indexOf(const std::string& name, const char* const (&names)[N], const char* option) {
  const auto found = std::ranges::find(names, name);
  if (found == std::end(names))
    throwInput("{}: `{}` is not one of {}", option, name, fmt::join(names, ", "));
  return size_t(found - std::begin(names));
}

void checkRange(const char* option, const std::optional<int64_t>& number, int least, int most) {
  if (number && (*number < least || *number > most))
    throwInput("{}: should be a whole number from {} to {} (texels)", option, least, most);
}

void checkArguments(const Arguments& a) {
  constexpr const char* kTargets[] = {"lightmap", "vertices"};
  indexOf(a.what, kBakedLightNames, "--what");
  indexOf(a.to, kTargets, "--to");
  checkRange("--size", a.size, kMinPage, kMaxPage);
  checkRange("--padding", a.padding, 0, kMaxPadding);
  if (a.size && a.texel) throwInput("--texel: excludes --size; give one");
  if (a.texel && !(*a.texel > 0 && std::isfinite(*a.texel)))
    throwInput("--texel: should be a length above 0 (metres)");
  if (a.scale && !isPositiveFloat(*a.scale)) throwInput("--scale: should be {}", kPositiveFloats);
  if (a.scale && (a.what == "ambient-occlusion" || a.keepsMaterials))
    throwInput("--scale: is of colours that the file shows without light; leave it out");
  if (a.toVertices())
    for (const auto& [given, option] :
         {std::pair(a.size.has_value(), "--size"), std::pair(a.padding.has_value(), "--padding"),
          std::pair(a.texel.has_value(), "--texel"),
          std::pair(a.denoises || a.keepsNoise, "--denoise")})
      if (given) throwInput("{}: is for lightmaps; leave it out with --to vertices", option);
  if (a.settings.get<uint64_t>("render.samples") < 2) throwInput("--samples: should be 2 or more");
  checkOutputFile(a.output, {".glb", ".gltf"});
  if (!a.toVertices()) checkWritable(a.lightmapPath());
}

// The options of the ambient occlusion that is baked are not those of a render.
RenderJob plannedJob(const Arguments& a) {
  SceneFile scene = openScene(a.scene);
  if (scene.composite)
    throwInput("{}: a composite cannot be baked; bake its model", scene.composite->location);
  if (a.what == "ambient-occlusion" && !a.settings.has("probe.file"))
    scene.lamps.push_back({.ambient = AmbientLamp{}});  // it needs no light of the user's
  Settings settings = a.settings;
  settings.erase("render.ao_distance");
  return planJob(std::move(scene), settings);
}

BakeSettings bakeSettings(const Arguments& a, const RenderJob& job) {
  BakeSettings settings;
  settings.what = BakedLight(indexOf(a.what, kBakedLightNames, "--what"));
  settings.samples = job.settings.samples;
  settings.seed = job.settings.seed;
  settings.maxDepth = job.settings.maxDepth;
  if (const auto distance = a.settings.getIfGiven<double>("render.ao_distance"))
    settings.distance = float(*distance);
  return settings;
}

class Bake {
 public:
  explicit Bake(const Arguments& arguments)
      : arguments_(arguments),
        job_(plannedJob(arguments)),
        loaded_(loadScene(job_)),
        settings_(bakeSettings(arguments, job_)),
        meshes_(placedMeshes(loaded_.scene)) {
    checkDistinct({arguments.output, arguments.toVertices() ? "" : arguments.lightmapPath()},
                  loaded_.files);
  }

  void run() {
    arguments_.toVertices() ? bakeVertices() : bakeLightmap();
    report();
  }

 private:
  void bakeLightmap() {
    std::vector<Chart> charts;
    for (const PlacedMesh& placed : meshes_)
      for (Chart& chart : makeCharts(placed)) charts.push_back(std::move(chart));
    if (charts.empty()) refuseEmpty();
    const int padding = int(arguments_.padding.value_or(4));
    const Atlas atlas =
        arguments_.texel ? atlasOfTexels(charts, *arguments_.texel, padding, "--texel")
                         : fitAtlas(charts, int(arguments_.size.value_or(1024)), padding, "--size");
    checkPageMemory(atlas.size);
    const std::vector<BakePoint> points = texelPoints(meshes_, charts, atlas);
    const BakeResult baked = bakePoints(points);
    std::vector<Rgb> light(points.size());
    if (!arguments_.keepsNoise)
      light = filteredLight(points, baked, atlas.size);
    else
      for (size_t i = 0; i < points.size(); ++i) light[i] = baked.points[i].mean();
    const Lightmap map = makeLightmap(*light_, points, baked, light, atlas);

    BakedFile file = bakedFile();
    if (!arguments_.scale) file.scale = scaleOf(largestOf(map.shown.texels));
    const std::filesystem::path path = arguments_.lightmapPath();
    describe(file, baked);
    file.extras["chromeball"]["lightmap"] = path.filename().string();
    file.extras["chromeball"]["texelsPerMetre"] = atlas.density;
    writeImage(path, OutputImage{{{"", "RGB", map.light}}, {{"baked", arguments_.what}}, {}, {}});
    writeBaked(arguments_.output, loaded_.scene, lightmappedGeometry(meshes_, charts, atlas),
               pageOf(map, file), file);
    summary_ =
        fmt::format("{} charts, {} texels of {:.3g} m, scale {:g}: {}, {}", charts.size(),
                    points.size(), 1 / atlas.density, file.scale, arguments_.output, path.string());
  }

  void bakeVertices() {
    const std::vector<BakePoint> points = vertexPoints(meshes_);
    if (points.empty()) refuseEmpty();
    const BakeResult baked = bakePoints(points);
    std::vector<BakedGeometry> geometry = colouredGeometry(*light_, meshes_, points, baked);
    BakedFile file = bakedFile();
    float largest = 0;
    for (const BakedGeometry& part : geometry)
      for (const vec4& color : part.colors) largest = std::max(largest, maxComponent(Rgb(color)));
    if (!arguments_.scale) file.scale = scaleOf(largest);
    if (arguments_.keepsMaterials)
      for (BakedGeometry& part : geometry) part.colors.clear();
    describe(file, baked);
    writeBaked(arguments_.output, loaded_.scene, geometry, {}, file);
    summary_ =
        fmt::format("{} vertices, scale {:g}: {}", points.size(), file.scale, arguments_.output);
  }

  BakeResult bakePoints(const std::vector<BakePoint>& points) {
    prepared_ = prepareScene(job_, loaded_);
    tracer_.emplace(*prepared_.world, *prepared_.lighting, PathSettings{});
    light_.emplace(*tracer_, settings_.what, settings_.distance);
    print(loaded_.messages, arguments_.quiet());  // after the last error that input can cause
    ProgressBar bar(arguments_.showsProgress(), "baking");
    BakeResult baked = bake(*prepared_.world, *prepared_.lighting, meshes_, points, settings_,
                            [&](double fraction) { bar.update(fraction); });
    if (baked.invalid.total() > 0)
      warn(fmt::format("{} invalid samples were left out; the first is of {} {}, {}",
                       baked.invalid.total(), arguments_.toVertices() ? "vertex" : "texel",
                       baked.invalid.x, baked.invalid.y));
    return baked;
  }

  BakedFile bakedFile() const {
    BakedFile file;
    file.look = arguments_.keepsMaterials                        ? BakedLook::Lit
                : settings_.what == BakedLight::AmbientOcclusion ? BakedLook::Occluded
                                                                 : BakedLook::Unlit;
    file.what = settings_.what;
    file.scale = float(arguments_.scale.value_or(1));
    file.origin = loaded_.origin;
    file.camera = loaded_.camera;
    file.aspect = float(job_.settings.width) / float(job_.settings.height);
    return file;
  }

  void describe(BakedFile& file, const BakeResult& baked) const {
    GltfDocument::Json& extras = file.extras["chromeball"];
    extras = {{"baked", arguments_.what},
              {"to", arguments_.to},
              {"scale", file.scale},
              {"samples", settings_.samples},
              {"maxDepth", settings_.maxDepth},
              {"seed", settings_.seed},
              {"invalidSamples", baked.invalid.total()}};
    if (const auto probe = job_.file.settings.getIfGiven<std::string>("probe.file"))
      extras["probe"] = std::filesystem::path(*probe).filename().string();
  }

  static float largestOf(const std::vector<float>& rgba) {
    float largest = 0;
    for (size_t i = 0; i < rgba.size(); ++i)
      if (i % 4 != 3) largest = std::max(largest, rgba[i]);
    return largest;
  }

  [[noreturn]] void refuseEmpty() const {
    throwInput("{}: has no triangle with an area; there is nothing to bake", arguments_.scene);
  }

  // Pages as floats and bytes, and what is kept of each texel's point.
  void checkPageMemory(int size) const {
    constexpr double kBytesPerTexel = 7 * sizeof(float) + 20 + sizeof(BakePoint) +
                                      sizeof(PointResult) + 2 * sizeof(Rgb) + sizeof(int);
    const double needed = kBytesPerTexel * size * size + estimateMemory(job_, loaded_).peak;
    if (needed > memoryLimit(job_))
      throw InputError(
          fmt::format("{}: a page of {} x {} texels takes {:.3g} GB of memory with all "
                      "else; the limit is {:.3g} GB",
                      arguments_.texel ? "--texel" : "--size", size, size, 1e-9 * needed,
                      1e-9 * memoryLimit(job_)),
          Remedy{"memory", {}});
  }

  void report() const {
    for (const Instance& instance : loaded_.scene.instances)
      if (const Material& m = loaded_.scene.materials[size_t(instance.material)];
          m.extended && bakedFile().look != BakedLook::Unlit) {
        warn(fmt::format("{}: material `{}` has extensions that the baked model lacks",
                         arguments_.output, m.name));
        break;
      }
    if (!arguments_.quiet())
      fmt::print("baked {} in {:.2f} s, {} samples: {}\n", arguments_.what, watch_.seconds(),
                 settings_.samples, summary_);
  }

  const Arguments& arguments_;
  Stopwatch watch_;
  RenderJob job_;
  LoadedScene loaded_;
  BakeSettings settings_;
  std::vector<PlacedMesh> meshes_;
  PreparedScene prepared_;
  std::optional<PathTracer> tracer_;
  std::optional<PointLight> light_;
  std::string summary_;
};

void run(const Arguments& arguments) {
  checkArguments(arguments);
  const ThreadLimit threads(arguments.settings);
  Bake(arguments).run();
}

}  // namespace

void addBakeCommand(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "bake", "Bake light into a lightmap or vertex colours, for real-time viewers");
  addSceneOptions(*command, *arguments, SceneCommand::Bake);
  command
      ->add_option(
          "-o,--output", arguments->output,
          "the model to write: .glb or .gltf; a lightmap is also written as .exr beside it")
      ->required();
  command
      ->add_option("--what", arguments->what,
                   "irradiance, ambient-occlusion, or radiance along the normal")
      ->capture_default_str();
  command->add_option("--to", arguments->to, "lightmap (TEXCOORD_1) or vertices (COLOR_0)")
      ->capture_default_str();
  command->add_option("--size", arguments->size,
                      "of the lightmap, in texels along an edge, up to 16384; 1024 by default");
  command->add_option("--texel", arguments->texel,
                      "in place of --size: metres along the edge of a texel");
  command->add_option("--padding", arguments->padding, "texels around each chart; 4 by default");
  command->add_option("--scale", arguments->scale,
                      "the light that the file's white stands for; by default a power of two, so "
                      "that nothing is clipped");
  CLI::Option* denoises = command->add_flag("--denoise", arguments->denoises,
                                            "remove noise from lightmaps: the default");
  command->add_flag("--no-denoise", arguments->keepsNoise, "do not")->excludes(denoises);
  command->add_flag("--keep-materials", arguments->keepsMaterials,
                    "write the model's own materials; engines take the light from the .exr or from "
                    "_IRRADIANCE of the vertices");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace chromeball
