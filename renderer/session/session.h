// SPDX-License-Identifier: Apache-2.0
// A render in the background.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/message.h"
#include "description/render_description.h"
#include "image/io/write_image.h"

namespace chromeball {

// An image with its layers, during a render or after it.
struct SessionImage {
  OutputImage image;        // the colour first, linear RGB or RGBA
  double samples = 0;       // mean per pixel
  double noise = 0;         // of the colour (film/noise.h), a fraction; NaN if unknown
  bool isComplete = false;  // else the render goes on, or was cancelled
  Messages messages = {};   // of the render
  // JSON, as `chromeball render --stats` writes it; after wait(), else empty.
  std::string statistics = {};

  const Image& color() const { return image.layers.front().image; }
};

// What a session is doing. Stages of preparing: "models", "textures", "probe", "local scene",
// "acceleration structures", "lighting"; some may be absent, or come again. Then "render", which
// includes photons, caches and denoising.
struct SessionProgress {
  const char* stage;
  double fraction;  // of the stage, from 0 on; NaN if unknown
};

// All are called in the session's own thread, one at a time, between start() and the end of wait(),
// cancel() or update(), and may be empty. They may call Session::requestCancel(), isRunning() and
// fraction(). An exception that one throws ends the render, and is thrown by wait().
struct SessionCallbacks {
  std::function<void(const SessionProgress&)> progress = {};
  std::function<void(const Message&)> message = {};  // notes and warnings, when they are known
  std::function<void()> finished = {};  // the last one of each start, also of one that failed
  SettingWords words = plainWords;      // in messages about the image
};

// Loads and renders a description in a background thread, hands out the image so far without
// stopping the render, and accepts further descriptions, for which it redoes only what differs from
// the one before, or in its files by now. After update() the picture has the same bits as a new
// session's.
//
// Its functions may be called from any thread, but by one thread at a time. The next wait() throws
// errors of the background thread (InputError, RunError).
class Session {
 public:
  explicit Session(RenderDescription description, SessionCallbacks callbacks = {});
  ~Session();  // as update()
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // Begins, if it has not begun: reads files, builds structures and renders.
  void start();
  // Asks the work to end, without waiting; may be called from any thread at any time. Preparing
  // ends within tens of milliseconds; a render ends when the tiles in work are finished, and its
  // image is made from the samples so far.
  void requestCancel();
  // The same, and waits.
  void cancel();
  // Ends any work within tens of milliseconds, without an image. Takes another description, for the
  // next start().
  void update(RenderDescription description);

  bool isRunning() const;
  double fraction() const;  // of the render's work that is done; NaN if unknown
  // Waits for the end of the render. Throws Interrupted if it was cancelled before it rendered, and
  // std::logic_error without start(). The image is valid until the next start(), update() or the
  // destructor; its metadata are those of the command's .exr.
  const SessionImage& wait();
  // The image so far, also during the render: not denoised, without the layer `variance`, and with
  // the noise after the last pass over the image. Null before the first samples, and for a
  // reference of two passes. Costs little if the snapshot before the last one is not in use any
  // more.
  std::shared_ptr<const SessionImage> snapshot();
  // Notes and warnings of the files and the description; after wait().
  Messages messages() const;

  // What the last start() has done; valid after wait().
  struct Work {
    bool loadedScene = false;  // read, and structures built over it
    bool loadedProbe = false;  // read or converted; one that has only turned is not
    bool preparedLighting = false;
    // Structures over meshes that instances transform (the others are in the scene's own), built by
    // all starts so far: a mesh that moved, or came again in another scene, is not built again.
    int meshBuilds = 0;
  };
  Work work() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> own_;
};

}  // namespace chromeball
