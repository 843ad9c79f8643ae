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

/// Checks in the background whether the labelled markings are still painted on the ground. It uses
/// the images of sessions that were added after a user last saw the label, the newest first
/// (semantics/labels/label_evidence.hpp). If it finds the paint, the label gets a further anchor
/// (semantics/labels/label_sightings.hpp). Safe to use from several threads.
class PaintWatch {
 public:
  /// `service` and `hub` must outlive the object. The check starts at once if there are `images`.
  /// It sends event `paint` to the pages when it ends. It continues from the `known` sightings. If
  /// there are new sightings at the end, it calls `keep` with all sightings, in a separate thread.
  /// If `keep` throws, the pages receive the error.
  PaintWatch(const LabelService* service,
             KeyframeImages images,
             EventHub* hub,
             const std::vector<StoredSighting>& known = {},
             std::function<void(const std::vector<StoredSighting>&)> keep = {});
  /// Stops the check.
  ~PaintWatch();
  PaintWatch(const PaintWatch&) = delete;
  PaintWatch& operator=(const PaintWatch&) = delete;

  /// Returns {looked, gone: [{id, version, session}], further: [{id, version, apart_m, sigmas,
  /// contradicts, images: [{session, camera, apart_m}]}]}.
  ///
  /// `gone` lists the labels whose paint has disappeared and about which no user has given an
  /// answer since. `session` is the session whose images show this.
  ///
  /// `further` lists the labels with further anchors, in the version that the check used. `apart_m`
  /// is the root mean square distance between these anchors and the label's own anchor. `sigmas` is
  /// the median distance in standard deviations of both places. `contradicts` is true if the
  /// distance shows that the map is deformed.
  [[nodiscard]] nlohmann::json report() const;

 private:
  void look();
  void keep() const;
  [[nodiscard]] nlohmann::json further() const;
  void look_for(const Label& label);

  const LabelService* service_;
  KeyframeImages images_;
  std::function<void(const std::vector<StoredSighting>&)> keep_;
  mutable std::mutex mutex_;
  SightingRecord sightings_;
  bool found_ = false;  ///< there are sightings that `keep_` has not received
  std::size_t looked_ = 0;
  std::map<std::int64_t, int> gone_;  ///< by id: the session whose images show no paint
  std::atomic<bool> ending_{false};
  std::optional<RoundWorker> worker_;  ///< last member: its thread must end before the other
                                       ///< members are destroyed
};

}  // namespace roadbook
