// SPDX-License-Identifier: Apache-2.0
#include "viewers/relight_server.h"

#include "base/error.h"
#include "base/json.h"
#include "base/json_text.h"
#include "front/arguments.h"
#include "image/image.h"
#include "image/io/write_image.h"
#include "viewers/local_server.h"

namespace chromeball {

extern const char* const kRelightPage;
extern const char* const kRelightScript;

class RelightServer::Server {
 public:
  Server(int port, const RelightView& view) : view_(view) {
    keepLocal(http_);
    addRoutes();
    port_ = bindLocal(http_, port);
  }

  int port() const { return port_; }
  void run() { http_.listen_after_bind(); }

 private:
  void addRoutes() {
    http_.Get("/", [](const auto&, auto& response) {
      response.set_content(kRelightPage, "text/html; charset=utf-8");
    });
    http_.Get("/relight.js", [](const auto&, auto& response) {
      response.set_content(kRelightScript, "text/javascript; charset=utf-8");
    });
    http_.Get("/stage.json", [this](const auto&, auto& response) {
      response.set_content(jsonText(described()), "application/json");
    });
    answer("/picture", "application/octet-stream",
           [this](const httplib::Request& request) { return pictureOf(request); });
    answer("/probe.png", "image/png",
           [this](const httplib::Request& request) { return probeOf(request); });
    http_.Post("/stop", [this](const auto&, auto&) { http_.stop(); });
  }

  template <class Bytes>
  void answer(const char* path, const char* type, Bytes bytesOf) {
    http_.Get(path, [type, bytesOf](const httplib::Request& request, httplib::Response& response) {
      try {
        const std::vector<uint8_t> bytes = bytesOf(request);
        response.set_content(reinterpret_cast<const char*>(bytes.data()), bytes.size(), type);
      } catch (const InputError& error) {
        refuse(response, 400, error.what());
      }
    });
  }

  nlohmann::json described() const {
    nlohmann::json json{{"width", view_.stage().width()},
                        {"height", view_.stage().height()},
                        {"basis", view_.stage().basis.name()},
                        {"probes", nlohmann::json::array()}};
    for (const NamedProbe& probe : view_.probes()) json["probes"].push_back(probe.name);
    return json;
  }

  size_t indexOf(const httplib::Request& request) const {
    const auto index = numberOf<size_t>(request, "probe", 0);
    if (index >= view_.probes().size()) throwInput("probe: there is none with this number");
    return index;
  }

  std::vector<uint8_t> pictureOf(const httplib::Request& request) const {
    const std::vector<double> angles{numberOf(request, "yaw", 0.0), numberOf(request, "pitch", 0.0),
                                     numberOf(request, "roll", 0.0)};
    const DisplayTransform display{
        parseToneOperator(request.has_param("tonemap") ? request.get_param_value("tonemap")
                                                       : "none"),
        numberOf(request, "exposure", 0.0f)};
    return view_.picture(indexOf(request), parseRotation(angles, "yaw, pitch, roll"), display);
  }

  std::vector<uint8_t> probeOf(const httplib::Request& request) const {
    return encodePng(resampled(view_.probes()[indexOf(request)].map, 256, 128),
                     {parseToneOperator("reinhard"), 0});
  }

  const RelightView& view_;
  httplib::Server http_;
  int port_ = -1;
};

RelightServer::RelightServer(int port, const RelightView& view)
    : server_(std::make_unique<Server>(port, view)) {}

RelightServer::~RelightServer() = default;

std::string RelightServer::address() const {
  return fmt::format("http://127.0.0.1:{}/", server_->port());
}

void RelightServer::run() { server_->run(); }

}  // namespace chromeball
