#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>

namespace roadbook {

struct ConnectionLimits {
  std::size_t head_bytes = 16 * 1024;       ///< request line and header fields
  std::size_t target_bytes = 2 * 1024;      ///< of the request line
  std::chrono::milliseconds request{5000};  ///< from a request's first byte to its last
  std::chrono::milliseconds idle{2000};     ///< between two requests of a connection
  std::chrono::milliseconds write{5000};    ///< until the client accepts some bytes
  /// Longest of the three while others wait for a thread: a client on this machine needs less.
  std::chrono::milliseconds pressed{500};
};

/// One accepted socket. The deadline applies to the request as a whole, so that a slow client
/// cannot occupy a thread for longer.
class Connection {
 public:
  enum class Head { kWhole, kNone, kTooLong, kTooSlow };

  /// Does not own `socket`. `pressed`: whether other connections wait for this one's thread.
  Connection(int socket, const ConnectionLimits& limits, std::function<bool()> pressed = nullptr)
      : socket_(socket), limits_(limits), pressed_(std::move(pressed)) {}

  /// Waits for the first byte of a request until the idle time is over or `stopping` returns true.
  /// Then reads until the head is complete. The head stays in the buffer.
  template <class Stopping>
  [[nodiscard]] Head await_head(const Stopping& stopping) {
    const auto begin = Clock::now();
    while (buffer_.size() == begin_) {
      if (stopping() || is_over(begin, limits_.idle)) return Head::kNone;
      if (!wait_readable(std::chrono::milliseconds(100))) continue;
      if (!fill()) return Head::kNone;
    }
    return read_head();
  }

  /// Returns the number of bytes read. Returns 0 at the end, or when the time of the request is up.
  [[nodiscard]] std::ptrdiff_t read(char* bytes, std::size_t size);
  /// Returns the number of bytes sent. Returns -1 if the client has closed the connection or
  /// accepts no bytes in time.
  [[nodiscard]] std::ptrdiff_t write(const char* bytes, std::size_t size);
  /// Returns whether the request has a field of that name (in lower case). The head of the request
  /// must be complete and unread.
  [[nodiscard]] bool has_field(const std::string& name) const;
  [[nodiscard]] bool has_bytes() const { return begin_ < buffer_.size(); }
  [[nodiscard]] bool in_time() const { return !is_over(begin_of_request_, limits_.request); }
  /// Returns whether the last read ended because the request's time was up.
  [[nodiscard]] bool timed_out() const { return timed_out_; }
  [[nodiscard]] int socket() const { return socket_; }
  /// Returns whether the client still accepts bytes and has not closed the connection.
  [[nodiscard]] bool is_writable() const;

 private:
  using Clock = std::chrono::steady_clock;
  [[nodiscard]] bool wait_readable(std::chrono::milliseconds time) const;
  /// Whether `most` has passed since `begin`; under pressure, limits_.pressed suffices.
  [[nodiscard]] bool is_over(Clock::time_point begin, std::chrono::milliseconds most) const;
  /// Whether bytes can be read before the time of the request is over.
  [[nodiscard]] bool await_bytes() const;
  bool fill();
  [[nodiscard]] Head read_head();

  int socket_;
  ConnectionLimits limits_;
  std::function<bool()> pressed_;
  Clock::time_point begin_of_request_ = Clock::time_point::max();
  bool timed_out_ = false;
  std::string buffer_;
  std::size_t begin_ = 0;  ///< start of the unread bytes
};

}  // namespace roadbook
