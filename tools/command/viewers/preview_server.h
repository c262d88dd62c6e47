// SPDX-License-Identifier: Apache-2.0
// chromeball render --preview: a page that shows a render while it grows.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "session/viewer.h"

namespace chromeball {

// Serves http://127.0.0.1:PORT/ on threads of its own. Programs of this machine can reach it, but
// not other machines, nor pages that other servers have sent to a browser.
//
//   GET /             the page
//   GET /status.json  what is rendered, how far it is, the layers
//   GET /image.png?layer=NAME&tonemap=NAME&exposure=STOPS&width=PIXELS
//                     the pixels of `chromeball image view`, reduced if wider
//   GET /pixel.json?x=X&y=Y      the values of all layers
//   POST /save, POST /stop       writes the output files now; ends the render as Ctrl-C does
class PreviewServer : public Viewer {
 public:
  // `port` 0: any that is free. Throws InputError if it cannot be opened. `saves`: whether the
  // files may be written before the end. `stop` is called from another thread.
  PreviewServer(int port, bool saves, std::function<void()> stop);
  // Lets pages that are open fetch the last image, for a few seconds at most.
  ~PreviewServer() override;

  std::string address() const;

  void begin(const std::string& name) override;
  void update(double fraction) override;
  bool wantsImage() const override;  // if a page is open
  void show(std::shared_ptr<const ImageSoFar> image) override;
  bool wantsFiles() const override;
  void wroteFiles() override;

 private:
  class Server;
  std::shared_ptr<Server> server_;
  std::thread thread_;
};

}  // namespace chromeball
