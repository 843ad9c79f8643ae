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
  int port = 0;                          ///< 0: any free port
  std::string token;                     ///< empty: a random token
  std::size_t body_bytes = 1024 * 1024;  ///< of a request
  std::size_t threads = 96;  ///< one per connection; an event stream keeps its thread until it ends
  /// The number of connections that wait for a thread. The server accepts no more than this.
  /// Further connections wait in the queue of the operating system. There they use no file
  /// descriptor of this process, which needs some to store labels.
  std::size_t waiting = 64;
  ConnectionLimits limits;
};

/// An HTTP/1.1 server on the local machine only (127.0.0.1 and, if available, ::1), protected by
/// `HttpGuard`.
class HttpServer {
 public:
  /// Binds the port. Throws StorageError if the port is in use.
  explicit HttpServer(const HttpServerOptions& options);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// The address to open in a browser, with the token.
  [[nodiscard]] std::string address() const;
  [[nodiscard]] int port() const;

  /// Answers requests with `handler` (from many threads) until `stop`. If `handler` throws, the
  /// answer has status 500.
  void start(HttpHandler handler);
  /// Accepts no more requests and waits for the running ones. End the event streams before.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbook
