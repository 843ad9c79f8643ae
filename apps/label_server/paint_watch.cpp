#include "apps/label_server/paint_watch.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

}  // namespace

KeyframeImages newest_images(const Map* map, const std::vector<std::optional<Drive>>* drives) {
  if (drives->empty() || !drives->back()) return {};
  return [map, drives](int keyframe, int camera) {
    const Keyframe& k = map->keyframes[static_cast<std::size_t>(keyframe)];
    const auto& drive = (*drives)[static_cast<std::size_t>(k.session)];
    const auto frame = static_cast<std::size_t>(k.drive_frame);
    const auto c = static_cast<std::size_t>(camera);
    if (!drive || k.drive_frame < 0 || frame >= drive->frame_count() || !drive->has_image(frame, c))
      return cv::Mat();
    return drive->read_image(frame, c);
  };
}

PaintWatch::PaintWatch(const LabelBook* book, KeyframeImages images, EventHub* hub)
    : book_(book), images_(std::move(images)) {
  if (!images_) return;
  worker_.emplace(hub, "paint", [this](const std::string&) { look(); });
  worker_->start("");
}

PaintWatch::~PaintWatch() { ending_ = true; }

void PaintWatch::look() {
  const Map& map = book_->map();
  const auto newest = static_cast<int>(map.sessions.size()) - 1;
  for (const Label& label : book_->ground_labels()) {
    if (ending_) return;
    const bool known =
        label.anchor.session == newest || (label.seen && label.seen->sessions > newest);
    if (known) continue;
    const LabelEvidence evidence = look_again(map, label, newest, images_);
    const std::lock_guard lock(mutex_);
    ++looked_;
    if (evidence.status == EvidenceStatus::kGone) gone_[label.id] = label.version;
  }
}

Json PaintWatch::gone() const {
  const std::lock_guard lock(mutex_);
  Json list = Json::array();
  for (const auto& [id, version] : gone_) list.push_back({{"id", id}, {"version", version}});
  const auto& sessions = book_->map().sessions;
  return {{"session", sessions.empty() ? std::string() : sessions.back().name},
          {"looked", looked_},
          {"gone", list}};
}

}  // namespace roadbook
