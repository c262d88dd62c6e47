// SPDX-License-Identifier: Apache-2.0
// A small render with --preview, and requests to its server.
#pragma once

#include <functional>
#include <future>
#include <string>
#include <vector>

#include "base/json.h"
#include "run_command.h"

namespace chromeball {

struct HttpAnswer {
  int status = 0;  // 0: no answer
  std::string body;
};

class PreviewRender {
 public:
  TemporaryFolder folder;

  PreviewRender();

  void start(const std::vector<std::string>& more, const std::string& out = "o.exr");
  CommandResult result() { return command_.get(); }

  int port() const { return port_; }
  const std::string& out() const { return out_; }

  HttpAnswer get(const std::string& target,
                 const std::string& headers = "Host: 127.0.0.1\r\n") const;
  HttpAnswer post(const std::string& target, const std::string& headers = "Host: 127.0.0.1\r\n",
                  const std::string& body = "") const;

  // Asks for the status until `holds`; fails after half a minute.
  void waitUntil(const std::function<bool(const nlohmann::json&)>& holds) const;
  void waitForImage() const;

 private:
  HttpAnswer exchange(const std::string& request) const;

  int port_;
  std::string out_;
  std::future<CommandResult> command_;
};

}  // namespace chromeball
