#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace roadbook {

/// Sends events to all open pages in order (server-sent events).
class EventHub {
 public:
  /// `kept`: the number of events kept for slow streams. The hub ends a stream that is more events
  /// behind.
  explicit EventHub(std::size_t max_streams = 32, std::size_t kept = 4096)
      : max_streams_(max_streams), kept_(kept) {}

  /// A client's subscription to the events. The stream counts as open while this object exists.
  class Subscription {
   public:
    Subscription(EventHub* hub, std::string greeting);
    ~Subscription();
    Subscription(const Subscription&) = delete;
    Subscription& operator=(const Subscription&) = delete;
    /// Returns the next text to send: events, or a comment that keeps the connection alive if
    /// `wait` has passed without events. Empty at the end of the stream.
    [[nodiscard]] std::optional<std::string> next(std::chrono::milliseconds wait);

   private:
    EventHub* hub_;
    std::string greeting_;
    std::uint64_t position_ = 0;
  };

  /// Opens a stream. Empty if too many streams are open. `greeting` is the data of an event `map`,
  /// which the stream sends first; empty: no such event.
  [[nodiscard]] std::shared_ptr<Subscription> subscribe(const std::string& greeting = {});
  /// `data`: JSON without line breaks.
  void publish(const std::string& name, const std::string& data);
  /// Ends all streams, now and from now on.
  void close();
  [[nodiscard]] std::size_t streams() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::string> events_;
  std::uint64_t first_ = 0;  ///< number of events_.front()
  std::size_t open_ = 0;
  std::size_t max_streams_;
  std::size_t kept_;
  bool closed_ = false;
};

}  // namespace roadbook
