// SPDX-License-Identifier: Apache-2.0
// Values of Python as values of a scene file.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/typing.h>

#include <string>

#include "front/toml_section.h"

namespace chromeball::python {

namespace nb = nanobind;

using Dict = nb::typed<nb::dict, nb::str, nb::any>;  // the type of arguments in stubs

// Numbers, strings, paths, dicts, sequences, and numpy's scalars and arrays; None is left out.
// Throws InputError, begun by `name`, for anything else.
toml::table tableOf(const nb::dict& values, const std::string& name);

// Throws InputError, begun by `name`, for a string that is no valid Unicode: one with a surrogate.
std::string textOf(nb::handle string, const std::string& name);

}  // namespace chromeball::python
