#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "apps/label_server/http/event_hub.hpp"
#include "apps/label_server/label_service.hpp"
#include "apps/label_server/round_worker.hpp"
#include "drive/drive.hpp"
#include "semantics/labels/label_sightings.hpp"

namespace roadbook {

/// Looks in the background whether what labels show is still painted on the ground, in the images
/// of the sessions that came into the map since a person last looked at a label, the newest first
/// (semantics/labels/label_evidence.hpp). Where it is, the label has a further anchor
/// (semantics/labels/label_sightings.hpp). Safe to use from several threads.
class PaintWatch {
 public:
  /// `book` and `hub` must outlive it. Begins at once, where there are `images` to look into, and
  /// tells the pages by event `paint` when it is through. Goes on from the sightings that are
  /// `known`; `keep` is called with all there are when it ends, if it has found others, from a
  /// thread of its own; what it throws is told to the pages.
  PaintWatch(const LabelBook* book,
             KeyframeImages images,
             EventHub* hub,
             const std::vector<StoredSighting>& known = {},
             std::function<void(const std::vector<StoredSighting>&)> keep = {});
  /// Ends the look where it is.
  ~PaintWatch();
  PaintWatch(const PaintWatch&) = delete;
  PaintWatch& operator=(const PaintWatch&) = delete;

  /// {looked, gone: [{id, version, session}], further: [{id, version, apart_m, sigmas,
  /// contradicts, images: [{session, camera, apart_m}]}]}: labels whose paint is gone, of which
  /// nobody has said anything since, and the name of the session whose images tell; of labels as
  /// they stood when they were looked for, those with further anchors, how far these put them from
  /// their own (root mean square; in the median in standard deviations of both places), and whether
  /// that says that the map is bent.
  [[nodiscard]] nlohmann::json report() const;

 private:
  void look();
  void keep() const;
  [[nodiscard]] nlohmann::json further() const;
  void look_for(const Label& label);

  const LabelBook* book_;
  KeyframeImages images_;
  std::function<void(const std::vector<StoredSighting>&)> keep_;
  mutable std::mutex mutex_;
  SightingRecord sightings_;
  bool found_ = false;  ///< sightings that `keep_` has not been told
  std::size_t looked_ = 0;
  std::map<std::int64_t, int> gone_;  ///< by id: the session whose images tell
  std::atomic<bool> ending_{false};
  std::optional<RoundWorker> worker_;  ///< last: its thread ends before the rest goes
};

}  // namespace roadbook
