// SPDX-License-Identifier: Apache-2.0
// A lighting strategy that is written in Python.
#pragma once

#include <nanobind/nanobind.h>

#include <functional>
#include <memory>

#include "lighting/light_source.h"
#include "probe/probe.h"

namespace chromeball::python {

namespace nb = nanobind;

// Makes the strategy for LightingDescription::make. `checked` is a CheckedStrategy
// (python/chromeball/_strategy.py), which must live as long as the render; its exceptions end that.
std::function<std::unique_ptr<LightSource>(const Probe&, const glm::dvec3& origin)> makerOf(
    nb::handle checked);

}  // namespace chromeball::python
