// SPDX-License-Identifier: Apache-2.0
// The library's exceptions in Python.
#include <nanobind/nanobind.h>

#include "base/error.h"
#include "bindings.h"
#include "messages.h"

namespace chromeball::python {
namespace {

struct Types {
  PyObject *input, *run;
};

void translate(const std::exception_ptr& error, void* payload) {
  const Types& types = *static_cast<const Types*>(payload);
  try {
    std::rethrow_exception(error);
  } catch (const InputError& e) {
    PyErr_SetString(types.input, (e.what() + inWords(e.remedy)).c_str());
  } catch (const RunError& e) {
    PyErr_SetString(types.run, e.what());
  } catch (const Interrupted& e) {
    PyErr_SetString(types.run, e.what());
  }
}

}  // namespace

void bindErrors(nb::module_& m) {
  static Types types = {PyExc_ValueError, PyExc_RuntimeError};  // as long as the process
  nb::register_exception_translator(translate, &types);
  m.def(
      "set_errors",
      [](nb::type_object input, nb::type_object run) {
        types = {input.release().ptr(), run.release().ptr()};
      },
      nb::arg("input"), nb::arg("run"), "The classes of errors of input, and at run time.");
}

}  // namespace chromeball::python
