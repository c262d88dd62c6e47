// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "description/render_description.h"
#include "session/session.h"

namespace chromeball::python {

// The image of a session, and how it is to be shown.
struct Result {
  std::shared_ptr<const SessionImage> image;
  OutputDescription output;
  Messages messages;  // of the files, and of the render
};

}  // namespace chromeball::python
