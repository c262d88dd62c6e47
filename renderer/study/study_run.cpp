// SPDX-License-Identifier: Apache-2.0
#include "study/study_run.h"

#include <algorithm>

#include "base/error.h"
#include "base/progress.h"
#include "description/capabilities.h"
#include "image/io/read_image.h"
#include "scene/extended_surface.h"
#include "session/denoised_image.h"
#include "session/scene_lighting.h"

namespace chromeball {

StudyRun::StudyRun(const Study& study, const RenderStore& store, const LoadedScene& loaded,
                   const RenderSettings& settings)
    : study_(study),
      store_(store),
      loaded_(loaded),
      settings_(settings),
      renders_(study.renders()) {
  const auto build = [&](const std::string& name, const std::string& row, const char* location) {
    const Stopwatch watch;
    Built& built = built_[name];
    built.row = rowNamed(row, location);
    built.strategy = makeLighting({built.row.strategy, location}, settings.mis, loaded);
    if (built.row.has(Mode::Guide) && !built.strategy->canBeGuided())
      throwInput("{}: {}: only renders with the strategy `importance` are guided", location, row);
    built.environment = makeEnvironment(built.row.integrator, built.row.strategy, loaded);
    RenderDescription whole;
    whole.surroundings = loaded.description.surroundings;
    whole.sources = loaded.description.sources;
    whole.camera = loaded.description.camera;
    built.row.applyTo(whole);
    if (name != kReference) whole.settings.samples = study.leastSamples();
    if (const Conflict* found = conflictIn(whole))
      throwInput("{}: {}: {}", location, row, found->why);
    built.prepareSeconds = watch.seconds();
  };
  for (const std::string& name : study.strategies) build(name, name, "strategies");
  if (study.referenceFile.empty()) build(kReference, study.referenceStrategy, "reference strategy");
  makeWorlds();
  for (const RenderKey& key : renders_) {
    present_.push_back(store.find(key).has_value());
    stored_ += present_.back();
  }
}

Messages StudyRun::idleModes() const {
  Messages messages;
  for (const std::string& name : study_.strategies) {
    RenderDescription alone = loaded_.description;
    const Row& row = built_.at(name).row;
    row.applyTo(alone);
    alone.settings.samples = study_.mostSamples();
    alone.origins = {};
    for (const std::string_view setting : row.settings())
      alone.origins.set(std::string(setting), name);
    const Messages idle = idleMessages(alone, loaded_);
    messages.insert(messages.end(), idle.begin(), idle.end());
  }
  return messages;
}

void StudyRun::makeWorlds() {
  const auto anyHas = [&](Mode mode) {
    return std::ranges::any_of(built_, [&](const auto& one) { return one.second.row.has(mode); });
  };
  const BsdfTables tables(loaded_.scene.materials, anyHas(Mode::Regularize));
  const std::vector<RayMask> all;
  world_ = std::make_unique<const World>(loaded_.scene, all, tables);
  if (!anyHas(Mode::GlassShadows)) return;
  passShadowsStraight(straightScene_.emplace(loaded_.scene).materials);
  straightWorld_ = std::make_unique<const World>(*straightScene_, all, tables);
}

RenderResult StudyRun::render(const RenderKey& key, const Progress& progress,
                              const std::atomic<bool>& stop) const {
  const Row& row = built_.at(key.strategy).row;
  RenderSettings settings = row.applied(settings_);
  settings.seed = seedOf(key, study_.seed);
  settings.samples = key.budget.timed ? kMaxSamples : uint32_t(key.budget.amount);
  settings.timeLimit.reset();
  if (key.budget.timed) settings.timeLimit = key.budget.amount;
  return chromeball::render(worldOf(row), loaded_.camera, strategy(key.strategy), settings,
                            progress, stop, nullptr, {built_.at(key.strategy).environment.get()});
}

double StudyRun::estimatedSeconds(const RenderKey& key) const {
  if (key.budget.timed) return key.budget.amount;
  double known = built_.at(key.strategy).secondsPerSample, sum = 0;
  int count = 0;
  for (const auto& [name, built] : built_) {
    sum += built.secondsPerSample;
    count += built.secondsPerSample > 0;
  }
  if (known == 0) known = count ? sum / count : 1e-3;
  return known * key.budget.amount;
}

double StudyRun::estimatedSecondsMissing(size_t from) const {
  double seconds = 0;
  for (size_t i = from; i < renders_.size(); ++i)
    if (!present_[i]) seconds += estimatedSeconds(renders_[i]);
  return seconds;
}

void StudyRun::renderOne(const RenderKey& key, const Progress& progress,
                         const std::atomic<bool>& stop) {
  const Stopwatch watch;
  const RenderResult result = render(key, progress, stop);
  if (result.interrupted) return;
  Built& built = built_.at(key.strategy);
  Image image = result.film.mean();
  double noise = result.film.noise().noise;
  if (built.row.has(Mode::Denoise) && result.samples > 1) {
    std::optional<Denoised> denoised = denoiseRender(
        result, [](double) {}, stop);
    if (!denoised) return;
    const double remaining = remainingNoise(relativeErrors(*denoised));
    if (!(noise < remaining)) noise = remaining;
    image = std::move(denoised->color);
  }
  const double seconds = watch.seconds();
  built.secondsPerSample = seconds / std::max(1u, result.samples);
  const RayCounts& rays = result.rays;
  store_.save(key, {unbiased(key.strategy), std::move(image), double(result.samples), seconds,
                    built.prepareSeconds, noise, double(rays.camera + rays.shadow + rays.bounce),
                    double(result.invalid.total())});
  ++stored_;
}

void StudyRun::warmUp(const std::atomic<bool>& stop) {
  for (auto& [name, built] : built_) {
    const Stopwatch watch;
    render(
        {name, {false, 1}, 0}, [](double) {}, stop);
    built.secondsPerSample = watch.seconds();
    if (stop) return;
  }
}

bool StudyRun::run(const Progress& progress, const std::function<void()>& finishedBudget,
                   const std::atomic<bool>& stop) {
  if (stored_ == total()) return true;
  store_.makeFolder();
  warmUp(stop);
  double spent = 0;
  for (size_t i = 0; i < renders_.size(); ++i) {
    const RenderKey& key = renders_[i];
    if (!present_[i]) {
      if (stop) return false;
      const double expected = estimatedSeconds(key), left = estimatedSecondsMissing(i + 1);
      const Stopwatch watch;
      renderOne(
          key,
          [&](double fraction) {
            progress((spent + fraction * expected) / (spent + expected + left));
          },
          stop);
      if (stop) return false;
      spent += watch.seconds();
      present_[i] = true;
    }
    const bool last = i + 1 == renders_.size() || !(renders_[i + 1].budget == key.budget);
    if (last && key.strategy != kReference) finishedBudget();
  }
  return true;
}

namespace {

// The mean of independent parts, with its squared standard error from their variance.
Reference meanOfParts(const std::vector<Image>& parts) {
  Reference reference{parts[0], parts[0]};
  for (size_t i = 0; i < parts[0].texels.size(); ++i) {
    std::vector<double> numbers;
    for (const Image& part : parts) numbers.push_back(part.texels[i]);
    const Estimate e = meanOf(numbers);
    reference.mean.texels[i] = float(e.mean);
    reference.squaredError.texels[i] = float(e.standardError * e.standardError);
  }
  return reference;
}

Reference readReference(const std::string& path, int width, int height, Messages* messages) {
  const ImageFile file = readImageFile(path);
  if (messages) messages->insert(messages->end(), file.messages.begin(), file.messages.end());
  std::optional<Image> color = layerOf(file, "noisy", path);
  const bool isDenoised = color.has_value();
  if (!color) color = findColor(file);
  if (!color) throwInput("reference: {}: has no colour", path);
  color = inDisplayWindow(*std::move(color), file.placement, path);
  if (color->width != width || color->height != height)
    throwInput("reference: {} is {} x {}, but the renders are {} x {}; try a size of {}x{}", path,
               color->width, color->height, width, height, color->width, color->height);
  if (isDenoised && messages)
    addNote(*messages, "reference: {} is denoised: its layer `noisy`, which is unbiased, is taken",
            path);
  const std::optional<Image> variance = layerOf(file, "variance", path);
  return {*color, variance && variance->channels == 3 ? *variance : Image()};
}

}  // namespace

Reference loadReference(const Study& study, const RenderStore& store, int width, int height,
                        Messages* messages) {
  if (!study.referenceFile.empty())
    return readReference(study.referenceFile, width, height, messages);
  std::vector<Image> parts;
  for (int part = 0; part < Study::kReferenceParts; ++part)
    parts.push_back(store.find(study.referencePart(part)).value().image);
  return meanOfParts(parts);
}

}  // namespace chromeball
