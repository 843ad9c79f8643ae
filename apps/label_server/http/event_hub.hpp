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
  /// `kept`: events that are kept for streams that lag behind; a slower one is ended.
  explicit EventHub(std::size_t max_streams = 32, std::size_t kept = 4096)
      : max_streams_(max_streams), kept_(kept) {}

  /// One client's place in the stream of events. Counts as open while it lives.
  class Subscription {
   public:
    Subscription(EventHub* hub, std::string greeting);
    ~Subscription();
    Subscription(const Subscription&) = delete;
    Subscription& operator=(const Subscription&) = delete;
    /// What to send next: events, or a comment that keeps the connection when `wait` has passed
    /// without any; empty when the stream is over.
    [[nodiscard]] std::optional<std::string> next(std::chrono::milliseconds wait);

   private:
    EventHub* hub_;
    std::string greeting_;
    std::uint64_t position_ = 0;
  };

  /// Empty where too many streams are open. `greeting`: data of an event `map` that goes before all
  /// others; empty: none.
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
