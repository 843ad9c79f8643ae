#include <sys/socket.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "apps/label_server/http/connection.hpp"
#include "apps/label_server/http/http_guard.hpp"
#include "apps/label_server/request_fields.hpp"
#include "tests/fuzz/fuzz_support.hpp"

using namespace roadbook;

namespace {

// The head of a request as the server reads it from a socket.
void read_request(std::string_view bytes) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) std::abort();
  bytes = bytes.substr(0, 60'000);  // what a socket takes without a reader
  if (::send(ends[1], bytes.data(), bytes.size(), MSG_NOSIGNAL) < 0) std::abort();
  ::shutdown(ends[1], SHUT_WR);
  ConnectionLimits limits;
  limits.request = limits.idle = std::chrono::milliseconds(200);
  Connection connection(ends[0], limits);
  while (connection.await_head([] { return false; }) == Connection::Head::kWhole) {
    (void)connection.has_field("range");
    char buffer[100];
    if (connection.read(buffer, sizeof buffer) <= 0) break;
  }
  ::close(ends[0]);
  ::close(ends[1]);
}

}  // namespace

// The first byte chooses: the bytes of a connection, or the body and fields of a request.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(fuzz::text_of(data + 1, size - 1));
  if (data[0] % 2 == 0) {
    read_request(text);
    return 0;
  }
  const auto parts = fuzz::parts_of(text, 4);
  HttpRequest request;
  request.method = "POST";
  request.path = parts[0];
  request.query = parts[1];
  request.fields["host"] = request.fields["cookie"] = request.fields["origin"] = parts[2];
  const HttpGuard guard(8080, "0123456789abcdef0123456789abcdef");
  (void)guard.refuse(request);
  (void)guard.enter(request);
  try {
    const auto body = parse_body(std::string(parts[3]));
    (void)number_field(body, "x");
    (void)integer_field(body, "id");
    (void)flag_field(body, "on");
    (void)text_field(body, "who");
    (void)point_field(required_field(body, "corner"));
  } catch (const RequestError&) {
  }
  return 0;
}
