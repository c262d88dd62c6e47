// SPDX-License-Identifier: Apache-2.0
#include "viewers/preview_server.h"

#include <future>

#include "base/error.h"
#include "base/json_text.h"
#include "viewers/local_server.h"
#include "viewers/preview_image.h"
#include "viewers/watched_render.h"

namespace chromeball {

extern const char* const kPreviewPage;
extern const char* const kPreviewScript;

namespace {

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
