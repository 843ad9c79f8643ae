#include "apps/label_server/http/connection.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>

namespace roadbook {
namespace {

constexpr std::chrono::milliseconds kSlice{50};  // between two looks at the clock

// Calls poll() again after an interrupt.
bool poll_for(int socket, short events, std::chrono::milliseconds time, short* seen) {
  pollfd entry{socket, events, 0};
  const int count = ::poll(&entry, 1, static_cast<int>(std::max<std::int64_t>(0, time.count())));
  *seen = entry.revents;
  return count > 0;
}

}  // namespace

bool Connection::wait_readable(std::chrono::milliseconds time) const {
  short seen = 0;
  return poll_for(socket_, POLLIN, time, &seen);
}

bool Connection::is_writable() const {
  short seen = 0;
  if (!poll_for(socket_, POLLOUT | POLLRDHUP, limits_.write, &seen)) return false;
  return (seen & POLLOUT) != 0 && (seen & (POLLRDHUP | POLLHUP | POLLERR)) == 0;
}

bool Connection::is_over(Clock::time_point begin, std::chrono::milliseconds most) const {
  const auto now = Clock::now();
  if (begin > now) return false;
  return now - begin >= most || (now - begin >= limits_.pressed && pressed_ && pressed_());
}

bool Connection::await_bytes() const {
  while (in_time())
    if (wait_readable(kSlice)) return true;
  return false;
}

bool Connection::fill() {
  std::array<char, 8192> bytes{};
  ssize_t count = 0;
  do {
    count = ::recv(socket_, bytes.data(), bytes.size(), 0);
  } while (count < 0 && errno == EINTR);
  if (count <= 0) return false;
  buffer_.append(bytes.data(), static_cast<std::size_t>(count));
  return true;
}

Connection::Head Connection::read_head() {
  begin_of_request_ = Clock::now();
  buffer_.erase(0, begin_);
  begin_ = 0;
  while (true) {
    const std::size_t line = buffer_.find("\r\n");
    const std::size_t end = buffer_.find("\r\n\r\n");
    if (std::min(line, buffer_.size()) > limits_.target_bytes) return Head::kTooLong;
    if (std::min(end, buffer_.size()) > limits_.head_bytes) return Head::kTooLong;
    if (end != std::string::npos) return Head::kWhole;
    if (!await_bytes()) return Head::kTooSlow;
    if (!fill()) return Head::kNone;
  }
}

bool Connection::has_field(const std::string& name) const {
  std::string head = buffer_.substr(begin_, buffer_.find("\r\n\r\n", begin_) - begin_);
  for (char& c : head) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return head.find("\n" + name + ":") !=
         std::string::npos;  // httplib takes a line without "\r" too
}

std::ptrdiff_t Connection::read(char* bytes, std::size_t size) {
  while (begin_ == buffer_.size()) {
    timed_out_ = !await_bytes();
    if (timed_out_ || !fill()) return 0;
  }
  const std::size_t count = std::min(size, buffer_.size() - begin_);
  std::memcpy(bytes, buffer_.data() + begin_, count);
  begin_ += count;
  return static_cast<std::ptrdiff_t>(count);
}

std::ptrdiff_t Connection::write(const char* bytes, std::size_t size) {
  const auto begin = Clock::now();
  short seen = 0;
  while (!poll_for(socket_, POLLOUT, kSlice, &seen))
    if (is_over(begin, limits_.write)) return -1;
  if ((seen & POLLOUT) == 0) return -1;
  const ssize_t count = ::send(socket_, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
  return count;
}

}  // namespace roadbook
