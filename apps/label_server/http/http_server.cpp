#include "apps/label_server/http/http_server.hpp"

// Only this file includes httplib, because its flags change the layout of its classes, and because
// it is slow to compile.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#include <httplib.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <atomic>
#include <cctype>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "base/error.hpp"

namespace roadbook {
namespace {

constexpr int kBacklog = 128;
constexpr std::size_t kUncompressedBytes = 4096;  // and more: answers that are not compressed

/// Lets httplib read and write a connection.
class ConnectionStream : public httplib::Stream {
 public:
  explicit ConnectionStream(Connection* connection) : connection_(connection) {}
  bool is_readable() const override { return connection_->has_bytes() || connection_->in_time(); }
  bool is_writable() const override { return connection_->is_writable(); }
  ssize_t read(char* bytes, std::size_t size) override { return connection_->read(bytes, size); }
  ssize_t write(const char* bytes, std::size_t size) override {
    ssize_t count = 0;
    while (count == 0 && size > 0) count = connection_->write(bytes, size);
    return count;
  }
  void get_remote_ip_and_port(std::string& ip, int& port) const override {
    ip.clear();
    port = 0;
  }
  void get_local_ip_and_port(std::string& ip, int& port) const override {
    ip.clear();
    port = 0;
  }
  socket_t socket() const override { return connection_->socket(); }

 private:
  Connection* connection_;
};

// Whether this thread's connection ends after the request, because a part of the body is unread.
thread_local bool close_after_request = false;
thread_local const Connection* connection_of_thread = nullptr;

HttpRequest http_request(const httplib::Request& in) {
  HttpRequest request;
  request.method = in.method;
  request.path = in.path;
  const std::size_t query = in.target.find('?');
  if (query != std::string::npos) request.query = in.target.substr(query + 1);
  for (const auto& [name, value] : in.headers) {
    std::string small = name;
    for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    // An honest client sends each field once. If a field occurs twice, no check may trust the first
    // value.
    const auto [place, is_new] = request.fields.try_emplace(small, value);
    if (!is_new) place->second = "(given twice)";
  }
  request.body = in.body;
  return request;
}

void give(HttpResponse response, httplib::Response* out) {
  add_safety_fields(&response);
  out->status = response.status;
  for (const auto& [name, value] : response.fields) out->set_header(name, value);
  // httplib compresses contents with Brotli's slowest level: two seconds for the page. A browser of
  // this machine does not need it. Contents from a provider are sent as they are; the error handler
  // needs those of errors.
  if (!response.events && response.status == 200 && response.body.size() >= kUncompressedBytes) {
    const std::size_t size = response.body.size();
    out->set_content_provider(size, response.type,
                              [body = std::move(response.body)](
                                  std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                return sink.write(body.data() + offset, length);
                              });
    return;
  }
  if (!response.events) {
    out->set_content(response.body, response.type);
    return;
  }
  out->set_chunked_content_provider(
      "text/event-stream", [events = response.events](std::size_t, httplib::DataSink& sink) {
        const auto text = events->next(std::chrono::seconds(2));
        return text && sink.is_writable() && sink.write(text->data(), text->size());
      });
}

/// How busy the threads of a server are.
struct Load {
  std::atomic<std::size_t> waiting = 0;  ///< connections without a thread
  std::atomic<std::size_t> busy = 0;     ///< threads with a connection
};

/// A thread pool with a queue of limited length. If the queue is full, the server refuses the
/// connection.
class BoundedLine : public httplib::TaskQueue {
 public:
  BoundedLine(std::size_t threads, std::size_t most, Load* load)
      : pool_(threads), most_(most), load_(load) {}

  // Only the accepting thread calls this function.
  void enqueue(std::function<void()> task) override {
    std::unique_lock lock(mutex_);
    ++load_->waiting;
    room_.wait(lock, [this] { return waiting_ < most_; });
    ++waiting_;
    pool_.enqueue([this, task = std::move(task)] {
      {
        const std::lock_guard leave(mutex_);
        --waiting_;
      }
      --load_->waiting;
      ++load_->busy;
      room_.notify_one();
      task();
      --load_->busy;
    });
  }
  void shutdown() override { pool_.shutdown(); }

 private:
  httplib::ThreadPool pool_;
  std::size_t most_;
  Load* load_;
  std::size_t waiting_ = 0;
  std::mutex mutex_;
  std::condition_variable room_;
};

class BoundedServer : public httplib::Server {
 public:
  explicit BoundedServer(const HttpServerOptions& options) : options_(options) {
    // The library sets SO_REUSEPORT, with which a second server could share the port unnoticed.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    set_tcp_nodelay(true);
    set_keep_alive_timeout(2);
    set_payload_max_length(options.body_bytes);
    new_task_queue = [this] { return new BoundedLine(options_.threads, options_.waiting, &load_); };
  }

