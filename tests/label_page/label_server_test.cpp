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

// The server as a stranger on this machine meets it: bytes on a socket.

namespace roadbook {
namespace {

using Json = nlohmann::json;
using namespace std::chrono_literals;

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
  /// All until the other side closes, or `enough` has come.
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

int status_of(const std::string& answer) {
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
    test::Lot lot;
    lot.spaces_a_side = 3;
    test::write_lot(map, lot);
    place_ = read_label_place(map);
    store_ = std::make_unique<LabelStore>(map);
    views_ = std::make_unique<AnchorViews>(&store_->map(), std::vector<std::optional<Drive>>(1));
    tiles_ = std::make_unique<TilePyramid>(place_.image);
    book_ = std::make_unique<LabelBook>(store_.get(), &hub_, place_.classes);
    learning_ = std::make_unique<Learning>(place_.image, BoxLearnerOptions(), book_.get(), &hub_);
    api_ = std::make_unique<LabelApi>(LabelApi::Parts{&place_, "1", tiles_.get(), views_.get(),
                                                      book_.get(), learning_.get(), &hub_, "ann"});
    HttpServerOptions options;
    options.token = token_;
    options.limits.request = 700ms;
    server_ = std::make_unique<HttpServer>(options);
    server_->start([this](const HttpRequest& request) { return api_->answer(request); });
  }
  ~LabelServerTest() override {
    hub_.close();
    server_->stop();
    learning_.reset();
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
    return Json({{"shape", "box"},
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
  std::unique_ptr<AnchorViews> views_;
  std::unique_ptr<TilePyramid> tiles_;
  std::unique_ptr<LabelBook> book_;
  std::unique_ptr<Learning> learning_;
  std::unique_ptr<LabelApi> api_;
  std::unique_ptr<HttpServer> server_;
};

TEST_F(LabelServerTest, AnswersOnlyItsOwnPage) {
  EXPECT_EQ(get("/api/labels", allowed()), 200);
  EXPECT_EQ(get("/api/labels", "Host: " + host() + "\r\n"), 401);
  EXPECT_EQ(get("/api/labels", "Host: " + host() + "\r\nAuthorization: Bearer 0123\r\n"), 401);
  EXPECT_EQ(get("/api/labels", "Host: evil.example\r\nAuthorization: Bearer " + token_ + "\r\n"),
            403);
  EXPECT_EQ(get("/api/labels", "Host: 127.0.0.1\r\nAuthorization: Bearer " + token_ + "\r\n"), 403);
  EXPECT_EQ(get("/api/labels", allowed() + "Origin: http://evil.example\r\n"), 403);
  EXPECT_EQ(get("/api/labels", allowed() + "Sec-Fetch-Site: cross-site\r\n"), 403);
  EXPECT_EQ(get("/api/labels", allowed() + "Host: " + host() + "\r\n"), 403);
}

TEST_F(LabelServerTest, WritesOnlyJsonOfItsOwnPage) {
  EXPECT_EQ(post("/api/labels", space(1.25), writing()), 200);
  EXPECT_EQ(post("/api/labels", space(1.25), allowed() + "Content-Type: application/json\r\n"),
            403);
  EXPECT_EQ(post("/api/labels", space(1.25),
                 allowed() + "Origin: http://" + host() + "\r\nContent-Type: text/plain\r\n"),
            415);
  EXPECT_EQ(status_of(ask("POST /api/labels HTTP/1.1\r\n" + writing() +
                          "Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n")),
            411);
  EXPECT_EQ(store_->labels().size(), 1U);
}

TEST_F(LabelServerTest, TheAddressLetsInAndTheTokenGoesIntoACookie) {
  const std::string answer =
      ask("GET /?token=" + token_ + " HTTP/1.1\r\nHost: " + host() + "\r\n\r\n");
  EXPECT_EQ(status_of(answer), 303);
  const std::string cookie = "roadbook_" + std::to_string(server_->port()) + "=" + token_;
  EXPECT_NE(answer.find("Set-Cookie: " + cookie + "; Path=/; HttpOnly; SameSite=Strict"),
            std::string::npos);
  EXPECT_EQ(get("/api/labels", "Host: " + host() + "\r\nCookie: a=b; " + cookie + "\r\n"), 200);
  EXPECT_EQ(get("/?token=wrong", "Host: " + host() + "\r\n"), 401);
  EXPECT_NE(answer.find("Content-Security-Policy: default-src 'none'; script-src 'self'"),
            std::string::npos);
}

TEST_F(LabelServerTest, LimitsWhatItTakes) {
  EXPECT_EQ(get("/api/labels", allowed() + "X-Long: " + std::string(7000, 'a') +
                                   "\r\nX-Other: " + std::string(7000, 'b') +
                                   "\r\nX-More: " + std::string(4000, 'c') + "\r\n"),
            431);
  EXPECT_EQ(get("/" + std::string(4000, 'a'), allowed()), 431);
  EXPECT_EQ(post("/api/labels", std::string(1024 * 1024 + 1, ' '), writing()), 413);
  EXPECT_EQ(post("/api/labels", "{\"a\":" + std::string(5000, '[') + std::string(5000, ']') + "}",
                 writing()),
            400);
  EXPECT_EQ(post("/api/labels", "[1]", writing()), 400);
  EXPECT_EQ(post("/api/labels", "{\"x\":1e999}", writing()), 400);
}

TEST_F(LabelServerTest, EndsARequestThatDribbles) {
  const Client client(server_->port());
  const auto begin = std::chrono::steady_clock::now();
  std::thread dribble([&] {
    for (const char c : "GET /api/labels HTTP/1.1\r\nX: " + std::string(60, 'a')) {
      if (!client.send(std::string(1, c))) return;
      std::this_thread::sleep_for(50ms);
    }
  });
  const int status = status_of(client.receive());
  const auto seconds = std::chrono::steady_clock::now() - begin;
  dribble.join();
  EXPECT_EQ(status, 408);
  EXPECT_LT(seconds, 5s);
}

TEST_F(LabelServerTest, IdsAreNumbersAndNeverPaths) {
  for (const char* path :
       {"/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/tiles/0/0/../../../etc/passwd.png",
        "/tiles/0/0/0", "/tiles/-1/0/0.png", "/tiles/99/0/0.png", "/tiles/0/99999999999/0.png",
        "/api/image/0/0/0", "/api/image/9/1400000000000000000/0", "/api/image/-1/0/0",
        "/api/image/0/..%2f..%2fetc/0", "/page_files.cpp"})
    EXPECT_EQ(get(path, allowed()), 404) << path;
  EXPECT_EQ(get("/tiles/0/0/0.png", allowed()), 200);
}

TEST_F(LabelServerTest, WrongFieldsAreNamedAndNothingIsStored) {
  const auto refused = [&](const std::string& field, const Json& value) {
    Json body = Json::parse(space(1.25));
    body[field] = value;
    const HttpResponse answer = api_->answer({"POST", "/api/labels", "", {}, body.dump()});
    EXPECT_EQ(answer.status, 422) << field << " " << value;
    return Json::parse(answer.body).at("error").get<std::string>();
  };
  EXPECT_NE(refused("x", "1").find("x: got \"1\", want a number"), std::string::npos);
  EXPECT_NE(refused("x", 5000.0).find("place"), std::string::npos);
  EXPECT_NE(refused("width", -1.0).find("sides"), std::string::npos);
  EXPECT_NE(refused("shape", "circle").find("shape"), std::string::npos);
  EXPECT_NE(refused("who", "").find("who"), std::string::npos);
  EXPECT_NE(refused("kind", std::string(100, 'k')).find("kind"), std::string::npos);
  const Json crossed = {{"shape", "polygon"},
                        {"kind", "crossing"},
                        {"source", "drawn"},
                        {"who", "ann"},
                        {"corners", {{1, 4}, {3, 6}, {3, 4}, {1, 6}}}};
  const HttpResponse answer = api_->answer({"POST", "/api/labels", "", {}, crossed.dump()});
  EXPECT_EQ(answer.status, 422);
  EXPECT_NE(answer.body.find("crosses itself"), std::string::npos);
  EXPECT_TRUE(store_->labels().empty());
}

TEST_F(LabelServerTest, OpenEventStreamsDoNotStarveRequests) {
  std::vector<std::unique_ptr<Client>> streams;
  for (int i = 0; i < 32; ++i) {
    streams.push_back(std::make_unique<Client>(server_->port()));
    streams.back()->send("GET /api/events HTTP/1.1\r\n" + allowed() + "\r\n");
    EXPECT_EQ(status_of(streams.back()->receive()), 200) << i;
  }
  EXPECT_EQ(get("/api/events", allowed()), 503);
  EXPECT_EQ(post("/api/labels", space(1.25), writing()), 200);
  for (const auto& stream : streams)
    EXPECT_NE(stream->receive("parking_space").find("event: label"), std::string::npos);
}

TEST_F(LabelServerTest, TilesAreThePictureAndTheOutlineIsWhereTheCameraSeesTheBox) {
  const int finest = tiles_->levels() - 1;
  EXPECT_DOUBLE_EQ(tiles_->resolution_m(finest), place_.image.resolution_m);
  EXPECT_EQ(tiles_->tile(finest, 1000, 0), nullptr);
  const Json view = Json::parse(api_->answer({"POST", "/api/view", "", {}, space(1.25)}).body);
  EXPECT_TRUE(view.at("image").is_null());
  const Label label = label_of_box(store_->map(),
                                   {0, std::stoll(view.at("t_ns").get<std::string>()),
                                    view.at("camera").get<std::string>().back() - '0'},
                                   {{1.25, 5.5}, 1.57, 5.0, 2.5});
  const auto& mounted =
      store_->map().sessions[0].rig.cameras[static_cast<std::size_t>(label.anchor.camera)];
  // The first point is the corner ahead on the right.
  const auto pixel =
      mounted.camera.project(mounted.T_vehicle_camera.inverse() *
                             (label.T_vehicle_label * Eigen::Vector3d(2.5, -1.25, 0)));
  ASSERT_TRUE(pixel.has_value());
  EXPECT_NEAR(view.at("outline")[0][0].get<double>(), pixel->x(), 1e-6);
  EXPECT_NEAR(view.at("outline")[0][1].get<double>(), pixel->y(), 1e-6);
}

TEST_F(LabelServerTest, ASecondServerOnThePortIsRefused) {
  HttpServerOptions options;
  options.port = server_->port();
  EXPECT_THROW(HttpServer{options}, StorageError);
}

}  // namespace
}  // namespace roadbook
