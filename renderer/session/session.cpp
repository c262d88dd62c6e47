// SPDX-License-Identifier: Apache-2.0
#include "session/session.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <stdexcept>
#include <thread>

#include "base/error.h"
#include "base/file_stamps.h"
#include "base/json.h"
#include "base/progress.h"
#include "description/describe.h"
#include "render/render_state.h"
#include "scene/gltf/model_cache.h"
#include "session/live_image.h"
#include "session/render_loaded.h"
#include "session/render_messages.h"
#include "session/render_report.h"
#include "session/scene_lighting.h"
#include "trace/built_geometry.h"

namespace chromeball {
namespace {

// Shows the result to those who watch; a session has no checkpoints.
class WatchedRender : public RenderControl {
 public:
  bool restore(RenderState&) override { return false; }
  void endPass(const RenderState& state) override {
    if (isWatched_) noise_ = state.result.film.noise().noise;
  }
  bool wantsPause(const RenderState&) const override { return false; }
  void pause(RenderState&) override {}
  void end(RenderState&) override {}
  LiveResult* live() override { return &live_; }

  void watch() { isWatched_ = true; }
  double noise() const { return noise_; }  // after the last pass that was watched; NaN before

 private:
  LiveResult live_;
  std::atomic<bool> isWatched_ = false;
  std::atomic<double> noise_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace

class Session::Implementation : private WorkMonitor {
 public:
  Implementation(RenderDescription description, SessionCallbacks callbacks)
      : callbacks_(std::move(callbacks)) {
    take(std::move(description));
  }
  ~Implementation() override { discard(); }

  void start();
  void requestCancel() { stop_ = true; }
  void cancel();
  void update(RenderDescription description);
  bool isRunning() const { return isRunning_; }
  double fraction() const { return fraction_; }
  const SessionImage& wait();
  std::shared_ptr<const SessionImage> snapshot();
  Messages messages() const { return loaded_ ? loaded_->messages : Messages(); }
  Work work() const { return work_; }

 private:
  // A render that is cancelled makes an image; nothing else of a session outlives its cancellation.
  bool isCancelled() const override { return discards_ || (stop_ && !isReady_); }
  void report(const char* stage, double fraction) override;
  void say(const Messages& messages) const;

  void take(RenderDescription description);
  void discard();
  void run();
  void attempt(const std::function<void()>& task);
  void render();
  void prepare();
  void load();
  bool isStale(const std::string& file) const { return !stamps_.isCurrent(file); }
  bool hasStaleProbe() const;
  bool hasStaleScene() const;
  void changeWhatDiffers();
  void unload();

