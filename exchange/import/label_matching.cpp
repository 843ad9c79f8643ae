#include "exchange/import/label_matching.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "exchange/export/picture_edge.hpp"
#include "exchange/import/json_fields.hpp"
#include "exchange/import/outline_shape.hpp"
#include "mapping/layers/map_layers.hpp"

namespace roadbook {
namespace {

using Corners2 = std::vector<Eigen::Vector2d>;

// Overlap from which two outlines of one class are one thing: as COCO counts a match.
constexpr double kTwinOverlap = 0.5;

struct KnownOutline {
  std::string name;  ///< for messages: "label 3"
  std::string kind;
  std::int64_t id = 0;  ///< 0: of this file
  Corners2 corners;
  std::vector<Corners2> parts;  ///< of it, cut at the edge of a picture
  Eigen::AlignedBox2d around{};
};

Eigen::AlignedBox2d box_around_corners(const Corners2& corners) {
  Eigen::AlignedBox2d around;
  for (const Eigen::Vector2d& c : corners) around.extend(c);
  return around;
}

Corners2 place_in_map(const Map& map, const Label& label) {
  Corners2 corners;
  for (const Eigen::Vector3d& corner : corners_in_map(map, label))
    corners.emplace_back(corner.head<2>());
  return corners;
}

bool lies_as(const Corners2& a, const Corners2& b, double tolerance_m) {
  return outline_distance(a, b) <= tolerance_m;
}

// Whether an upright rectangle is the one around an outline: what programs keep that know no other.
bool surrounds(const Corners2& upright, const Corners2& outline, double tolerance_m) {
  if (upright.size() != 4 || outline.empty()) return false;
  const Eigen::AlignedBox2d around = box_around_corners(outline);
  const Eigen::Vector2d low = around.min();
  const Eigen::Vector2d high = around.max();
  return lies_as(upright, {low, {high.x(), low.y()}, high, {low.x(), high.y()}}, tolerance_m);
}

// "2014-05-13T16:53:51": a moment to the second, as far as other programs keep it.
std::string second_of(std::string utc) {
  std::replace(utc.begin(), utc.end(), '/', '-');
  std::replace(utc.begin(), utc.end(), ' ', 'T');
  return utc.substr(0, 19);
}

class LabelMatcher {
 public:
  LabelMatcher(const Map& map,
               const std::vector<LabelEvent>& events,
               const std::vector<Label>& labels,
               const std::optional<PicturePlace>& cut_at,
               std::string file)
      : map_(map), events_(events), labels_(labels), file_(std::move(file)) {
    for (const Label& label : labels) {
      if (!is_on_ground(label)) continue;
      KnownOutline known{
          "label " + std::to_string(label.id), label.kind, label.id, place_in_map(map, label), {}};
      if (known.corners.empty()) continue;
      if (cut_at) known.parts = parts_in_picture(*cut_at, known.corners);
      known.around = box_around_corners(known.corners);
      known_.push_back(std::move(known));
    }
  }

  MatchedLabels match(std::vector<LabelOutline> outlines) {
    const auto origins = origins_of(outlines);
    for (std::size_t i = 0; i < outlines.size(); ++i) {
      if (origins[i] != nullptr)
        match_own(std::move(outlines[i]), *origins[i]);
      else
        match_any(std::move(outlines[i]));
    }
    return std::move(result_);
  }

 private:
  void leave_out(const LabelOutline& outline, const std::string& got, const std::string& want) {
    LabelsLeftOut one = left_out(file_, outline.where, got, want);
    one.reason.line = outline.line;
    result_.left_out.push_back(std::move(one));
  }

  [[nodiscard]] const Label* label_of(std::int64_t id) const {
    for (const Label& label : labels_)
      if (label.id == id && is_on_ground(label)) return &label;
    return nullptr;
  }

  // The event of this map's history that an outline was written after.
  [[nodiscard]] const LabelEvent* origin_of(const LabelOutline& outline) const {
    if (!outline.identity || outline.identity->edited_utc.empty()) return nullptr;
    const LabelIdentity& identity = *outline.identity;
    if (label_of(identity.id) == nullptr) return nullptr;
    for (const LabelEvent& event : events_)
      if (event.label.id == identity.id &&
          (!identity.version || event.label.version == *identity.version) &&
          second_of(utc_text(event.label.t_ns)) == second_of(identity.edited_utc))
        return &event;
    return nullptr;
  }

  // The same for each outline. What was copied in another program has its source's number too: of
  // several the nearest is the label.
  [[nodiscard]] std::vector<const LabelEvent*> origins_of(
      const std::vector<LabelOutline>& outlines) const {
    std::vector<const LabelEvent*> origins(outlines.size(), nullptr);
    std::map<std::int64_t, std::pair<double, std::size_t>> nearest;
    for (std::size_t i = 0; i < outlines.size(); ++i) {
      origins[i] = origin_of(outlines[i]);
      if (origins[i] == nullptr) continue;
      const std::int64_t id = origins[i]->label.id;
      const double apart = outline_distance(place_in_map(map_, *label_of(id)), outlines[i].corners);
      const auto [other, is_first] = nearest.emplace(id, std::pair(apart, i));
      if (is_first) continue;
      const bool is_nearer = apart < other->second.first;
      origins[is_nearer ? other->second.second : i] = nullptr;
      if (is_nearer) other->second = {apart, i};
    }
    return origins;
  }

