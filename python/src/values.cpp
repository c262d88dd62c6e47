// SPDX-License-Identifier: Apache-2.0
#include "values.h"

#include <nanobind/stl/string.h>

#include <limits>

namespace chromeball::python {
namespace {

constexpr int kMostLevels = 16;

// Appends the value, but None. (Not a template over what takes it: that would never end.)
void append(nb::handle value, const std::string& where, int level, toml::array& to);

template <class Sequence>
toml::array arrayOf(const Sequence& sequence, const std::string& where, int level) {
  toml::array array;
  for (const nb::handle item : sequence) append(item, where, level + 1, array);
  return array;
}

toml::table tableOf(const nb::dict& values, const std::string& where, int level) {
  toml::table table;
  for (const auto [key, item] : values) {
    if (!nb::isinstance<nb::str>(key))
      throwInput("{}: a key is {}; it should be a string", where, nb::repr(key).c_str());
    const std::string name = textOf(key, where + ": a key");
    toml::array one;
    append(item, where + "." + name, level + 1, one);
    if (!one.empty())
      one[0].visit([&](auto& node) { table.insert_or_assign(name, std::move(node)); });
  }
  return table;
}

void append(nb::handle value, const std::string& where, int level, toml::array& to) {
  if (level > kMostLevels) throwInput("{}: is nested more than {} levels deep", where, kMostLevels);
  PyObject* p = value.ptr();
  if (value.is_none()) return;
  if (PyBool_Check(p)) {
    to.push_back(p == Py_True);
  } else if (PyFloat_Check(p)) {
    to.push_back(PyFloat_AsDouble(p));
  } else if (PyLong_Check(p)) {
    int overflow = 0;
    const long long number = PyLong_AsLongLongAndOverflow(p, &overflow);
    if (overflow != 0)
      to.push_back(overflow * std::numeric_limits<double>::infinity());
    else
      to.push_back(int64_t(number));
  } else if (PyUnicode_Check(p)) {
    to.push_back(textOf(value, where));
  } else if (nb::isinstance<nb::dict>(value)) {
    to.push_back(tableOf(nb::borrow<nb::dict>(value), where, level));
  } else if (nb::isinstance<nb::list>(value)) {
    to.push_back(arrayOf(nb::borrow<nb::list>(value), where, level));
  } else if (nb::isinstance<nb::tuple>(value)) {
    to.push_back(arrayOf(nb::borrow<nb::tuple>(value), where, level));
  } else if (nb::hasattr(value, "__fspath__")) {
    append(value.attr("__fspath__")(), where, level + 1, to);
  } else if (nb::hasattr(value, "tolist")) {  // an array, or a scalar of numpy
    append(value.attr("tolist")(), where, level + 1, to);
  } else if (PyIndex_Check(p)) {
    append(nb::steal(PyNumber_Index(p)), where, level + 1, to);
  } else {
    throwInput("{}: is of the type {}; it should be a number, a string, a list or a dict", where,
               nb::type_name(value.type()).c_str());
  }
}

}  // namespace

std::string textOf(nb::handle string, const std::string& name) {
  Py_ssize_t size = 0;
  if (const char* text = PyUnicode_AsUTF8AndSize(string.ptr(), &size)) return {text, size_t(size)};
  PyErr_Clear();
  throwInput("{}: {} is no valid text", name, nb::repr(string).c_str());
}

toml::table tableOf(const nb::dict& values, const std::string& name) {
  return tableOf(values, name, 0);
}

}  // namespace chromeball::python
