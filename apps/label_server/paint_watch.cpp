#include "apps/label_server/paint_watch.hpp"

#include <algorithm>

namespace roadbook {
namespace {

using Json = nlohmann::json;

}  // namespace

PaintWatch::PaintWatch(const LabelBook* book, KeyframeImages images, EventHub* hub)
    : book_(book), images_(std::move(images)) {
  if (!images_) return;
  worker_.emplace(hub, "paint", [this](const std::string&) { look(); });
  worker_->start("");
}

PaintWatch::~PaintWatch() { ending_ = true; }

void PaintWatch::look() {
  for (const Label& label : book_->ground_labels()) {
    if (ending_) return;
    look_for(label);
  }
}

// The newest session whose images tell something has the last word: one that did not come by, or
// saw a parked car there, says nothing.
void PaintWatch::look_for(const Label& label) {
  const Map& map = book_->map();
  const auto sessions = static_cast<int>(map.sessions.size());
  const int known = std::max(label.anchor.session + 1, label.seen ? label.seen->sessions : 0);
  for (int session = sessions - 1; session >= known; --session) {
    const EvidenceStatus status = look_again(map, label, session, images_).status;
    const bool tells = status == EvidenceStatus::kFound || status == EvidenceStatus::kGone;
    const std::lock_guard lock(mutex_);
    looked_ += session == sessions - 1 ? 1U : 0U;
    if (status == EvidenceStatus::kGone) gone_[label.id] = {label.version, session};
    if (tells || ending_) return;
  }
}

Json PaintWatch::gone() const {
  const std::lock_guard lock(mutex_);
  Json list = Json::array();
  const auto& sessions = book_->map().sessions;
  for (const auto& [id, gone] : gone_)
    list.push_back({{"id", id},
                    {"version", gone.version},
                    {"session", sessions[static_cast<std::size_t>(gone.session)].name}});
  return {{"looked", looked_}, {"gone", list}};
}

}  // namespace roadbook
