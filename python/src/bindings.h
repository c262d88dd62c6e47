// SPDX-License-Identifier: Apache-2.0
// The parts of the module chromeball._core. The package chromeball checks the shapes and types of
// arrays (python/chromeball/_arrays.py), and is what users see.
#pragma once

#include <nanobind/nanobind.h>

namespace chromeball::python {

namespace nb = nanobind;

void bindErrors(nb::module_& m);
void bindGeometry(nb::module_& m);
void bindProbe(nb::module_& m);
void bindMaterialBsdf(nb::module_& m);
void bindPlan(nb::module_& m);
void bindResult(nb::module_& m);
void bindSession(nb::module_& m);
void bindStrategy(nb::module_& m);
void bindStudy(nb::module_& m);

}  // namespace chromeball::python
