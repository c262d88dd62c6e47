// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>

#include "description/render_description.h"

namespace chromeball::python {

// A render, and what the library leaves to programs.
struct Plan {
  RenderDescription description;
  size_t threads = 0;         // 0: one for each core
  nanobind::object strategy;  // which the description calls, or None
};

}  // namespace chromeball::python
