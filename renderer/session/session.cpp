// SPDX-License-Identifier: Apache-2.0
#include "session/session.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/json.h"
#include "description/describe.h"
#include "integrate/render_state.h"
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

std::set<std::string> differences(const RenderDescription& a, const RenderDescription& b) {
  const nlohmann::ordered_json was = describe(a), is = describe(b);
  std::set<std::string> names;
  for (const auto* one : {&was, &is})
    for (const auto& [name, ignored] : one->items())
      if (was.value(name, nlohmann::ordered_json()) != is.value(name, nlohmann::ordered_json()))
        names.insert(name);
  return names;
}

}  // namespace

// Shows the result to those who watch; a session has no checkpoints.
class Session::Control : public RenderControl {
 public:
  bool restore(RenderState&) override { return false; }
  bool wantsPause(const RenderState&) const override { return false; }
  void pause(RenderState&) override {}
  void end(RenderState&) override {}
  LiveResult* live() override { return &live_; }

 private:
  LiveResult live_;
};

Session::Session(RenderDescription description) : description_(std::move(description)) {}

Session::~Session() { cancel(); }

void Session::start() {
  if (thread_.joinable()) return;
  stop_ = false;
  isReady_ = false;
  isRunning_ = true;
  fraction_ = 0;
  result_.reset();
  error_ = nullptr;
  control_ = std::make_unique<Control>();
  thread_ = std::thread([this] { run(); });
}

void Session::cancel() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void Session::update(RenderDescription description) {
  cancel();
  description_ = std::move(description);
  result_.reset();
  control_.reset();
}

const JobResult& Session::wait() {
  if (thread_.joinable()) thread_.join();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  if (!result_) throw Interrupted("the session was cancelled before it rendered");
  return *result_;
}

void Session::run() {
  try {
    prepare();
    if (!stop_) {
      isReady_ = true;
      const bool hasTwoPasses =
          description_.composite && description_.composite->passes == Passes::Two;
      result_ = renderJob(
          *loaded_, prepared_, [this](double fraction) { fraction_ = fraction; }, stop_,
          hasTwoPasses ? nullptr : control_.get());
    }
  } catch (...) {
    error_ = std::current_exception();
    if (!isReady_) loaded_.reset();  // it may be half of one description and half of another
  }
  isRunning_ = false;
}

void Session::prepare() {
  work_ = {};
  loaded_ && !given_->composite && !description_.composite ? changeWhatDiffers() : load();
  given_ = description_;
}

void Session::load() {
  work_ = {.loadedScene = true, .builtWorld = true, .loadedProbe = true, .preparedLighting = true};
  PreparedScene earlier = std::move(prepared_);
  prepared_ = {};
  LoadedScene scene = loadScene(description_, &models_);
  if (loaded_ && earlier.world) {
    std::shared_ptr<BuiltGeometry> built = earlier.world->accel.built();
    *loaded_ = std::move(scene);
    prepared_ = prepareScene(*loaded_, &earlier);
  } else {
    loaded_ = std::make_unique<LoadedScene>(std::move(scene));
    prepared_ = prepareScene(*loaded_);
  }
}

void Session::changeWhatDiffers() {
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
  work_.loadedProbe = change.lighting;
  if (change.geometry) return load();
  if (!change.lighting && !differs(kOfLighting)) return;
  work_.preparedLighting = true;
  prepared_.lighting = makeLighting(*loaded_);
  prepared_.environment = makeEnvironment(description_.settings.integrator,
                                          description_.lighting.strategy.name, *loaded_);
}

int Session::meshBuilds() const {
  return prepared_.world ? prepared_.world->accel.built()->builds() : 0;
}

std::optional<Session::Snapshot> Session::snapshot() {
  if (!isReady_ || !control_) return {};
  const RenderResult* result = control_->live()->update();
  if (!result) return {};
  FinishPlan plan = finishPlan(*loaded_, *result);
  plan.settings.denoise = false;
  const std::atomic<bool> never = false;
  Snapshot snapshot{finish(
                        plan, *result, [](double) {}, never),
                    0};
  const Image counts = result->film.sampleCounts();
  for (const float count : counts.texels) snapshot.samples += double(count);
  snapshot.samples /= double(std::max<size_t>(counts.texels.size(), 1));
  if (snapshot.samples == 0) return {};
  return snapshot;
}

}  // namespace chromeball
