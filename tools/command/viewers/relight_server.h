// SPDX-License-Identifier: Apache-2.0
// chromeball relight --preview: a page on which a probe is turned and swapped, and the picture
// follows.
#pragma once

#include <memory>
#include <string>

#include "viewers/relight_view.h"

namespace chromeball {

// Serves http://127.0.0.1:PORT/ to this machine alone (local_server.h).
//
//   GET /               the page
//   GET /stage.json     the picture's size, the names of the probes
//   GET /picture?probe=INDEX&yaw=DEG&pitch=DEG&roll=DEG&exposure=STOPS&tonemap=NAME
//                       RelightView::picture()
//   GET /probe.png?probe=INDEX      its map, for display
//   POST /stop          ends run()
class RelightServer {
 public:
  // `port` 0: any that is free. Throws InputError if it cannot be opened. `view` must outlive this.
  RelightServer(int port, const RelightView& view);
  ~RelightServer();

  std::string address() const;
  void run();

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

}  // namespace chromeball
