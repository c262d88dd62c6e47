// SPDX-License-Identifier: Apache-2.0
// A render in the background.
#pragma once

#include <memory>
#include <optional>

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

  const Image& color() const { return image.layers.front().image; }
};

// Loads and renders a description in a thread of its own, hands out what there is so far without
// stopping those that render, and takes other descriptions, of which it redoes only what differs
// from the one before. After update() the picture has the bits of a new session's.
//
// Its functions may be called from any thread, by one at a time. Errors of the background thread
// (InputError, RunError) are thrown by the next wait().
class Session {
 public:
  explicit Session(RenderDescription description);
  ~Session();  // cancels
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // Begins, if it has not begun: reads files, builds structures and renders.
  void start();
  // Stops as soon as the step or the tiles in work are finished.
  void cancel();
  // Cancels, and takes another description, for the next start().
  void update(RenderDescription description);

  bool isRunning() const;
  double fraction() const;  // of the render's work that is done; NaN if unknown
  // Waits for the end of the render. Throws Interrupted if it was cancelled before it rendered.
  const SessionImage& wait();
  // What there is, also while it renders; not denoised. nullopt before the first samples, and for a
  // reference of two passes. A session takes the memory of the film twice.
  std::optional<SessionImage> snapshot();
  // Notes and warnings of the files and the description; after wait().
  Messages messages() const;

  // What the last start() did, after wait().
  struct Work {
    bool loadedScene = false, loadedProbe = false, preparedLighting = false;
    int meshBuilds = 0;  // structures over meshes, by all starts so far
  };
  Work work() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> own_;
};

}  // namespace chromeball
