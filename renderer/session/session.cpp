// SPDX-License-Identifier: Apache-2.0
#include "session/session.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <set>
#include <thread>

#include "base/error.h"
#include "base/json.h"
#include "description/describe.h"
#include "render/live_result.h"
#include "render/render_state.h"
#include "scene/gltf/model_cache.h"
#include "session/run_job.h"
#include "session/scene_lighting.h"
#include "trace/built_geometry.h"

namespace chromeball {
namespace {

// What decides the light, and what the picture's place and size, under the names of describe().
// These and the settings of the integrator need no new scene.
constexpr std::array kOfProbe = {"probe", "probe-mapping", "probe-rotation", "probe-scale",
                                 "probe-in-memory"};
constexpr std::array kOfLighting = {"strategy",    "mis",        "sun-angle",
                                    "show-lights", "integrator", "aov"};
constexpr std::array kOfCamera = {"camera", "camera-file", "scene-camera", "lens",
                                  "optics", "orbit",       "size",         "crop"};
constexpr std::array kOfPaths = {"noise-limit",
                                 "time-limit",
                                 "shard",
                                 "adaptive",
                                 "guide",
                                 "max-depth",
                                 "max-transmission-depth",
                                 "max-diffuse-depth",
                                 "max-specular-depth",
                                 "ao",
                                 "reflection-occlusion",
                                 "ao-distance",
                                 "bent",
                                 "irradiance-cache",
                                 "seed",
                                 "transparent",
                                 "clamp",
                                 "denoise"};

template <size_t N>
bool has(const std::array<const char*, N>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

// What is in memory differs if it is another object: hashes of a large scene would take as long as
// a frame.
std::set<std::string> differences(RenderDescription a, RenderDescription b) {
  std::set<std::string> names;
  if (a.scene != b.scene) names.insert("scene-in-memory");
  if (a.probe.map != b.probe.map) names.insert("probe-in-memory");
  for (RenderDescription* d : {&a, &b}) d->scene.reset(), d->probe.map.reset();
  const nlohmann::ordered_json was = describe(a), is = describe(b);
  for (const auto* one : {&was, &is})
    for (const auto& [name, ignored] : one->items())
      if (was.value(name, nlohmann::ordered_json()) != is.value(name, nlohmann::ordered_json()))
        names.insert(name);
  return names;
}

// Shows the result to those who watch; a session has no checkpoints.
class WatchedRender : public RenderControl {
 public:
  bool restore(RenderState&) override { return false; }
  bool wantsPause(const RenderState&) const override { return false; }
  void pause(RenderState&) override {}
  void end(RenderState&) override {}
  LiveResult* live() override { return &live_; }

 private:
  LiveResult live_;
};

double meanCount(const Image& counts) {
  double sum = 0;
  for (const float count : counts.texels) sum += double(count);
  return sum / double(std::max<size_t>(counts.texels.size(), 1));
}

}  // namespace

class Session::Implementation {
 public:
  explicit Implementation(RenderDescription description) : description_(std::move(description)) {}
  ~Implementation() { cancel(); }

  void start();
  void cancel();
  void update(RenderDescription description);
  bool isRunning() const { return isRunning_; }
  double fraction() const { return fraction_; }
  const SessionImage& wait();
  std::optional<SessionImage> snapshot();
  Messages messages() const { return loaded_ ? loaded_->messages : Messages(); }
  Work work() const { return work_; }

 private:
  void run();
  void prepare();
  void load();
  void changeWhatDiffers();

