#include "apps/label_server/http/http_guard.hpp"

#include <sys/random.h>

#include <array>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.hpp"

namespace roadbook {
namespace {

// Compares in constant time, so that the duration does not reveal how many characters are correct.
bool same_secret(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned char difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference = static_cast<unsigned char>(
        difference | (static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i])));
  return difference == 0;
}

std::string cookie(const std::string& cookies, const std::string& name) {
  std::istringstream parts(cookies);
  for (std::string part; std::getline(parts, part, ';');) {
    part.erase(0, part.find_first_not_of(' ') == std::string::npos ? part.size()
                                                                   : part.find_first_not_of(' '));
    if (part.rfind(name + "=", 0) == 0) return part.substr(name.size() + 1);
  }
  return {};
}

bool is_reading(const HttpRequest& request) {
  return request.method == "GET" || request.method == "HEAD";
}

}  // namespace

HttpResponse error_response(int status, const std::string& message) {
  HttpResponse response;
  response.status = status;
  response.body = nlohmann::json({{"error", message}})
                      .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return response;
}

HttpGuard::HttpGuard(int port, std::string token) : port_(port), token_(std::move(token)) {}

std::string HttpGuard::cookie_name() const { return "roadbook_" + std::to_string(port_); }

bool HttpGuard::is_host(const std::string& host) const {
  const std::string port = ":" + std::to_string(port_);
  return host == "127.0.0.1" + port || host == "[::1]" + port || host == "localhost" + port;
}

bool HttpGuard::has_token(const HttpRequest& request) const {
  const std::string bearer = "Bearer ";
  const std::string given = request.field("authorization");
  if (given.rfind(bearer, 0) == 0) return same_secret(given.substr(bearer.size()), token_);
  return same_secret(cookie(request.field("cookie"), cookie_name()), token_);
}

std::optional<HttpResponse> HttpGuard::refuse(const HttpRequest& request) const {
  const std::string host = request.field("host");
  if (!is_host(host))
    return error_response(403, "Host: got another address, want this server's address");
  const std::string origin = request.field("origin");
  if (!origin.empty() && origin != "http://" + host)
    return error_response(403, "Origin: got another page, want this server's page");
  const std::string site = request.field("sec-fetch-site");
  if (!site.empty() && site != "same-origin" && site != "none")
    return error_response(403, "Sec-Fetch-Site: got another page, want this server's page");
  if (request.method != "GET" && request.method != "HEAD" && request.method != "POST" &&
      request.method != "PUT" && request.method != "DELETE")
    return error_response(405, "method: got another method, want GET, HEAD, POST, PUT or DELETE");
  if (!has_token(request))
    return error_response(
        401, "token: got no valid token, open the address that `roadbook label` printed");
  if (is_reading(request)) return std::nullopt;
  if (origin.empty()) return error_response(403, "Origin: got none, want this server's page");
  if (!request.fields.contains("content-length") || request.fields.contains("transfer-encoding") ||
      request.fields.contains("content-encoding"))
    return error_response(
        411, "body: got no Content-Length or an encoding, want a Content-Length and no encoding");
  // A longer number exceeds every limit. The check rejects other text, because the library accepts
  // text that only begins with a number.
  const std::string length = request.field("content-length");
  if (length.empty() || length.size() > 9 ||
      length.find_first_not_of("0123456789") != std::string::npos)
    return error_response(400, "Content-Length: got another text, want a number of bytes");
  const std::string type = request.field("content-type");
  if (type != "application/json" && type.rfind("application/json;", 0) != 0)
    return error_response(415, "Content-Type: got another type, want application/json");
  return std::nullopt;
}

std::optional<HttpResponse> HttpGuard::enter(const HttpRequest& request) const {
  if (request.method != "GET" || request.path != "/" || !is_host(request.field("host")))
    return std::nullopt;
  if (!same_secret(request.query, "token=" + token_)) return std::nullopt;
  HttpResponse response;
  response.status = 303;
  response.type = "text/plain";
  response.fields["Location"] = "/";
  response.fields["Set-Cookie"] =
      cookie_name() + "=" + token_ + "; Path=/; HttpOnly; SameSite=Strict";
  return response;
}

void add_safety_fields(HttpResponse* response) {
  auto& fields = response->fields;
  fields["Content-Security-Policy"] =
      "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
      "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
  fields["X-Content-Type-Options"] = "nosniff";
  fields["Referrer-Policy"] = "no-referrer";
  fields["Cross-Origin-Resource-Policy"] = "same-origin";
  fields.try_emplace("Cache-Control", "no-store");
}

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw StorageError("error: token: got no random bytes from the system");
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

}  // namespace roadbook
