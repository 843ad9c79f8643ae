#pragma once

#include <optional>
#include <string>

#include "apps/label_server/http/http_message.hpp"

namespace roadbook {

/// Who may talk to the server: pages it served itself, with the token that it printed.
///
/// Any other page in the same browser can send requests to this machine too. It does not know the
/// token, cannot give the right Origin, and a name that it has pointed here is no exact Host.
class HttpGuard {
 public:
  HttpGuard(int port, std::string token);

  /// The answer to a request that is refused, before its body is read; empty where it may pass.
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

/// Header fields of every answer: no foreign or inline script, no frame, no guessing of types.
void add_safety_fields(HttpResponse* response);

/// 32 hexadecimal digits from the system's random source. Throws StorageError.
[[nodiscard]] std::string random_token();

/// {"error": message} with a status.
[[nodiscard]] HttpResponse error_response(int status, const std::string& message);

}  // namespace roadbook
