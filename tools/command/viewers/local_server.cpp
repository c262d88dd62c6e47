// SPDX-License-Identifier: Apache-2.0
#include "viewers/local_server.h"

#include <cctype>

#include "base/error.h"

namespace chromeball {
namespace {

constexpr const char* kHost = "127.0.0.1";
constexpr size_t kConnections = 8;  // browsers open six, and keep them

// Whether the host is a name of this machine. Another name could belong to a page from another
// server whose address was changed to this machine afterwards (DNS rebinding).
bool isLocal(std::string host) {
  for (char& c : host) c = char(std::tolower(uint8_t(c)));
  if (const size_t scheme = host.find("://"); scheme != std::string::npos)
    host = host.substr(scheme + 3);
  host = host.substr(0, host.rfind(':'));
  return host == "127.0.0.1" || host == "localhost" || host == "[::1]";
}

bool isAllowed(const httplib::Request& request) {
  return isLocal(request.get_header_value("Host")) &&
         (!request.has_header("Origin") || isLocal(request.get_header_value("Origin")));
}

}  // namespace

void keepLocal(httplib::Server& server) {
  server.new_task_queue = [] { return new httplib::ThreadPool(kConnections); };
  server.set_payload_max_length(1024);
  server.set_read_timeout(2);  // seconds: a request that never ends holds a connection so long
  // Not SO_REUSEPORT, the library's choice, with which two renders could share a port.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.set_default_headers({{"Cache-Control", "no-store"}});
  server.set_pre_routing_handler([](const auto& request, auto& response) {
    if (isAllowed(request)) return httplib::Server::HandlerResponse::Unhandled;
    refuse(response, 403, "only for pages of this machine");
    return httplib::Server::HandlerResponse::Handled;
  });
}

int bindLocal(httplib::Server& server, int port) {
  int bound = -1;
  if (port == 0)
    bound = server.bind_to_any_port(kHost);
  else if (server.bind_to_port(kHost, port))
    bound = port;
  if (bound < 0) throwInput("--preview: port {} is in use, or not allowed; give another", port);
  return bound;
}

void refuse(httplib::Response& response, int status, const std::string& reason) {
  response.status = status;
  response.set_content(reason + "\n", "text/plain");
}

}  // namespace chromeball
