#include "apps/label_server/http/event_hub.hpp"

#include <utility>

namespace roadbook {

namespace {

std::string event_text(const std::string& name, const std::string& data) {
  return "event: " + name + "\ndata: " + data + "\n\n";
}

}  // namespace

EventHub::Subscription::Subscription(EventHub* hub, std::string greeting)
    : hub_(hub), greeting_(std::move(greeting)), position_(hub->first_ + hub->events_.size()) {
  ++hub->open_;
}

EventHub::Subscription::~Subscription() {
  const std::lock_guard lock(hub_->mutex_);
  --hub_->open_;
}

std::optional<std::string> EventHub::Subscription::next(std::chrono::milliseconds wait) {
  if (!greeting_.empty()) return std::exchange(greeting_, {});
  std::unique_lock lock(hub_->mutex_);
  const auto end = [&] { return hub_->first_ + hub_->events_.size(); };
  hub_->changed_.wait_for(lock, wait, [&] { return hub_->closed_ || position_ < end(); });
  if (hub_->closed_ || position_ < hub_->first_) return std::nullopt;
  if (position_ == end()) return ": still here\n\n";
  std::string text;
  for (; position_ < end(); ++position_)
    text += hub_->events_[static_cast<std::size_t>(position_ - hub_->first_)];
  return text;
}

std::shared_ptr<EventHub::Subscription> EventHub::subscribe(const std::string& greeting) {
  const std::lock_guard lock(mutex_);
  if (closed_ || open_ >= max_streams_) return nullptr;
  return std::make_shared<Subscription>(this, greeting.empty() ? "" : event_text("map", greeting));
}

void EventHub::publish(const std::string& name, const std::string& data) {
  {
    const std::lock_guard lock(mutex_);
    events_.push_back(event_text(name, data));
    while (events_.size() > kept_) {
      events_.pop_front();
      ++first_;
    }
  }
  changed_.notify_all();
}

void EventHub::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

std::size_t EventHub::streams() const {
  const std::lock_guard lock(mutex_);
  return open_;
}

}  // namespace roadbook
