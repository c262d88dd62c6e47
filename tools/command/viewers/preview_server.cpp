// SPDX-License-Identifier: Apache-2.0
#include "viewers/preview_server.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/json.h"
#include "base/progress.h"
#include "image/io/write_image.h"
#include "layer_view.h"
#include "session/viewer.h"
#include "viewers/local_server.h"

namespace chromeball {

extern const char* const kPreviewPage;
extern const char* const kPreviewScript;

namespace {

constexpr std::chrono::seconds kAttention{2};  // pages ask twice a second
constexpr double kMostWaiting = 5;             // seconds

nlohmann::json namesOf(const std::vector<Layer>& layers) {
  nlohmann::json names = nlohmann::json::array();
  for (const Layer& layer : layers) names.push_back(layer.name);
  return names;
}

struct NumberedImage {
  std::shared_ptr<const ImageSoFar> image;  // null before the first
  uint64_t number = 0;                      // of the images shown
};

// The state of a render for the pages of a preview. Thread-safe.
class WatchedRender {
 public:
  // Called by the render.
  void begin(const std::string& name) {
    const std::scoped_lock lock(mutex_);
    name_ = name;
    watch_ = Stopwatch();
    fraction_ = 0;
  }
  void update(double fraction) { fraction_ = fraction; }
  void show(std::shared_ptr<const ImageSoFar> image) {
    const std::scoped_lock lock(mutex_);
    image_ = {std::move(image), image_.number + 1};
  }
  // Whether a page has asked for the status in the last seconds.
  bool isWatched() const {
    const Clock::rep asked = asked_;
    return asked != Clock::duration::min().count() &&
           Clock::now().time_since_epoch() - Clock::duration(asked) < kAttention;
  }
  bool wantsFiles() const { return wantsFiles_; }
  void wroteFiles() {
    wantsFiles_ = false;
    const std::scoped_lock lock(mutex_);
    ++filesWritten_;
  }
  // Waits until the image and the status are sent, unless no page asks; a few seconds at most.
  void waitUntilSeen() {
    std::unique_lock lock(mutex_);
    const Stopwatch waiting;
    while (isWatched() && std::min(lastSent_, lastTold_) < image_.number &&
           waiting.seconds() < kMostWaiting)
      sent_.wait_for(lock, std::chrono::milliseconds(50));
  }

  // Called for the pages, which ask for the status again and again.
  nlohmann::json status() {
    asked_ = Clock::now().time_since_epoch().count();
    const std::scoped_lock lock(mutex_);
    lastTold_ = image_.number;
    const double fraction = fraction_, elapsed = watch_.seconds();
    nlohmann::json status{{"name", name_},
                          {"elapsed", elapsed},
                          {"fraction", fraction},
                          {"image", image_.number},
                          {"filesWritten", filesWritten_}};
    if (fraction > 0) status["remaining"] = elapsed * (1 - fraction) / fraction;
    if (!image_.image) return status;
    const OutputImage& image = image_.image->image;
    const Image& color = image.layers.front().image;
    status["samples"] = image_.image->samples;
    status["noise"] = image_.image->noise;
    status["isLast"] = image_.image->isLast;
    status["width"] = color.width;
    status["height"] = color.height;
    status["left"] = image.placement ? image.placement->x : 0;
    status["top"] = image.placement ? image.placement->y : 0;
    status["layers"] = namesOf(image.layers);
    return status;
  }
  NumberedImage image() const {
    const std::scoped_lock lock(mutex_);
    return image_;
  }
  void hasSent(uint64_t number) {
    const std::scoped_lock lock(mutex_);
    lastSent_ = std::max(lastSent_, number);
    sent_.notify_all();
  }
  void askForFiles() { wantsFiles_ = true; }

 private:
  using Clock = std::chrono::steady_clock;

  mutable std::mutex mutex_;
  std::condition_variable sent_;
  std::string name_;
  Stopwatch watch_;
  NumberedImage image_;
  uint64_t lastSent_ = 0, lastTold_ = 0, filesWritten_ = 0;
  std::atomic<double> fraction_ = 0;
  std::atomic<Clock::rep> asked_ = Clock::duration::min().count();  // since the clock's epoch
  std::atomic<bool> wantsFiles_ = false;
};

struct ImageView {
  std::string layer;  // empty: the colour
  DisplayTransform display;
  int maxWidth = 0;  // pixels; wider images are reduced by a whole factor. 0: no limit
};

// Means of squares of `factor` pixels; those at the right and lower edge may be cut.
Image reduced(const Image& image, int factor) {
  Image small((image.width + factor - 1) / factor, (image.height + factor - 1) / factor,
              image.channels);
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      const int right = std::min(image.width, (x + 1) * factor);
      const int bottom = std::min(image.height, (y + 1) * factor);
      const float weight = 1 / float((right - x * factor) * (bottom - y * factor));
      for (int row = y * factor; row < bottom; ++row)
        for (int column = x * factor; column < right; ++column)
          for (int c = 0; c < image.channels; ++c)
            small.at(x, y)[c] += weight * image.at(column, row)[c];
    }
  return small;
}

// A .png. Throws InputError for a layer that the image does not have.
std::vector<uint8_t> pngOf(const OutputImage& image, const ImageView& view) {
  const auto layer = std::ranges::find(image.layers, view.layer, &Layer::name);
  if (layer == image.layers.end()) throwInput("the image has no layer `{}`", view.layer);
  if (!std::isfinite(view.display.exposure)) throwInput("exposure: must be finite");
  Image shown = layerView(view.layer, layer->image);
  if (view.maxWidth > 0 && shown.width > view.maxWidth)
    shown = reduced(shown, (shown.width + view.maxWidth - 1) / view.maxWidth);
  return encodePng(shown, view.display);
}

// The values of each layer: {"albedo": ["0.25", ...]}. Text, since JSON has neither NaN nor
// infinity. Throws InputError outside the image.
nlohmann::json valuesAt(const OutputImage& image, int x, int y) {
  const Image& color = image.layers.front().image;
  if (x < 0 || y < 0 || x >= color.width || y >= color.height)
    throwInput("{}, {} is outside the image", x, y);
  nlohmann::json values;
  for (const Layer& layer : image.layers) {
    nlohmann::json& texts = values[layer.name] = nlohmann::json::array();
    for (int c = 0; c < layer.image.channels; ++c)
      texts.push_back(fmt::format("{:.6g}", layer.image.at(x, y)[c]));
  }
  return values;
}

ImageView viewOf(const httplib::Request& request) {
  return {
      .layer = request.get_param_value("layer"),
      .display = {parseToneOperator(
                      request.has_param("tonemap") ? request.get_param_value("tonemap") : "none"),
                  numberOf(request, "exposure", 0.0f)},
      .maxWidth = numberOf(request, "width", 0)};
}

}  // namespace

