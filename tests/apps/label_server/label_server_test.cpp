#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/apps/label_server/server_fixture.hpp"

// The server as a stranger on this machine meets it: bytes on a socket.

namespace roadbook {
namespace {

using Json = nlohmann::json;
using namespace std::chrono_literals;
using test::Client;
using test::LabelServerTest;
using test::status_of;

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
  const std::string large(1024 * 1024 + 1, ' ');
  const Client client(server_->port());
  client.send("POST /api/labels HTTP/1.1\r\n" + writing() +
              "Content-Length: " + std::to_string(large.size()) + "\r\n\r\n" + large);
  const std::string answer = client.receive("}");
  EXPECT_EQ(status_of(answer), 413);
  EXPECT_NE(answer.find("body: got a larger body, want at most 1048576 bytes"), std::string::npos)
      << answer;
  EXPECT_EQ(post("/api/labels", "{\"a\":" + std::string(5000, '[') + std::string(5000, ']') + "}",
                 writing()),
            400);
  EXPECT_EQ(post("/api/labels", "[1]", writing()), 400);
  const std::string undo = R"({"who":"ann"})";
  const std::string size = std::to_string(undo.size());
  for (const std::string& length :
       std::vector<std::string>{size + "x", "+" + size, "-1", "99999999999999999999"}) {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(status_of(ask("POST /api/undo HTTP/1.1\r\n" + writing() +
                            "Content-Length: " + length + "\r\n\r\n" + undo)),
              400)
        << length;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 500ms) << "without waiting for the body";
  }
  EXPECT_EQ(post("/api/undo", undo, writing() + "Content-Length: 90\r\n"), 400) << "twice";
  EXPECT_EQ(post("/api/undo", undo, writing()), 200);
  EXPECT_EQ(post("/api/labels", "{\"x\":1e999}", writing()), 400);
}

TEST_F(LabelServerTest, GivesWholeAnswersAlone) {
  std::string pieces = "bytes=0-";
  for (int i = 0; i < 900; ++i) pieces += ",0-";  // each as large as the answer
  for (const std::string& who : {allowed(), "Host: " + host() + "\r\n"}) {
    const Client client(server_->port());
    client.send("GET /api/start HTTP/1.1\r\n" + who + "rAnGe: " + pieces + "\r\n\r\n");
    const std::string answer = client.receive("no such end");
    EXPECT_EQ(status_of(answer), 416);
    EXPECT_LT(answer.size(), 200U);
  }
  // A line that ends without "\r" is one as well.
  const Client client(server_->port());
  client.send("GET /api/start HTTP/1.1\r\n" + allowed() + "X: y\nRange: " + pieces + "\r\n\r\n");
  EXPECT_EQ(status_of(client.receive("no such end")), 416);
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

TEST_F(LabelServerTest, ABodyThatDribblesOrABrowserThatVanishesStoresNothing) {
  const std::string body = space(1.25);
  const std::string head = "POST /api/labels HTTP/1.1\r\n" + writing() +
                           "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n";
  const auto begin = std::chrono::steady_clock::now();
  {
    const Client slow(server_->port());
    slow.send(head);
    for (std::size_t i = 0; i < 30 && slow.send(body.substr(i, 1)); ++i)
      std::this_thread::sleep_for(50ms);
    const std::string answer = slow.receive("}");
    EXPECT_EQ(status_of(answer), 408);
    EXPECT_NE(answer.find("body: got an incomplete body, want the complete body within"),
              std::string::npos);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 5s);
  for (int i = 0; i < 20; ++i) {
    const Client gone(server_->port());
    gone.send(head + body.substr(0, body.size() / 2));
  }
  EXPECT_EQ(post("/api/labels", body, writing()), 200);
  EXPECT_EQ(store_->labels().size(), 1U);
}

TEST_F(LabelServerTest, IdleConnectionsDelayARequestByNoMoreThanTheyMayIdle) {
  std::vector<std::unique_ptr<Client>> idle;
  for (int i = 0; i < 150; ++i) idle.push_back(std::make_unique<Client>(server_->port()));
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(get("/api/labels", allowed()), 200);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 6s);  // two seconds, twice: 96 threads
}

TEST_F(LabelServerTest, OtherPagesOfThisMachineAndPagesWithoutAnOriginMayNotWrite) {
  const std::string json = "Content-Type: application/json\r\n";
  for (const std::string& origin : std::vector<std::string>{
           "null", "http://127.0.0.1:1", "http://localhost", "https://" + host(), "http://[::1]:1"})
    EXPECT_EQ(post("/api/labels", space(1.25), allowed() + "Origin: " + origin + "\r\n" + json),
              403)
        << origin;
  EXPECT_EQ(
      status_of(ask("PATCH /api/labels HTTP/1.1\r\n" + writing() + "Content-Length: 0\r\n\r\n")),
      405);
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

TEST_F(LabelServerTest, ASecondServerOnThePortIsRefused) {
  HttpServerOptions options;
  options.port = server_->port();
  EXPECT_THROW(HttpServer{options}, StorageError);
}

// Of this process: the test's own ends are among them.
std::size_t open_sockets() {
  std::size_t count = 0;
  for (const auto& file : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code gone;
    if (std::filesystem::read_symlink(file, gone).string().starts_with("socket:")) ++count;
  }
  return count;
}

TEST(HttpServer, HoldsNoMoreConnectionsThanItHasThreadsAndPlacesInItsLine) {
  HttpServerOptions options;
  options.token = "0123456789abcdef0123456789abcdef";
  options.threads = 2;
  options.waiting = 3;
  options.limits.idle = 20s;
  HttpServer server(options);
  server.start([](const HttpRequest&) { return HttpResponse(); });
  const std::size_t before = open_sockets();
  constexpr std::size_t kClients = 40;
  const std::size_t most =
      options.threads + options.waiting + 1;  // and the one that finds no place
  std::vector<std::unique_ptr<Client>> idle;
  for (std::size_t i = 0; i < kClients; ++i)
    idle.push_back(std::make_unique<Client>(server.port()));
  const auto held = [&] { return open_sockets() - before - kClients; };
  for (int i = 0; i < 100 && held() < most; ++i) std::this_thread::sleep_for(20ms);
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(held(), most);
  // Each client that leaves frees a slot for a waiting client.
  idle.clear();
  const auto begin = std::chrono::steady_clock::now();
  const Client client(server.port());
  client.send("GET /any HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server.port()) +
              "\r\nAuthorization: Bearer " + options.token + "\r\n\r\n");
  EXPECT_EQ(status_of(client.receive()), 200);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 5s);
  // It ends with a line that is full.
  for (std::size_t i = 0; i < kClients; ++i)
    idle.push_back(std::make_unique<Client>(server.port()));
  const auto end = std::chrono::steady_clock::now();
  server.stop();
  EXPECT_LT(std::chrono::steady_clock::now() - end, 5s);
}

}  // namespace
}  // namespace roadbook
