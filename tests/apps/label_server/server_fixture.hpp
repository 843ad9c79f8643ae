#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "apps/label_server/http/http_server.hpp"
#include "tests/apps/label_server/lot.hpp"
#include "tests/apps/label_server/served_map.hpp"

namespace roadbook::test {

/// A connection that sends bytes as they are.
class Client {
 public:
  explicit Client(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{20, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    connected_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~Client() { ::close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  bool send(const std::string& bytes) const {
    return ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(bytes.size());
  }
  /// All until the other side closes, or `enough` has come; the head and the body of an answer may
  /// come one after the other.
  std::string receive(const std::string& enough = "\r\n\r\n") const {
    std::string text;
    char bytes[4096];
    while (text.find(enough) == std::string::npos) {
      const ssize_t count = ::recv(socket_, bytes, sizeof bytes, 0);
      if (count <= 0) break;
      text.append(bytes, static_cast<std::size_t>(count));
    }
    return text;
  }
  [[nodiscard]] bool connected() const { return connected_; }

 private:
  int socket_;
  bool connected_ = false;
};

inline int status_of(const std::string& answer) {
  return answer.size() > 12 ? std::stoi(answer.substr(9, 3)) : 0;
}

class LabelServerTest : public ServedMap {
 protected:
  LabelServerTest() {
    Lot lot;
    lot.spaces_a_side = 3;
    write_lot(map_, lot);
    drives_.resize(1);
    open();
    HttpServerOptions options;
    options.token = token_;
    options.limits.request = std::chrono::milliseconds(700);
    server_ = std::make_unique<HttpServer>(options);
    server_->start([this](const HttpRequest& request) { return api_->answer(request); });
  }
  ~LabelServerTest() override {
    hub_.close();
    server_->stop();
  }

  std::string host() const { return "127.0.0.1:" + std::to_string(server_->port()); }
  std::string allowed() const {
    return "Host: " + host() + "\r\nAuthorization: Bearer " + token_ + "\r\n";
  }
  std::string writing() const {
    return allowed() + "Origin: http://" + host() + "\r\nContent-Type: application/json\r\n";
  }
  std::string ask(const std::string& bytes) const {
    const Client client(server_->port());
    client.send(bytes);
    return client.receive();
  }
  int get(const std::string& path, const std::string& fields) const {
    return status_of(ask("GET " + path + " HTTP/1.1\r\n" + fields + "\r\n"));
  }
  int post(const std::string& path, const std::string& body, const std::string& fields) const {
    return status_of(ask("POST " + path + " HTTP/1.1\r\n" + fields +
                         "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body));
  }
  std::string space(double x) const {
    return nlohmann::json({{"shape", "box"},
                           {"x", x},
                           {"y", 5.5},
                           {"heading", 1.57},
                           {"length", 5.0},
                           {"width", 2.5},
                           {"kind", "parking_space"},
                           {"source", "drawn"},
                           {"who", "ann"}})
        .dump();
  }

  const std::string token_ = "0123456789abcdef0123456789abcdef";
  std::unique_ptr<HttpServer> server_;
};

}  // namespace roadbook::test
