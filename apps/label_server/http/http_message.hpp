#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "apps/label_server/http/event_hub.hpp"

namespace roadbook {

struct HttpRequest {
  std::string method;
  std::string path;                           ///< decoded, without the query
  std::string query;                          ///< as sent
  std::map<std::string, std::string> fields;  ///< header; names in lower case
  std::string body;

  [[nodiscard]] std::string field(const std::string& name) const {
    const auto found = fields.find(name);
    return found == fields.end() ? std::string() : found->second;
  }
};

struct HttpResponse {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::map<std::string, std::string> fields;
  /// Replaces the body: the server sends events until the client or the server ends the stream.
  std::shared_ptr<EventHub::Subscription> events;
};

using HttpHandler = std::function<HttpResponse(const HttpRequest&)>;

}  // namespace roadbook
