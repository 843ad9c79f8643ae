#include "exchange/export/opendrive/opendrive_places.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace roadbook {
namespace {

constexpr double kSearchStep_m = 0.25;
constexpr int kBisections = 60;
// Half lengths of stretches, tried in turn: short ones part places, long ones hold several.
constexpr std::array kHalf_m{0.1, 0.15, 0.06};
constexpr int kMostTries = 5000;
constexpr double kChordMargin_m =
    0.002;  // to the ends of a chord, as s drifts where chords sum it up

struct Chord {
  Eigen::Vector2d begin;
  Eigen::Vector2d ahead;
  double length_m;
};

Chord chord_of(const DriveRoad& road, const DriveStretch& stretch) {
  const Eigen::Vector2d begin = road.curve.at(stretch.begin_m).position;
  const Eigen::Vector2d chord = road.curve.at(stretch.end_m).position - begin;
  return {begin, chord.normalized(), chord.norm()};
}

bool lies_across(const Chord& chord, const Eigen::Vector2d& point) {
  const double along = chord.ahead.dot(point - chord.begin);
  return along >= kChordMargin_m && along <= chord.length_m - kChordMargin_m;
}

// Chooses stretches foot by foot, and takes a choice back where a later foot finds no room.
class StretchSearch {
 public:
  StretchSearch(const DriveRoad& road, const std::vector<RoadFoot>& feet)
      : road_(road),
        feet_(feet),
        begin_m_(road.begin_m + bent_end_m(road.curve, road.begin_m, road.length_m())),
        end_m_(road.end_m - bent_end_m(road.curve, road.end_m, road.length_m())) {}

  std::optional<std::vector<DriveStretch>> find() {
    if (!place(0)) return std::nullopt;
    return std::move(stretches_);
  }

 private:
  bool place(std::size_t foot) {
    if (++tried_ > kMostTries) return false;
    if (foot == feet_.size()) return is_room(last(), end_m_);
    if (!stretches_.empty() && lies_across(chord_of(road_, stretches_.back()), feet_[foot].point))
      return place(foot + 1);
    const double s = feet_[foot].s_m;
    std::vector<double> middles{s};
    if (foot + 1 < feet_.size()) {
      const double next = feet_[foot + 1].s_m;
      middles.insert(middles.end(), {0.5 * (s + next), next});
    }
    for (const double half : kHalf_m)
      for (const double middle : middles)
        if (add(middle, half, feet_[foot].point)) {
          if (place(foot + 1)) return true;
          stretches_.pop_back();
        }
    return false;
  }

  // A stretch up to what is left to the last one or to the end of the road, where that is little.
  bool add(double middle, double half, const Eigen::Vector2d& point) {
    const double before = middle - last();
    const double after = end_m_ - middle;
    const double room = std::min(before, after);
    if (room < half + shortest_m_ && room > 0.5 * shortest_m_ && room <= 1.5 * half) half = room;
    const DriveStretch stretch{middle - half, middle + half};
    if (!is_room(last(), stretch.begin_m) || !is_room(stretch.end_m, end_m_) ||
        !lies_across(chord_of(road_, stretch), point))
      return false;
    stretches_.push_back(stretch);
    return true;
  }

  // Nothing is left between two places, or enough for a cubic.
  [[nodiscard]] bool is_room(double from_m, double to_m) const {
    return std::abs(to_m - from_m) < 1e-9 || to_m - from_m >= shortest_m_;
  }
  [[nodiscard]] double last() const {
    return stretches_.empty() ? begin_m_ : stretches_.back().end_m;
  }

  const DriveRoad& road_;
  const std::vector<RoadFoot>& feet_;
  double shortest_m_ = DriveCubicOptions{}.shortest_m;
  double begin_m_;
  double end_m_;
  int tried_ = 0;
  std::vector<DriveStretch> stretches_;
};

}  // namespace

std::vector<RoadFoot> feet_of(const DriveRoad& road, const Eigen::Vector2d& point) {
  const auto along = [&](double s) {
    const PathPoint at = road.curve.at(s);
    return at.tangent.dot(point - at.position);
  };
  std::vector<RoadFoot> feet;
  const int steps = std::max(1, static_cast<int>(std::ceil(road.length_m() / kSearchStep_m)));
  double before = along(road.begin_m);
  for (int i = 0; i < steps; ++i) {
    double low = road.begin_m + road.length_m() * i / steps;
    double high = road.begin_m + road.length_m() * (i + 1) / steps;
    const bool ahead = before > 0.0;
    before = along(high);
    if (ahead == (before > 0.0)) continue;
    for (int k = 0; k < kBisections; ++k) {
      const double middle = 0.5 * (low + high);
      ((along(middle) > 0.0) == ahead ? low : high) = middle;
    }
    const PathPoint at = road.curve.at(high);
    feet.push_back({point, high, at.left().dot(point - at.position)});
  }
  return feet;
}

std::optional<std::vector<DriveStretch>> stretches_across(const DriveRoad& road,
                                                          std::vector<RoadFoot> feet) {
  std::stable_sort(feet.begin(), feet.end(),
                   [](const RoadFoot& a, const RoadFoot& b) { return a.s_m < b.s_m; });
  return StretchSearch(road, feet).find();
}

std::optional<ChordPlace> place_across(const DriveRoad& road,
                                       const std::vector<DriveStretch>& stretches,
                                       const Eigen::Vector2d& point) {
  std::optional<ChordPlace> nearest;
  for (const DriveStretch& stretch : stretches) {
    const Chord chord = chord_of(road, stretch);
    if (!lies_across(chord, point)) continue;
    const Eigen::Vector2d across = point - chord.begin;
    const double t = chord.ahead.x() * across.y() - chord.ahead.y() * across.x();
    if (!nearest || std::abs(t) < std::abs(nearest->t_m))
      nearest = {stretch.begin_m + chord.ahead.dot(across), t,
                 std::atan2(chord.ahead.y(), chord.ahead.x())};
  }
  return nearest;
}

}  // namespace roadbook
