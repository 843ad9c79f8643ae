#pragma once

#include <atomic>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "apps/label_server/event_hub.hpp"
#include "apps/label_server/label_book.hpp"
#include "apps/label_server/round_worker.hpp"
#include "drive/drive.hpp"
#include "semantics/label_evidence.hpp"

namespace roadbook {

/// Looks in the background whether what labels show is still painted on the ground, in the images
/// of the sessions that came into the map since a person last looked at a label, the newest first
/// (semantics/label_evidence.hpp). Safe to use from several threads.
class PaintWatch {
 public:
  /// `book` and `hub` must outlive it. Begins at once, where there are `images` to look into, and
  /// tells the pages by event `paint` when it is through.
  PaintWatch(const LabelBook* book, KeyframeImages images, EventHub* hub);
  /// Ends the look where it is.
  ~PaintWatch();
  PaintWatch(const PaintWatch&) = delete;
  PaintWatch& operator=(const PaintWatch&) = delete;

  /// {looked, gone: [{id, version, session}]}: of labels as they stood when they were looked for,
  /// and the name of the session whose images tell.
  [[nodiscard]] nlohmann::json gone() const;

 private:
  void look();
  void look_for(const Label& label);

  struct Gone {
    std::int64_t version = 0;
    int session = 0;
  };

  const LabelBook* book_;
  KeyframeImages images_;
  mutable std::mutex mutex_;
  std::size_t looked_ = 0;
  std::map<std::int64_t, Gone> gone_;  ///< by id
  std::atomic<bool> ending_{false};
  std::optional<RoundWorker> worker_;  ///< last: its thread ends before the rest goes
};

}  // namespace roadbook
