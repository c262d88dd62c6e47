// SPDX-License-Identifier: Apache-2.0
#include "preview_render.h"
#include "json_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "image/io/write_image.h"
#include "small_model.h"
#include "tcp.h"

namespace chromeball {

PreviewRender::PreviewRender() : port_(freePort()) {
  writeSmallModel(folder / "m.gltf");
  Image probe(4, 2, 3);
  probe.texels.assign(probe.texels.size(), 0.7f);
  probe.setRgb(1, 0, Rgb(9, 4, 1));
  writeImage(folder / "probe.pfm", probe);
}

void PreviewRender::start(const std::vector<std::string>& more, const std::string& out) {
  out_ = folder / out;
  std::vector<std::string> words{"render",
                                 folder / "m.gltf",
                                 "--probe",
                                 folder / "probe.pfm",
                                 "--size",
                                 "40x30",
                                 "-o",
                                 out_,
                                 fmt::format("--preview={}", port_)};
  words.insert(words.end(), more.begin(), more.end());
  command_ = std::async(std::launch::async, [words] { return runCommand(words); });
}

HttpAnswer PreviewRender::get(const std::string& target, const std::string& headers) const {
  return exchange("GET " + target + " HTTP/1.1\r\n" + headers + "Connection: close\r\n\r\n");
}

HttpAnswer PreviewRender::post(const std::string& target, const std::string& headers,
                               const std::string& body) const {
  return exchange(
      fmt::format("POST {} HTTP/1.1\r\n{}Content-Length: {}\r\n"
                  "Connection: close\r\n\r\n{}",
                  target, headers, body.size(), body));
}

void PreviewRender::waitUntil(const std::function<bool(const nlohmann::json&)>& holds) const {
  HttpAnswer answer;
  for (int i = 0; i < 1500; ++i, usleep(20'000)) {
    answer = get("/status.json");
    if (answer.status == 200 && holds(parseJson(answer.body))) return;
  }
  ADD_FAILURE() << "waited in vain; the last status: " << answer.status << ' ' << answer.body;
}

void PreviewRender::waitForImage() const {
  waitUntil([](const nlohmann::json& status) { return status["image"] > 0; });
}

HttpAnswer PreviewRender::exchange(const std::string& request) const {
  const Socket socket = connectTo(port_);
  if (!socket.isOpen()) return {};
  socket.write(request);
  const std::string answer = socket.read(100'000'000);
  const size_t end = answer.find("\r\n\r\n");
  if (end == std::string::npos) return {};
  return {std::stoi(answer.substr(answer.find(' '))), answer.substr(end + 4)};
}

}  // namespace chromeball
