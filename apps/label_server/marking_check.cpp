#include "apps/label_server/marking_check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "semantics/labels/label_agreement.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

Json further_anchors(const Map& map, const Label& label) {
  const LabelAgreement agreement = agreement_of(map, {label});
  Json images = Json::array();
  double squares = 0.0;
  for (const LabelDisagreement& one : agreement.sightings) {
    const Session& session = map.sessions[static_cast<std::size_t>(one.anchor.session)];
    images.push_back(
        {{"session", session.name},
         {"camera", session.rig.cameras.at(static_cast<std::size_t>(one.anchor.camera)).name},
         {"apart_m", one.apart.norm()}});
    squares += one.apart.squaredNorm();
  }
  const auto count = static_cast<double>(agreement.sightings.size());
  return {{"id", label.id},
          {"version", label.version},
          {"apart_m", count > 0.0 ? std::sqrt(squares / count) : 0.0},
          {"sigmas", agreement.median_sigmas},
          {"contradicts", agreement.contradicts()},
          {"images", images}};
}

// Returns the number of sessions in the map when a user last saw the label.
int known_sessions(const Label& label) {
  return std::max(label.anchor.session + 1, label.seen ? label.seen->sessions : 0);
}

}  // namespace

PaintWatch::PaintWatch(const LabelService* service,
                       KeyframeImages images,
                       EventHub* hub,
                       const std::vector<StoredSighting>& known,
                       std::function<void(const std::vector<StoredSighting>&)> keep)
    : service_(service), images_(std::move(images)), keep_(std::move(keep)), sightings_(known) {
  if (!images_) return;
  worker_.emplace(hub, "paint", [this](const std::string&) { look(); });
  worker_->start("");
}

PaintWatch::~PaintWatch() { ending_ = true; }

void PaintWatch::look() {
  for (const Label& label : service_->ground_labels()) {
    if (ending_) break;
    look_for(label);
  }
  keep();
}

// The newest session with informative images decides. A session is not informative if it did not
// pass the label, or saw a parked car there.
void PaintWatch::look_for(const Label& label) {
  const Map& map = service_->map();
  const auto sessions = static_cast<int>(map.sessions.size());
  const int known = known_sessions(label);
  for (int session = sessions - 1; session >= known; --session) {
    const LabelEvidence evidence = look_again(map, label, session, images_);
    const bool gone = evidence.status == EvidenceStatus::kGone;
    const std::lock_guard lock(mutex_);
    looked_ += session == sessions - 1 ? 1U : 0U;
    found_ |= sightings_.take(map, label, session, evidence);
    if (gone) gone_[label.id] = session;
    if (gone || evidence.status == EvidenceStatus::kFound || ending_) return;
  }
}

// The sightings are stored separately from the labels. A label that a user has confirmed does not
// change.
void PaintWatch::keep() const {
  if (!keep_ || !found_) return;
  std::vector<StoredSighting> all;
  {
    const std::lock_guard lock(mutex_);
    all = sightings_.sightings();
  }
  keep_(all);
}

Json PaintWatch::report() const {
  Json further = this->further();
  std::map<std::int64_t, int> gone;
  std::size_t looked = 0;
  {
    const std::lock_guard lock(mutex_);
    gone = gone_;
    looked = looked_;
  }
  Json list = Json::array();
  for (const auto& [id, session] : gone) {
    const auto label = service_->find(id);
    if (!label || known_sessions(*label) > session) continue;  // a user has seen the label since
    list.push_back({{"id", id},
                    {"version", label->version},
                    {"session", service_->map().sessions[static_cast<std::size_t>(session)].name}});
  }
  return {{"looked", looked}, {"gone", list}, {"further", std::move(further)}};
}

Json PaintWatch::further() const {
  std::vector<StoredSighting> all;
  {
    const std::lock_guard lock(mutex_);
    all = sightings_.sightings();
  }
  Json list = Json::array();
  auto labels = service_->ground_labels();
  add_sightings(all, labels);
  for (const Label& label : labels) {
    Json anchors = further_anchors(service_->map(), label);
    if (!anchors.at("images").empty()) list.push_back(std::move(anchors));
  }
  return list;
}

}  // namespace roadbook
