// SPDX-License-Identifier: Apache-2.0
#include "viewers/viewers.h"

#include "base/error.h"
#include "viewers/preview_server.h"
#include "viewers/tev_display.h"

namespace chromeball {
namespace {

// The address in "tev" or "tev=HOST:PORT". Throws InputError.
std::string tevAddress(const std::string& display) {
  constexpr std::string_view kDefault = "127.0.0.1:14158";  // tev's own
  if (display == "tev") return std::string(kDefault);
  if (display.starts_with("tev=")) return display.substr(4);
  throwInput("--display: `{}` is not tev or tev=HOST:PORT", display);
}

}  // namespace

Viewers::Viewers(const Settings& settings, std::function<void()> stop) {
  if (const auto display = settings.getIfGiven<std::string>("display"))
    viewers_.push_back(std::make_unique<TevDisplay>(tevAddress(*display)));
  if (const auto port = settings.getIfGiven<uint64_t>("preview")) {
    auto server =
        std::make_unique<PreviewServer>(int(*port), !settings.has("frames"), std::move(stop));
    addNote(messages_, "preview at {}", server->address());
    viewers_.push_back(std::move(server));
  }
}

std::vector<Viewer*> Viewers::all() const {
  std::vector<Viewer*> all;
  for (const std::unique_ptr<Viewer>& viewer : viewers_) all.push_back(viewer.get());
  return all;
}

}  // namespace chromeball
