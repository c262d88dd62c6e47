// SPDX-License-Identifier: Apache-2.0
#include "session/render_loaded.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>

#include "approximate/irradiance_cache.h"
#include "base/archive.h"
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/progress.h"
#include "session/image_header.h"
#include "session/memory_estimate.h"
#include "session/run_composite.h"
#include "session/scene_lighting.h"
#include "transport/light_groups.h"

namespace chromeball {
namespace {

// The irradiance cache of a render, and the file that keeps it for later ones (--cache).

// The file: magic, checksum of the rest, identity, records. In the byte order of the machine.
constexpr std::array<char, 16> kCacheMagic{'c', 'h', 'r', 'o', 'm', 'e', 'b', 'a',
                                           'l', 'l', ' ', 'c', 'a', 'c', 'h', 'e'};
constexpr size_t kCacheHeader = kCacheMagic.size() + sizeof(uint64_t);

class CacheFile {
 public:
  // The cache of a description with RenderSettings::cacheError. Reads its file if it exists. Throws
  // InputError if the file is damaged or belongs to another scene or light, and wherever
  // checkReplaceable() does.
  explicit CacheFile(const LoadedScene& loaded);

  IrradianceCache& cache() { return cache_; }

  // Replaces the file, if the description has one and there are new records. Throws RunError.
  void write();

 private:
  void read();