  const SessionCallbacks callbacks_;
  RenderDescription description_;
  std::optional<RenderDescription> given_;  // the one that loaded_ was made from
  std::unique_ptr<LoadedScene> loaded_;
  PreparedScene prepared_;
  bool lightingIsStale_ = false;  // in prepared_: making it was cancelled or has failed
  ModelCache models_;
  FileStamps stamps_;  // of all that loaded_, and those before that models_ knows, were read from
  Work work_;
  PhaseSeconds seconds_;  // of the last start()
  std::unique_ptr<WatchedRender> control_;
  std::optional<LiveImage> liveImage_;
  std::shared_ptr<const SessionImage> result_;
  std::exception_ptr error_;
  std::atomic<bool> stop_ = false, discards_ = false, isRunning_ = false, isReady_ = false;
  std::atomic<double> fraction_ = 0;
  std::thread::id ownThread_;
  std::thread thread_;
};

void Session::Implementation::start() {
  if (thread_.joinable()) return;
  stop_ = discards_ = isReady_ = false;
  isRunning_ = true;
  fraction_ = 0;
  liveImage_.reset();
  result_.reset();
  error_ = nullptr;
  control_ = std::make_unique<WatchedRender>();
  thread_ = std::thread([this] { run(); });
}

void Session::Implementation::cancel() {
  requestCancel();
  if (thread_.joinable()) thread_.join();
}

void Session::Implementation::discard() {
  discards_ = true;
  cancel();
}

void Session::Implementation::update(RenderDescription description) {
  discard();
  isReady_ = false;
  take(std::move(description));
  liveImage_.reset();
  result_.reset();
  control_.reset();
}

void Session::Implementation::take(RenderDescription description) {
  description_ = std::move(description);
  description_.run.isWatched = true;
}

const SessionImage& Session::Implementation::wait() {
  if (!control_) throw std::logic_error("Session::wait() without start()");
  if (thread_.joinable()) thread_.join();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  if (!result_) throw Interrupted("the session was cancelled before it rendered");
  return *result_;
}

// Only this thread calls back; reports of others are ignored.
void Session::Implementation::report(const char* stage, double fraction) {
  if (callbacks_.progress && std::this_thread::get_id() == ownThread_)
    callbacks_.progress({stage, fraction});
}

void Session::Implementation::say(const Messages& messages) const {
  if (!callbacks_.message) return;
  for (const Message& message : messages) callbacks_.message(message);
}

void Session::Implementation::run() {
  ownThread_ = std::this_thread::get_id();
  attempt([&] {
    const MonitoredWork monitored(this);
    prepare();
    say(loaded_->messages);
    endIfCancelled();
    isReady_ = true;
    render();
  });
  isRunning_ = false;
  if (callbacks_.finished) attempt(callbacks_.finished);
}

void Session::Implementation::attempt(const std::function<void()>& task) {
  try {
    task();
  } catch (const Interrupted&) {  // wait() says so
  } catch (...) {
    error_ = std::current_exception();
  }
}

void Session::Implementation::render() {
  const auto& composite = description_.composite;
  const bool hasTwoPasses = composite && composite->passes == Passes::Two;
  const auto progress = [this](double fraction) {
    fraction_ = fraction;
    report("render", fraction);
  };
  progress(0);
  FinishedRender result =
      renderLoaded(*loaded_, prepared_, progress, stop_, hasTwoPasses ? nullptr : control_.get());
  if (!result.render.interrupted) progress(1);
  result.image.metadata = imageMetadata(*loaded_, result, result.render, result.seconds);
  result.messages = resultMessages(*loaded_, prepared_, result, callbacks_.words);
  say(result.messages);
  const double samples = result.render.film.meanSampleCount();
  if (samples == 0) return;
  seconds_.render = result.seconds;
  std::string report = jsonText(statistics(*loaded_, result, seconds_));
  result_ = std::make_shared<const SessionImage>(
      SessionImage{std::move(result.image), samples, result.noise.noise, !result.render.interrupted,
                   std::move(result.messages), std::move(report)});
}

void Session::Implementation::prepare() {
  work_ = {};
  Stopwatch watch;
  loaded_ && !given_->composite && !description_.composite ? changeWhatDiffers() : load();
  seconds_ = {.load = watch.lap()};
  if (work_.loadedScene) {
    seconds_.build = prepared_.buildSeconds, seconds_.prepare = prepared_.prepareSeconds;
    seconds_.load -= seconds_.build + seconds_.prepare;
  }
  work_.meshBuilds = prepared_.world->accel.built()->builds();
}

void Session::Implementation::load() {
  work_ = {.loadedScene = true, .loadedProbe = true, .preparedLighting = true};
  if (!stamps_.areCurrent()) models_ = {}, stamps_ = {};
  const auto begin = FileStamps::now();
  ModelCache models = models_;
  LoadedScene scene = loadScene(description_, &models);
  models_ = std::move(models);
  stamps_.add(scene.files, begin);
  try {
    const PreparedScene earlier = std::exchange(prepared_, {});
    if (loaded_) {
      *loaded_ = std::move(scene);  // in its place, where the structures over meshes expect it
      prepared_ = prepareScene(*loaded_, &earlier);
    } else {
      loaded_ = std::make_unique<LoadedScene>(std::move(scene));
      prepared_ = prepareScene(*loaded_);
    }
  } catch (...) {
    unload();
    throw;
  }
  given_ = description_;
  lightingIsStale_ = false;
}

bool Session::Implementation::hasStaleProbe() const {
  return std::ranges::any_of(loaded_->loadedProbe.files, [&](const auto& f) { return isStale(f); });
}

bool Session::Implementation::hasStaleScene() const {
  const std::vector<std::string>& ofProbe = loaded_->loadedProbe.files;
  return std::ranges::any_of(loaded_->files, [&](const std::string& file) {
    return std::ranges::find(ofProbe, file) == ofProbe.end() && isStale(file);
  });
}

void Session::Implementation::changeWhatDiffers() {
  const Differences differences(*given_, description_);
  // The models' own environment is the scene's, and moves to the probe.
  const auto hasProbe = [](const RenderDescription& d) { return d.probe.file || d.probe.map; };
  if (!differences.keepScene() || hasStaleScene() ||
      !isViewOf(description_, loaded_->scene, loaded_->view) ||
      (differences.inProbe() && !(hasProbe(*given_) && hasProbe(description_))))
    return load();
  const auto begin = FileStamps::now();
  FrameChange change;
  try {
    change = loadFrame(description_, *loaded_, models_, hasStaleProbe());
    if (change.probe) stamps_.add(loaded_->loadedProbe.files, begin);
  } catch (...) {
    lightingIsStale_ = true;
    if (loaded_->scene.isAnimated) unload();  // else it is of one description
    throw;
  }
  if (change.geometry) return load();
  work_.loadedProbe = change.probe;
  const bool hasOwnStrategy = given_->lighting.make || description_.lighting.make;
  lightingIsStale_ |= change.lighting || differences.inLighting() || hasOwnStrategy;
  given_ = description_;
  if (!lightingIsStale_) return;
  work_.preparedLighting = true;
  prepared_.lighting = makeLighting(*loaded_);
  prepared_.environment =
      makeEnvironment(description_.settings.integrator, description_.lighting.strategy, *loaded_);
  lightingIsStale_ = false;
}

// After a failure half-way, the scene may be a mixture of both descriptions.
void Session::Implementation::unload() {
  prepared_ = {};
  loaded_.reset();
  models_ = {}, stamps_ = {};
}

std::shared_ptr<const SessionImage> Session::Implementation::snapshot() {
  if (!isRunning_ && result_) return result_;
  if (!isReady_) return nullptr;
  control_->watch();
  if (!liveImage_) liveImage_.emplace(*loaded_, *control_->live());
  return liveImage_->update(control_->noise());
}

Session::Session(RenderDescription description, SessionCallbacks callbacks)
    : own_(std::make_unique<Implementation>(std::move(description), std::move(callbacks))) {}
Session::~Session() = default;
void Session::start() { own_->start(); }
void Session::requestCancel() { own_->requestCancel(); }
void Session::cancel() { own_->cancel(); }
void Session::update(RenderDescription description) { own_->update(std::move(description)); }
bool Session::isRunning() const { return own_->isRunning(); }
double Session::fraction() const { return own_->fraction(); }
const SessionImage& Session::wait() { return own_->wait(); }
std::shared_ptr<const SessionImage> Session::snapshot() { return own_->snapshot(); }
Messages Session::messages() const { return own_->messages(); }
Session::Work Session::work() const { return own_->work(); }

}  // namespace chromeball