  RenderDescription description_;
  std::optional<RenderDescription> given_;  // that of loaded_
  std::unique_ptr<LoadedScene> loaded_;
  PreparedScene prepared_;
  ModelCache models_;
  Work work_;
  std::unique_ptr<WatchedRender> control_;
  std::optional<SessionImage> result_;
  std::exception_ptr error_;
  std::atomic<bool> stop_ = false, isRunning_ = false, isReady_ = false;
  std::atomic<double> fraction_ = 0;
  std::thread thread_;
};

void Session::Implementation::start() {
  if (thread_.joinable()) return;
  stop_ = false;
  isReady_ = false;
  isRunning_ = true;
  fraction_ = 0;
  result_.reset();
  error_ = nullptr;
  control_ = std::make_unique<WatchedRender>();
  thread_ = std::thread([this] { run(); });
}

void Session::Implementation::cancel() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void Session::Implementation::update(RenderDescription description) {
  cancel();
  description_ = std::move(description);
  result_.reset();
  control_.reset();
}

const SessionImage& Session::Implementation::wait() {
  if (thread_.joinable()) thread_.join();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  if (!result_) throw Interrupted("the session was cancelled before it rendered");
  return *result_;
}

void Session::Implementation::run() {
  try {
    prepare();
    if (!stop_) {
      isReady_ = true;
      const auto& composite = description_.composite;
      const bool hasTwoPasses = composite && composite->passes == Passes::Two;
      JobResult result = renderJob(
          *loaded_, prepared_, [this](double fraction) { fraction_ = fraction; }, stop_,
          hasTwoPasses ? nullptr : control_.get());
      result_ = {std::move(result.image), meanCount(result.render.film.sampleCounts()),
                 result.noise.noise, !result.render.interrupted, std::move(result.messages)};
    }
  } catch (...) {
    error_ = std::current_exception();
    if (!isReady_) {  // it may be half of one description and half of another
      prepared_ = {};
      loaded_.reset();
    }
  }
  isRunning_ = false;
}

void Session::Implementation::prepare() {
  work_ = {};
  loaded_ && !given_->composite && !description_.composite ? changeWhatDiffers() : load();
  given_ = description_;
  work_.meshBuilds = prepared_.world->accel.built()->builds();
}

void Session::Implementation::load() {
  work_ = {.loadedScene = true, .loadedProbe = true, .preparedLighting = true};
  const PreparedScene earlier = std::move(prepared_);
  prepared_ = {};
  LoadedScene scene = loadScene(description_, &models_);
  if (loaded_ && earlier.world) {
    *loaded_ = std::move(scene);  // in its place, where the structures over meshes expect it
    prepared_ = prepareScene(*loaded_, &earlier);
  } else {
    loaded_ = std::make_unique<LoadedScene>(std::move(scene));
    prepared_ = prepareScene(*loaded_);
  }
}

void Session::Implementation::changeWhatDiffers() {
  const std::set<std::string> names = differences(*given_, description_);
  const auto differs = [&](const auto& of) {
    return std::ranges::any_of(names, [&](const std::string& name) { return has(of, name); });
  };
  const bool keepsScene = std::ranges::all_of(names, [](const std::string& name) {
    return has(kOfProbe, name) || has(kOfLighting, name) || has(kOfCamera, name) ||
           has(kOfPaths, name);
  });
  // The models' own environment is the scene's, and moves to the probe.
  const auto hasProbe = [](const RenderDescription& d) { return d.probe.file || d.probe.map; };
  if (!keepsScene || (differs(kOfProbe) && !(hasProbe(*given_) && hasProbe(description_))))
    return load();
  const FrameChange change = loadFrame(description_, *loaded_, models_);
  if (change.geometry) return load();
  work_.loadedProbe = change.lighting;
  const bool hasOwnStrategy = given_->lighting.make || description_.lighting.make;
  if (!change.lighting && !differs(kOfLighting) && !hasOwnStrategy) return;
  work_.preparedLighting = true;
  prepared_.lighting = makeLighting(*loaded_);
  prepared_.environment = makeEnvironment(description_.settings.integrator,
                                          description_.lighting.strategy.name, *loaded_);
}

std::optional<SessionImage> Session::Implementation::snapshot() {
  if (!isReady_ || !control_) return {};
  const RenderResult* result = control_->live()->update();
  const double samples = result ? meanCount(result->film.sampleCounts()) : 0;
  if (samples == 0) return {};
  FinishPlan plan = finishPlan(*loaded_, *result);
  plan.settings.denoise = false;
  const std::atomic<bool> never = false;
  FinishedImage finished = finish(
      plan, *result, [](double) {}, never);
  return SessionImage{std::move(finished.image), samples, finished.noise.noise, false, {}};
}

Session::Session(RenderDescription description)
    : own_(std::make_unique<Implementation>(std::move(description))) {}
Session::~Session() = default;
void Session::start() { own_->start(); }
void Session::cancel() { own_->cancel(); }
void Session::update(RenderDescription description) { own_->update(std::move(description)); }
bool Session::isRunning() const { return own_->isRunning(); }
double Session::fraction() const { return own_->fraction(); }
const SessionImage& Session::wait() { return own_->wait(); }
std::optional<SessionImage> Session::snapshot() { return own_->snapshot(); }
Messages Session::messages() const { return own_->messages(); }
Session::Work Session::work() const { return own_->work(); }

}  // namespace chromeball
