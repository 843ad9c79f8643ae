#pragma once

#include <optional>
#include <string>

#include "apps/label_server/http/http_message.hpp"

namespace roadbook {

/// Decides which clients may use the server: pages that the server has sent itself, with the token
/// that it printed.
///
/// Any other page in the same browser can also send requests to this machine. Such a page does not
/// know the token and cannot set the right Origin. If its own host name points to this machine (DNS
/// rebinding), the Host field is not this server's address.
class HttpGuard {
 public:
  HttpGuard(int port, std::string token);

  /// Returns the answer to a request that the guard refuses, before the server reads the body.
  /// Empty if the request may pass.
  [[nodiscard]] std::optional<HttpResponse> refuse(const HttpRequest& request) const;

  /// Handles the printed address `/?token=...`. Stores the token in a cookie and redirects to `/`,
  /// so that the token disappears from the address. Empty for other requests.
  [[nodiscard]] std::optional<HttpResponse> enter(const HttpRequest& request) const;

  [[nodiscard]] const std::string& token() const { return token_; }

 private:
  [[nodiscard]] bool is_host(const std::string& host) const;
  [[nodiscard]] bool has_token(const HttpRequest& request) const;
  [[nodiscard]] std::string cookie_name() const;

  int port_;
  std::string token_;
};

/// Adds the safety header fields of every answer: no foreign or inline script, no frame, no
/// guessing of content types.
void add_safety_fields(HttpResponse* response);

/// 32 hexadecimal digits from the system's random source. Throws StorageError.
[[nodiscard]] std::string random_token();

/// {"error": message} with a status.
[[nodiscard]] HttpResponse error_response(int status, const std::string& message);

}  // namespace roadbook
