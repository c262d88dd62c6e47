// SPDX-License-Identifier: Apache-2.0
// The viewers that the options of a render ask for.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "base/message.h"
#include "front/settings.h"
#include "session/viewer.h"

namespace chromeball {

class Viewers {
 public:
  // Opens the viewers of --preview and --display. `stop` ends the render; it may be called from
  // other threads. Throws InputError.
  Viewers(const Settings& settings, std::function<void()> stop);

  std::vector<Viewer*> all() const;
  Messages messages() const { return messages_; }  // where to look

 private:
  std::vector<std::unique_ptr<Viewer>> viewers_;
  Messages messages_;
};

}  // namespace chromeball
