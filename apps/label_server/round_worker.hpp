#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "apps/label_server/http/event_hub.hpp"

namespace roadbook {

/// A thread that runs the requested rounds one after another. It sends an event to the pages when a
/// round begins and when it ends: event `name` with {state: running, done or failed, kind, error}.
class RoundWorker {
 public:
  /// `hub` must outlive the object. The worker's thread calls `round` with the requested class. If
  /// `round` throws, the pages receive the error.
  RoundWorker(EventHub* hub, std::string name, std::function<void(const std::string&)> round);
  /// Waits until the running round ends.
  ~RoundWorker();
  RoundWorker(const RoundWorker&) = delete;
  RoundWorker& operator=(const RoundWorker&) = delete;

  /// Starts a round. If a round is running, another one follows. A class that already waits is not
  /// queued again.
  void start(const std::string& kind);
  [[nodiscard]] bool running() const;

 private:
  void work();
  void tell(const std::string& state, const std::string& kind, const std::string& error) const;

  EventHub* hub_;
  std::string name_;
  std::function<void(const std::string&)> round_;
  mutable std::mutex mutex_;
  std::condition_variable wanted_changed_;
  std::deque<std::string> wanted_;
  bool running_ = false;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace roadbook
