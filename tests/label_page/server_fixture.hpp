#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "apps/label_server/http_server.hpp"
#include "apps/label_server/label_api.hpp"
#include "tests/label_page/lot.hpp"

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

class LabelServerTest : public ::testing::Test {
 protected:
  LabelServerTest() {
    folder_ = std::filesystem::temp_directory_path() /
              ("label_server." + std::to_string(getpid()) + "." +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    const auto map = folder_ / "lot.gpkg";
    Lot lot;
    lot.spaces_a_side = 3;
    write_lot(map, lot);
    place_ = read_label_place(map);
    store_ = std::make_unique<LabelStore>(map);
    views_ = std::make_unique<AnchorViews>(&store_->map(), &drives_);
    images_ = std::make_unique<PeopleImages>(&store_->map(), &drives_, PersonLearnerOptions(), 0.4);
    tiles_ = std::make_unique<TilePyramid>(place_.image);
    book_ = std::make_unique<LabelBook>(store_.get(), &hub_, images_.get(), place_.classes);
    learning_ = std::make_unique<Learning>(place_.image, BoxLearnerOptions(), book_.get(), &hub_);
    people_ = std::make_unique<PeopleLearning>(images_.get(), book_.get(), &hub_, PersonExamples(),
                                               PersonLearnerOptions());
    paint_ = std::make_unique<PaintWatch>(book_.get(), KeyframeImages(), &hub_);
    api_ = std::make_unique<LabelApi>(LabelApi::Parts{&place_, "1", tiles_.get(), views_.get(),
                                                      book_.get(), learning_.get(), people_.get(),
                                                      paint_.get(), &hub_, "ann"});
    HttpServerOptions options;
    options.token = token_;
    options.limits.request = std::chrono::milliseconds(700);
    server_ = std::make_unique<HttpServer>(options);
    server_->start([this](const HttpRequest& request) { return api_->answer(request); });
  }
  ~LabelServerTest() override {
    hub_.close();
    server_->stop();
    learning_.reset();
    people_.reset();
    paint_.reset();
    std::filesystem::remove_all(folder_);
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
  std::filesystem::path folder_;
  LabelPlace place_;
  EventHub hub_;
  std::unique_ptr<LabelStore> store_;
  std::vector<std::optional<Drive>> drives_ = std::vector<std::optional<Drive>>(1);
  std::unique_ptr<AnchorViews> views_;
  std::unique_ptr<PeopleImages> images_;
  std::unique_ptr<TilePyramid> tiles_;
  std::unique_ptr<LabelBook> book_;
  std::unique_ptr<Learning> learning_;
  std::unique_ptr<PeopleLearning> people_;
  std::unique_ptr<PaintWatch> paint_;
  std::unique_ptr<LabelApi> api_;
  std::unique_ptr<HttpServer> server_;
};

}  // namespace roadbook::test