  // How far the label has moved in the map since its last view by a person: a file may be that old.
  [[nodiscard]] double moved_since_seen(const Label& label) const {
    const auto now = seen_in_map(map_, label);
    return label.seen && now ? (now->middle - label.seen->middle).norm() : 0.0;
  }

  // An outline of this map's own label.
  void match_own(LabelOutline outline, const LabelEvent& origin) {
    const Label& now = *label_of(origin.label.id);
    const double tolerance_m = corner_tolerance(outline) + moved_since_seen(now);
    const auto is = [&](const Label& label) {
      return label.kind == outline.kind && label.note == outline.note &&
             lies_as(place_in_map(map_, label), outline.corners, tolerance_m);
    };
    if (is(now) || (origin.label.version != now.version && is(origin.label))) {
      ++result_.already;
    } else if (origin.label.version != now.version) {
      leave_out(outline,
                "another shape, class or note of label " + std::to_string(now.id) +
                    ", which was changed in the map since the file was written",
                "one change alone: make it again on the label as it stands");
    } else if (const auto [other, overlap] = twin_of(outline, now.id); overlap >= kTwinOverlap) {
      leave_out_twin(outline, *other, overlap);
    } else {
      const bool shape = !lies_as(place_in_map(map_, now), outline.corners, tolerance_m);
      result_.edits.push_back({now, std::move(outline), shape});
    }
  }

  [[nodiscard]] bool is_there(const KnownOutline& known, const LabelOutline& outline) const {
    const double tolerance_m = corner_tolerance(outline);
    return lies_as(known.corners, outline.corners, tolerance_m) ||
           surrounds(outline.corners, known.corners, tolerance_m) ||
           std::any_of(known.parts.begin(), known.parts.end(), [&](const Corners2& part) {
             return lies_as(part, outline.corners, tolerance_m);
           });
  }

  [[nodiscard]] std::vector<const KnownOutline*> near(const LabelOutline& outline) const {
    const Eigen::AlignedBox2d around = box_around_corners(outline.corners);
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(corner_tolerance(outline));
    const Eigen::AlignedBox2d wide(around.min() - margin, around.max() + margin);
    std::vector<const KnownOutline*> near;
    for (const KnownOutline& known : known_)
      if (known.kind == outline.kind && known.around.intersects(wide)) near.push_back(&known);
    return near;
  }

  // The outline but `id` that overlaps most with one, and by how much.
  [[nodiscard]] std::pair<const KnownOutline*, double> twin_of(const LabelOutline& outline,
                                                               std::int64_t id) const {
    std::pair<const KnownOutline*, double> twin{nullptr, 0.0};
    for (const KnownOutline* known : near(outline)) {
      if (id > 0 && known->id == id) continue;
      const double overlap = intersection_over_union(known->corners, outline.corners);
      if (overlap > twin.second) twin = {known, overlap};
    }
    return twin;
  }

  void leave_out_twin(const LabelOutline& outline, const KnownOutline& twin, double overlap) {
    char share[16];
    std::snprintf(share, sizeof share, "%.2f", overlap);
    leave_out(outline, "an outline on " + twin.name + " (overlap " + share + ")",
              "no second label on the first: change or delete " + twin.name);
  }

  void match_any(LabelOutline outline) {
    const auto around = near(outline);
    if (std::any_of(around.begin(), around.end(),
                    [&](const KnownOutline* known) { return is_there(*known, outline); })) {
      ++result_.already;
      return;
    }
    const auto [twin, overlap] = twin_of(outline, 0);
    if (overlap < kTwinOverlap) {
      std::string name = outline.where;
      if (outline.line > 0) name += " of line " + std::to_string(outline.line);
      known_.push_back(
          {name, outline.kind, 0, outline.corners, {}, box_around_corners(outline.corners)});
      result_.fresh.push_back(std::move(outline));
    } else if (twin->id > 0 && outline.identity && outline.identity->id == twin->id &&
               outline.identity->edited_utc.empty()) {
      result_.edits.push_back({*label_of(twin->id), std::move(outline), true});
    } else {
      leave_out_twin(outline, *twin, overlap);
    }
  }

  const Map& map_;
  const std::vector<LabelEvent>& events_;
  const std::vector<Label>& labels_;
  std::string file_;
  std::vector<KnownOutline> known_;
  MatchedLabels result_;
};

}  // namespace

std::optional<LabelIdentity> identity_of(const nlohmann::json& fields) {
  const auto whole = [&](const char* name) -> std::optional<std::int64_t> {
    const auto found = fields.find(name);
    if (found == fields.end() || !is_whole(*found)) return std::nullopt;
    return found->get<std::int64_t>();
  };
  const auto id = whole("space");
  if (!id) return std::nullopt;
  LabelIdentity identity{*id, whole("version"), {}};
  constexpr std::size_t kToTheSecond = 19;  // shapefiles keep the day alone, which names no event
  const auto edited = fields.find("edited_utc");
  if (edited != fields.end() && edited->is_string() &&
      edited->get_ref<const std::string&>().size() >= kToTheSecond)
    identity.edited_utc = edited->get<std::string>();
  return identity;
}

MatchedLabels match_outlines(const Map& map,
                             const std::vector<LabelEvent>& events,
                             const std::vector<Label>& labels,
                             const std::optional<PicturePlace>& cut_at,
                             const std::string& file,
                             std::vector<LabelOutline> outlines) {
  return LabelMatcher(map, events, labels, cut_at, file).match(std::move(outlines));
}

}  // namespace roadbook
