#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "apps/label_server/http/connection.hpp"
#include "apps/label_server/http/http_guard.hpp"
#include "apps/label_server/http/http_message.hpp"

namespace roadbook {

struct HttpServerOptions {
  int port = 0;                          ///< 0: any that is free
  std::string token;                     ///< empty: a random one
  std::size_t body_bytes = 1024 * 1024;  ///< of a request
  std::size_t threads = 96;  ///< one a connection; event streams hold theirs as long as they last
  /// Connections that wait for a thread. More are not taken yet: they wait in the system's own
  /// line, and hold no file of this process, which needs some to store labels.
  std::size_t waiting = 64;
  ConnectionLimits limits;
};

/// HTTP/1.1 on this machine alone (127.0.0.1 and, where there is one, ::1), behind `HttpGuard`.
class HttpServer {
 public:
  /// Binds. Throws StorageError where the port is taken.
  explicit HttpServer(const HttpServerOptions& options);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// With the token: what to open in a browser.
  [[nodiscard]] std::string address() const;
  [[nodiscard]] int port() const;

  /// Answers with `handler` (called from many threads) until `stop`. An exception it lets out is
  /// answered with status 500.
  void start(HttpHandler handler);
  /// Takes no more requests and waits for those that run; end event streams before.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbook
