// SPDX-License-Identifier: Apache-2.0
#include "viewers/relight_server.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/json.h"
#include "base/parallel.h"
#include "front/arguments.h"
#include "image/image.h"
#include "image/io/write_image.h"
#include "image/tonemap.h"
#include "messages.h"
#include "relight/stage/light_stage.h"
#include "relight/stage/relit_stage.h"
#include "viewers/local_server.h"

namespace chromeball {

extern const char* const kRelightPage;
extern const char* const kRelightScript;

namespace {

constexpr int kMapWidth = 512;

Image reduced(const Image& map) {
  if (map.width <= kMapWidth) return map;
  const int height = std::max(1, int(std::lround(double(map.height) * kMapWidth / map.width)));
  return resampled(map, kMapWidth, height);
}

// A light stage under probes that turn, fast enough to follow a hand.
class RelightView {
 public:
  // Maps wider than 512 texels are reduced to that.
  RelightView(LightStage stage, std::vector<NamedProbe> probes)
      : stage_(std::move(stage)), probes_(std::move(probes)) {
    for (NamedProbe& probe : probes_) probe.map = reduced(probe.map);
  }

  const LightStage& stage() const { return stage_; }
  const std::vector<NamedProbe>& probes() const { return probes_; }

  // The pixels for a screen, four bytes each: R, G, B, 255. Thread-safe.
  std::vector<uint8_t> picture(size_t probe, const Rotation& rotation,
                               const DisplayTransform& transform) const {
    Image sum = weightedSum(stage_.elements,
                            lightWeights(stage_.basis, probes_[probe].map, rotation, kMapWidth));
    addOwnLight(sum, stage_.own);
    std::vector<uint8_t> bytes(4 * size_t(sum.width) * size_t(sum.height));
    forRows(sum.width, sum.height, 16, [&](int y) {
      uint8_t* to = bytes.data() + 4 * size_t(y) * size_t(sum.width);
      for (int x = 0; x < sum.width; ++x) {
        const Rgb shown = display(transform, sum.rgb(x, y));
        for (int c = 0; c < 3; ++c) *to++ = uint8_t(std::lround(255 * linearToSrgb(shown[c])));
        *to++ = 255;
      }
    });
    return bytes;
  }

 private:
  LightStage stage_;
  std::vector<NamedProbe> probes_;
};

class RelightServer {
 public:
  // `view` must outlive this.
  RelightServer(int port, const RelightView& view) : view_(view) {
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

}  // namespace

void serveRelight(int port, LightStage stage, std::vector<NamedProbe> probes) {
  const RelightView view(std::move(stage), std::move(probes));
  RelightServer server(port, view);
  note("preview at http://127.0.0.1:{}/; Ctrl-C or its button ends it", server.port());
  server.run();
}

}  // namespace chromeball