  void serve(const HttpGuard& guard, const HttpHandler& handler) {
    set_pre_routing_handler([&guard](const httplib::Request& in, httplib::Response& out) {
      const HttpRequest request = http_request(in);
      auto answer = guard.enter(request);
      if (!answer) answer = guard.refuse(request);
      if (!answer) return HandlerResponse::Unhandled;
      close_after_request = true;
      give(*answer, &out);
      return HandlerResponse::Handled;
    });
    const auto answer = [&handler](const httplib::Request& in, httplib::Response& out) {
      give(handler(http_request(in)), &out);
    };
    const std::string any = R"([\s\S]*)";
    Get(any, answer).Post(any, answer).Put(any, answer).Delete(any, answer);
    set_error_handler([this](const httplib::Request&, httplib::Response& out) {
      close_after_request = true;
      if (out.body.empty()) give(refusal(out.status), &out);
    });
    set_exception_handler(
        [](const httplib::Request&, httplib::Response& out, std::exception_ptr fault) {
          try {
            std::rethrow_exception(fault);
          } catch (const std::exception& error) {
            give(error_response(500, error.what()), &out);
          } catch (...) {
            give(error_response(500, "server: unknown error"), &out);
          }
        });
    ::listen(svr_sock_, kBacklog);  // the library uses 5
    listen_after_bind();
  }

 private:
  bool process_and_close_socket(socket_t socket) override {
    Connection connection(socket, options_.limits,
                          [this] { return load_.waiting > 0 && load_.busy >= options_.threads; });
    ConnectionStream stream(&connection);
    connection_of_thread = &connection;
    bool open = true;
    while (open) {
      const auto head = connection.await_head([this] { return svr_sock_ == INVALID_SOCKET; });
      if (head == Connection::Head::kTooLong)
        refuse(&stream, "431 Request Header Fields Too Large");
      if (head == Connection::Head::kTooSlow) refuse(&stream, "408 Request Timeout");
      if (head != Connection::Head::kWhole) break;
      // The library returns every range that a request lists, even if each is as large as the file.
      if (connection.has_field("range")) {
        refuse(&stream, "416 Range Not Satisfiable");
        break;
      }
      bool closed = false;
      close_after_request = false;
      open = process_request(stream, false, closed, nullptr) && !closed && !close_after_request;
    }
    connection_of_thread = nullptr;
    ::shutdown(socket, SHUT_RDWR);
    ::close(socket);
    return true;
  }

  // Answers to requests that the HTTP library itself refuses.
  [[nodiscard]] HttpResponse refusal(int status) const {
    if (status == 413)
      return error_response(413, "body: got a larger body, want at most " +
                                     std::to_string(options_.body_bytes) + " bytes");
    if (connection_of_thread != nullptr && connection_of_thread->timed_out())
      return error_response(408, "body: got an incomplete body, want the complete body within " +
                                     std::to_string(options_.limits.request.count()) + " ms");
    return error_response(status, "request: got an invalid request, want HTTP/1.1");
  }

  static void refuse(ConnectionStream* stream, const std::string& status) {
    const std::string text =
        "HTTP/1.1 " + status + "\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
    static_cast<void>(stream->write(text.data(), text.size()));
  }

  HttpServerOptions options_;
  Load load_;
};

std::string taken(int port) {
  return to_line({Severity::kError, "127.0.0.1:" + std::to_string(port), 0, "--port",
                  "a port in use", "a free port, or 0 for any free port"});
}

}  // namespace

struct HttpServer::Impl {
  explicit Impl(const HttpServerOptions& options) : v4(options), v6(options) {}

  BoundedServer v4;
  BoundedServer v6;
  bool has_v6 = false;
  int port = 0;
  std::unique_ptr<HttpGuard> guard;
  HttpHandler handler;
  std::vector<std::thread> threads;
};

HttpServer::HttpServer(const HttpServerOptions& options) : impl_(std::make_unique<Impl>(options)) {
  Impl& s = *impl_;
  s.port = options.port;
  if (options.port == 0) {
    s.port = s.v4.bind_to_any_port("127.0.0.1");
    if (s.port <= 0) throw StorageError(taken(options.port));
  } else if (!s.v4.bind_to_port("127.0.0.1", options.port)) {
    throw StorageError(taken(options.port));
  }
  s.has_v6 = s.v6.bind_to_port("::1", s.port);
  s.guard =
      std::make_unique<HttpGuard>(s.port, options.token.empty() ? random_token() : options.token);
}

HttpServer::~HttpServer() { stop(); }

std::string HttpServer::address() const {
  return "http://127.0.0.1:" + std::to_string(impl_->port) + "/?token=" + impl_->guard->token();
}

int HttpServer::port() const { return impl_->port; }

void HttpServer::start(HttpHandler handler) {
  Impl& s = *impl_;
#ifdef __GLIBC__
  // glibc gives threads up to eight heaps a core, and each keeps room for the largest answer that
  // one of its threads ever made: 300 MB with 10,000 labels, where two heaps hold 180 MB.
  mallopt(M_ARENA_MAX, 2);
#endif
  s.handler = std::move(handler);
  const auto serve = [&s](BoundedServer* server) {
    s.threads.emplace_back([&s, server] { server->serve(*s.guard, s.handler); });
    while (!server->is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  serve(&s.v4);
  if (s.has_v6) serve(&s.v6);
}

void HttpServer::stop() {
  impl_->v4.stop();
  if (impl_->has_v6) impl_->v6.stop();
  for (std::thread& thread : impl_->threads) thread.join();
  impl_->threads.clear();
}

}  // namespace roadbook
