#include "workflows/people/merge_sightings.hpp"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

namespace roadbook {
namespace {

// Sorts rows by time, then by all other fields.
auto key_of(const Detection& d) { return std::tie(d.t_ns, d.x_m, d.y_m, d.sigma_m, d.probability); }
bool before(const Detection& a, const Detection& b) { return key_of(a) < key_of(b); }
bool same_row(const Detection& a, const Detection& b) { return key_of(a) == key_of(b); }

void sort_once(std::vector<Detection>& rows) {
  std::sort(rows.begin(), rows.end(), before);
  rows.erase(std::unique(rows.begin(), rows.end(), same_row), rows.end());
}

void merge_one(SessionSightings& old, SessionSightings one, bool replace, MergeCount& count) {
  sort_once(one.detections);
  sort_once(old.detections);
  std::vector<Detection> known;
  std::set_intersection(old.detections.begin(), old.detections.end(), one.detections.begin(),
                        one.detections.end(), std::back_inserter(known), before);
  count.known += known.size();
  count.added += one.detections.size() - known.size();
  if (replace) {
    count.replaced += old.detections.size() - known.size();
    old.detections = std::move(one.detections);
  } else {
    old.detections.insert(old.detections.end(), one.detections.begin(), one.detections.end());
    sort_once(old.detections);
  }
  if (!one.blockers.empty()) old.blockers = std::move(one.blockers);
  if (!one.looks.empty()) old.looks = std::move(one.looks);
}

}  // namespace

MergeCount merge_sightings(std::vector<SessionSightings>& into,
                           std::vector<SessionSightings> added,
                           const Map& map,
                           bool replace) {
  MergeCount count;
  for (SessionSightings& one : added) {
    auto old = std::find_if(into.begin(), into.end(), [&](const SessionSightings& known) {
      return known.session == one.session;
    });
    if (old == into.end()) old = into.insert(into.end(), {one.session, {}, {}});
    merge_one(*old, std::move(one), replace, count);
  }
  const auto rank = [&](const SessionSightings& one) {
    return std::find_if(map.sessions.begin(), map.sessions.end(),
                        [&](const Session& session) { return session.name == one.session; }) -
           map.sessions.begin();
  };
  std::stable_sort(into.begin(), into.end(),
                   [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  return count;
}

}  // namespace roadbook
