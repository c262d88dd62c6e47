// SPDX-License-Identifier: Apache-2.0
// Functions that the servers of pages for this machine share.
#pragma once

#include <httplib.h>

#include <charconv>
#include <cmath>
#include <string>

#include "base/error.h"

namespace chromeball {

// Makes the server answer programs of this machine, but not pages that other servers have sent to a
// browser. Requests are short, and nothing of them is stored.
void keepLocal(httplib::Server& server);

// Binds to 127.0.0.1. `port` 0: any that is free. Returns the port. Throws InputError.
int bindLocal(httplib::Server& server, int port);

void refuse(httplib::Response& response, int status, const std::string& reason);

// The number after `name=` in the address, finite. Throws InputError.
template <class T>
T numberOf(const httplib::Request& request, const char* name, T fallback) {
  if (!request.has_param(name)) return fallback;
  const std::string text = request.get_param_value(name);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(double(value)))
    throwInput("{}: `{}` is not a number", name, text);
  return value;
}

}  // namespace chromeball
