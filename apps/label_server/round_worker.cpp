#include "apps/label_server/round_worker.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace roadbook {

RoundWorker::RoundWorker(EventHub* hub,
                         std::string name,
                         std::function<void(const std::string&)> round)
    : hub_(hub), name_(std::move(name)), round_(std::move(round)), thread_([this] { work(); }) {}

RoundWorker::~RoundWorker() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wanted_changed_.notify_all();
  thread_.join();
}

void RoundWorker::start(const std::string& kind) {
  {
    const std::lock_guard lock(mutex_);
    if (std::find(wanted_.begin(), wanted_.end(), kind) == wanted_.end()) wanted_.push_back(kind);
  }
  wanted_changed_.notify_all();
}

bool RoundWorker::running() const {
  const std::lock_guard lock(mutex_);
  return running_ || !wanted_.empty();
}

void RoundWorker::tell(const std::string& state,
                       const std::string& kind,
                       const std::string& error) const {
  const nlohmann::json told = {{"state", state}, {"kind", kind}, {"error", error}};
  hub_->publish(name_, told.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void RoundWorker::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    wanted_changed_.wait(lock, [&] { return ending_ || !wanted_.empty(); });
    if (ending_) return;
    const std::string kind = wanted_.front();
    wanted_.pop_front();
    running_ = true;
    lock.unlock();
    tell("running", kind, "");
    std::string state = "done";
    std::string error;
    try {
      round_(kind);
    } catch (const std::exception& fault) {
      state = "failed";
      error = fault.what();
    }
    lock.lock();
    running_ = false;
    lock.unlock();
    tell(state, kind, error);
    lock.lock();
  }
}

}  // namespace roadbook
