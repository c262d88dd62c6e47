// SPDX-License-Identifier: Apache-2.0
#include "viewers/preview_server.h"

#include <httplib.h>

#include <cctype>
#include <charconv>
#include <future>

#include "base/error.h"
#include "viewers/preview_image.h"
#include "viewers/watched_render.h"

namespace chromeball {

extern const char* const kPreviewPage;
extern const char* const kPreviewScript;

namespace {

// A name of this machine. Other names could be those of a page that another server has sent, whose
// address was changed to this machine afterwards (DNS rebinding).
bool isLocal(std::string host) {
  for (char& c : host) c = char(std::tolower(uint8_t(c)));
  if (const size_t scheme = host.find("://"); scheme != std::string::npos)
    host = host.substr(scheme + 3);
  host = host.substr(0, host.rfind(':'));
  return host == "127.0.0.1" || host == "localhost" || host == "[::1]";
}

bool isAllowed(const httplib::Request& request) {
  return isLocal(request.get_header_value("Host")) &&
         (!request.has_header("Origin") || isLocal(request.get_header_value("Origin")));
}

// The number after `name=` in the address. Throws InputError.
template <class T>
T numberOf(const httplib::Request& request, const char* name, T fallback) {
  if (!request.has_param(name)) return fallback;
  const std::string text = request.get_param_value(name);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throwInput("{}: `{}` is not a number", name, text);
  return value;
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
    http_.new_task_queue = [] { return new httplib::ThreadPool(kConnections); };
    http_.set_payload_max_length(1024);
    // Not SO_REUSEPORT, the library's choice, with which two renders could share a port.
    http_.set_socket_options([](socket_t socket) {
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    addRoutes(saves);
    if (port == 0)
      port_ = http_.bind_to_any_port(kHost);
    else
      port_ = http_.bind_to_port(kHost, port) ? port : -1;
    if (port_ < 0) throwInput("--preview: port {} is in use, or not allowed; give another", port);
  }

  // On a thread, until stop().
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
  static constexpr const char* kHost = "127.0.0.1";
  static constexpr size_t kConnections = 8;  // browsers open six, and keep them

  using Handler = std::function<void(const httplib::Request&, httplib::Response&)>;

  static void refuse(httplib::Response& response, int status, const std::string& reason) {
    response.status = status;
    response.set_content(reason + "\n", "text/plain");
  }

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
    http_.set_default_headers({{"Cache-Control", "no-store"}});
    http_.set_pre_routing_handler([](const auto& request, auto& response) {
      if (isAllowed(request)) return httplib::Server::HandlerResponse::Unhandled;
      refuse(response, 403, "only for pages of this machine");
      return httplib::Server::HandlerResponse::Handled;
    });
    http_.Get("/", [](const auto&, auto& response) {
      response.set_content(kPreviewPage, "text/html; charset=utf-8");
    });
    http_.Get("/preview.js", [](const auto&, auto& response) {
      response.set_content(kPreviewScript, "text/javascript; charset=utf-8");
    });
    http_.Get("/status.json", [this](const auto&, auto& response) {
      response.set_content(render.status().dump(), "application/json");
    });
    http_.Get("/image.png",
              ofImage([this](const NumberedImage& image, const auto& request, auto& response) {
                const std::vector<uint8_t> png = pngOf(image.image->image, viewOf(request));
                response.set_content(reinterpret_cast<const char*>(png.data()), png.size(),
                                     "image/png");
                response.set_header("X-Image", std::to_string(image.number));
                render.hasSent(image.number);
              }));
    http_.Get("/pixel.json",
              ofImage([](const NumberedImage& image, const auto& request, auto& response) {
                const int x = numberOf(request, "x", 0), y = numberOf(request, "y", 0);
                response.set_content(valuesAt(image.image->image, x, y).dump(), "application/json");
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