  IrradianceCache cache_;
  std::optional<std::string> path_;
  std::string identity_;  // of scene and light
  size_t inFile_ = 0;     // records
};

CacheFile::CacheFile(const LoadedScene& loaded)
    : cache_(loaded.description.settings.cacheError.value()), path_(loaded.description.run.cache) {
  if (!path_) return;
  checkReplaceable(*path_);
  identity_ = lightIdentity(loaded);
  if (std::filesystem::exists(*path_)) read();
}

void CacheFile::read() {
  const std::vector<uint8_t> bytes = readFile(*path_);
  const std::span contents(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (contents.size() < kCacheHeader ||
      !std::equal(kCacheMagic.begin(), kCacheMagic.end(), contents.begin()))
    throwInput("{}: is not an irradiance cache", *path_);
  const std::span<const char> rest = contents.subspan(kCacheHeader);
  uint64_t stored = 0;
  std::memcpy(&stored, contents.data() + kCacheMagic.size(), sizeof(stored));
  if (stored != checksum(rest)) throwInput("{}: damaged: its checksum differs", *path_);
  MemoryReader reader(rest, *path_);
  std::string identity;
  reader(identity);
  if (identity != identity_)
    throwInput("{}: is the cache of another scene: {}", *path_, differenceOf(identity, identity_));
  cache_.archive(reader);
  inFile_ = cache_.size();
}

void CacheFile::write() {
  if (!path_ || cache_.size() == inFile_) return;
  MemoryWriter writer;
  writer(identity_);
  cache_.archive(writer);
  const uint64_t sum = checksum(writer.contents);
  std::vector<uint8_t> bytes(kCacheHeader + writer.contents.size());
  std::copy(kCacheMagic.begin(), kCacheMagic.end(), bytes.begin());
  std::memcpy(bytes.data() + kCacheMagic.size(), &sum, sizeof(sum));
  std::copy(writer.contents.begin(), writer.contents.end(), bytes.begin() + kCacheHeader);
  writeFile(*path_, bytes);
  inFile_ = cache_.size();
}

FinishedRender renderPlain(const LoadedScene& loaded, const PreparedScene& prepared,
                           const RenderSettings& settings, const Progress& progress,
                           const Stop& stop, RenderControl* control) {
  const RenderDescription& description = loaded.description;
  const double share = description.settings.denoisesAtEnd() ? kRenderShare : 1;
  std::optional<CacheFile> records;
  if (description.settings.cacheError) records.emplace(loaded);
  RenderResult result =
      render(*prepared.world, loaded.camera, *prepared.lighting, settings,
             [&](double fraction) { progress(share * fraction); }, stop.rendering, control,
             {prepared.environment.get(), records ? &records->cache() : nullptr});
  if (records) records->write();
  FinishedImage finished = finish(finishPlan(loaded, result), result, progress, stop.denoising);
  return {std::move(finished), std::move(result)};
}

// The part of an image of the whole size that the description renders.
Image cropped(const Image& whole, const Crop& window) {
  Image part(window.width, window.height, whole.channels);
  for (int y = 0; y < window.height; ++y)
    std::copy_n(whole.at(window.x, window.y + y), window.width * whole.channels, part.at(0, y));
  return part;
}

// The number of groups is known only now.
void checkGroupMemory(const LoadedScene& loaded, const World& world, const LightSource& lighting) {
  const RenderDescription& description = loaded.description;
  const size_t count = LightGroups(world, lighting).names().size();
  const Crop window = description.settings.window();
  const double layers = double(LayerFilm::bytesPerPixel(count, false) + 2 * count * sizeof(Rgb)) *
                        window.width * window.height;
  const double needed = estimateMemory(loaded).peak + layers;
  checkMemory(description, needed,
              "{}: {} light groups take {:.3g} GB of memory, with all else {:.3g} GB",
              description.origins.of("output.aovs"), count, 1e-9 * layers, 1e-9 * needed);
}

}  // namespace

FinishPlan finishPlan(const LoadedScene& loaded, const RenderResult& result) {
  const RenderDescription& description = loaded.description;
  FinishPlan plan{description.settings, {}, result.groups};
  if (!description.composite) return plan;
  const Crop window = description.settings.window();
  plan.composite = {description.composite->mode, description.composite->layers, {}, {}};
  if (!description.composite->plate.empty())
    plan.composite->plate = cropped(description.composite->plate, window);
  if (loaded.projection) plan.composite->reflectance = cropped(loaded.projection->colors(), window);
  return plan;
}

PreparedScene prepareScene(const LoadedScene& loaded, const PreparedScene* earlier) {
  const RenderDescription& description = loaded.description;
  Stopwatch watch;
  PreparedScene prepared;
  const std::vector<RayMask> masks =
      description.composite ? rayMasks(loaded.isObject) : std::vector<RayMask>();
  if (earlier) {
    BsdfTables tables = earlier->world->bsdfTables;
    tables.complete(loaded.scene.materials, description.settings.regularize);
    prepared.world =
        std::make_unique<const World>(loaded.scene, masks, tables, earlier->world->accel.built());
  } else {
    prepared.world = std::make_unique<const World>(
        loaded.scene, masks, BsdfTables(loaded.scene.materials, description.settings.regularize));
  }
  prepared.buildSeconds = watch.lap();
  prepared.lighting = makeLighting(loaded);
  prepared.environment =
      makeEnvironment(description.settings.integrator, description.lighting.strategy, loaded);
  if (description.settings.wantsGroups())
    checkGroupMemory(loaded, *prepared.world, *prepared.lighting);
  prepared.prepareSeconds = watch.lap();
  loaded.scene.checkTexels();
  return prepared;
}

FinishedRender renderLoaded(const LoadedScene& loaded, const PreparedScene& prepared,
                            const Progress& progress, const Stop& stop, RenderControl* control) {
  const RenderDescription& description = loaded.description;
  Stopwatch watch;
  const KeptTime kept = keepTime(description);
  FinishedRender result =
      description.composite
          ? renderComposite(loaded, prepared, kept.settings, progress, stop, control)
          : renderPlain(loaded, prepared, kept.settings, progress, stop, control);
  loaded.scene.checkTexels();
  result.render.interrupted |= description.settings.denoisesAtEnd() && !result.denoised;
  result.seconds = watch.lap();
  if (constexpr double kNotable = 0.05; kept.seconds > kNotable)
    addNote(result.messages, "{}: {:.3g} s of it were kept for {}writing",
            description.origins.of("render.time"), kept.seconds,
            description.settings.denoisesAtEnd() ? "denoising and " : "");
  if (result.render.overrun > 0)
    addWarning(
        result.messages,
        "{}: the first pass, which is always completed, took {:.3g} s, longer than {:.3g} s{}",
        description.origins.of("render.time"), result.render.overrun, *kept.settings.timeLimit,
        kept.seconds > 0
            ? fmt::format(", which {:g} s leave for the samples", *description.settings.timeLimit)
            : "");
  return result;
}

FinishedRender renderLoaded(const LoadedScene& loaded) {
  const std::atomic<bool> never = false;
  return renderLoaded(
      loaded, prepareScene(loaded), [](double) {}, never);
}

void FrameScene::show(const RenderDescription& description) {
  if (!loaded_ || description.composite || !isViewOf(description, loaded_->scene, loaded_->view))
    return load(description);
  const FrameChange change = loadFrame(description, *loaded_, models_);
  if (change.geometry) {
    BsdfTables tables = prepared_.world->bsdfTables;
    tables.complete(loaded_->scene.materials, description.settings.regularize);
    const std::shared_ptr<BuiltGeometry> built = prepared_.world->accel.built();
    prepared_.world.reset();
    prepared_.world =
        std::make_unique<const World>(loaded_->scene, std::vector<RayMask>(), tables, built);
  }
  if (!change.lighting) return;
  prepared_.lighting = makeLighting(*loaded_);
  prepared_.environment =
      makeEnvironment(description.settings.integrator, description.lighting.strategy, *loaded_);
}

void FrameScene::load(const RenderDescription& description) {
  const std::optional<AutomaticView> view = loaded_ ? std::optional(loaded_->view) : std::nullopt;
  prepared_ = {};
  models_.keepsFiles = true;
  loaded_ =
      std::make_unique<LoadedScene>(loadScene(description, &models_, view ? &*view : nullptr));
  prepared_ = prepareScene(*loaded_);
}

}  // namespace chromeball