class PreviewServer::Server {
 public:
  Server(int port, bool saves, std::function<void()> stop) : stop_(std::move(stop)) {
    keepLocal(http_);
    addRoutes(saves);
    port_ = bindLocal(http_, port);
  }

  // Runs on a thread, until stop().
  void run() {
    http_.listen_after_bind();
    ended_.set_value();
  }

  // Returns whether run() ends in time: it waits for the ends of all requests, and a hostile client
  // can make one last for ever.
  bool stop() {
    constexpr std::chrono::seconds kPatience{2};
    while (!http_.is_running()) std::this_thread::yield();  // httplib's stop() does nothing before
    http_.stop();
    return ended_.get_future().wait_for(kPatience) == std::future_status::ready;
  }

  int port() const { return port_; }

  WatchedRender render;

 private:
  using Handler = std::function<void(const httplib::Request&, httplib::Response&)>;

  // Answers that depend on the image; 404 before there is one.
  template <class Answer>
  Handler ofImage(Answer answer) {
    return [this, answer](const httplib::Request& request, httplib::Response& response) {
      const NumberedImage image = render.image();
      if (!image.image) return refuse(response, 404, "no image yet");
      try {
        answer(image, request, response);
      } catch (const InputError& error) {
        refuse(response, 400, error.what());
      }
    };
  }

  void addRoutes(bool saves) {
    http_.Get("/", [](const auto&, auto& response) {
      response.set_content(kPreviewPage, "text/html; charset=utf-8");
    });
    http_.Get("/preview.js", [](const auto&, auto& response) {
      response.set_content(kPreviewScript, "text/javascript; charset=utf-8");
    });
    http_.Get("/status.json", [this](const auto&, auto& response) {
      response.set_content(jsonText(render.status()), "application/json");
    });
    http_.Get("/image.png",
              ofImage([this](const NumberedImage& image, const auto& request, auto& response) {
                const std::vector<uint8_t> png = pngOf(image.image->image, viewOf(request));
                response.set_content(reinterpret_cast<const char*>(png.data()), png.size(),
                                     "image/png");
                response.set_header("X-Image", std::to_string(image.number));
                render.hasSent(image.number);
              }));
    http_.Get(
        "/pixel.json", ofImage([](const NumberedImage& image, const auto& request, auto& response) {
          const int x = numberOf(request, "x", 0), y = numberOf(request, "y", 0);
          response.set_content(jsonText(valuesAt(image.image->image, x, y)), "application/json");
        }));
    http_.Post("/save", [this, saves](const auto&, auto& response) {
      if (!saves) return refuse(response, 409, "a frame is written when it is finished");
      render.askForFiles();
    });
    http_.Post("/stop", [this](const auto&, auto&) { stop_(); });
  }

  std::function<void()> stop_;
  httplib::Server http_;
  int port_ = -1;
  std::promise<void> ended_;
};

PreviewServer::PreviewServer(int port, bool saves, std::function<void()> stop)
    : server_(std::make_shared<Server>(port, saves, std::move(stop))),
      thread_([server = server_] { server->run(); }) {}

PreviewServer::~PreviewServer() {
  server_->render.waitUntilSeen();
  if (server_->stop())
    thread_.join();
  else
    thread_.detach();  // has its own share of the server
}

std::string PreviewServer::address() const {
  return fmt::format("http://127.0.0.1:{}/", server_->port());
}

void PreviewServer::begin(const std::string& name) { server_->render.begin(name); }

void PreviewServer::update(double fraction) { server_->render.update(fraction); }

bool PreviewServer::wantsImage() const { return server_->render.isWatched(); }

void PreviewServer::show(std::shared_ptr<const ImageSoFar> image) {
  server_->render.show(std::move(image));
}

bool PreviewServer::wantsFiles() const { return server_->render.wantsFiles(); }

void PreviewServer::wroteFiles() { server_->render.wroteFiles(); }

}  // namespace chromeball
