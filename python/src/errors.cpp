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
  static Types types;  // as long as the process
  types.input = PyErr_NewExceptionWithDoc(
      "chromeball.InputError", "What was given is wrong; the message says what would be right.",
      PyExc_ValueError, nullptr);
  types.run = PyErr_NewExceptionWithDoc("chromeball.RunError",
                                        "Something failed while it ran, such as a full disk, or "
                                        "was cancelled before it had rendered.",
                                        PyExc_RuntimeError, nullptr);
  m.attr("InputError") = nb::handle(types.input);
  m.attr("RunError") = nb::handle(types.run);
  nb::register_exception_translator(translate, &types);
}

}  // namespace chromeball::python
