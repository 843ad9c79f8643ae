#include "vo/wheels/false_times.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "drive/wheel_counter.hpp"
#include "vo/odometry_run.hpp"
#include "vo/odometry_state.hpp"
#include "vo/track_matching.hpp"

namespace roadbook {
namespace {

constexpr std::int64_t kCompareNs = 400'000'000;  // between two frames that are compared
constexpr double kStandsM = 0.005;
constexpr double kStandsRad = 0.004;

// Frames that the wheels say were taken at one place, `first` and `second` at least 0.4 s apart.
struct StandingPair {
  std::size_t first = 0;
  std::size_t second = 0;
};

bool wheels_stand(const Drive& drive,
                  const WheelOdometry& wheels,
                  std::size_t from,
                  std::size_t to) {
  const auto moved = wheels.between(drive.frame_stamp_ns(from), drive.frame_stamp_ns(to));
  return moved && moved->distance_m < 0.1 && moved->motion.head<2>().norm() < kStandsM &&
         std::abs(moved->motion.z()) < kStandsRad;
}

std::vector<StandingPair> standing_pairs(const Drive& drive, const WheelOdometry& wheels) {
  std::vector<StandingPair> pairs;
  std::size_t from = 0;
  for (std::size_t i = 1; i < drive.frame_count(); ++i) {
    if (!wheels_stand(drive, wheels, from, i)) {
      from = i;
    } else if (drive.frame_stamp_ns(i) - drive.frame_stamp_ns(from) >= kCompareNs) {
      pairs.push_back({from, i});
      from = i;
    }
  }
  return pairs;
}

// Whether the images of two frames moved against each other: half of the corners found again did,
// or hardly a corner is found again.
bool images_move(const Rig& half_rig, const FrameFeatures& before, const FrameFeatures& now) {
  constexpr double kSearchPx = 40.0;
  constexpr double kStillPx = 2.0;
  constexpr std::size_t kFewestCorners = 60;
  std::size_t corners = 0;
  std::size_t still = 0;
  std::size_t moved = 0;
  const auto grids = make_grids(now, half_rig);
  for (std::size_t c = 0; c < before.size(); ++c) {
    if (before[c].size() == 0 || now[c].size() == 0) continue;
    std::vector<MatchQuery> queries;
    for (std::size_t f = 0; f < before[c].size(); ++f) {
      MatchQuery query;
      query.bearing.setZero();  // `match_near` needs none
      query.pixel = before[c].pixels[f];
      query.descriptor = &before[c].descriptors[f];
      queries.push_back(query);
    }
    corners += queries.size();
    const auto found = match_near(queries, now[c], grids[c], kSearchPx);
    for (std::size_t q = 0; q < found.size(); ++q) {
      if (found[q] < 0) continue;
      const auto shift = now[c].pixels[static_cast<std::size_t>(found[q])] - queries[q].pixel;
      (static_cast<double>(shift.norm()) <= kStillPx ? still : moved) += 1;
    }
  }
  return corners >= kFewestCorners && still < moved && 4 * still < corners;
}

}  // namespace

std::vector<std::pair<std::int64_t, std::int64_t>> false_standstills(
    const Drive& drive,
    const std::vector<cv::Mat>& masks,
    const TrackDriveOptions& options,
    const WheelOdometry& wheels) {
  std::vector<std::pair<std::int64_t, std::int64_t>> spans;
  const Rig half_rig = half_size(drive.rig());
  std::optional<std::size_t> described;
  FrameFeatures before;
  const auto features_of = [&](std::size_t frame) {
    return std::move(describe_frames(drive, {frame}, 0, 1, masks, options).front());
  };
  for (const StandingPair& pair : standing_pairs(drive, wheels)) {
    if (described != pair.first) before = features_of(pair.first);
    FrameFeatures now = features_of(pair.second);
    if (images_move(half_rig, before, now)) {
      const std::int64_t begin = drive.frame_stamp_ns(pair.first);
      std::size_t last = pair.second;  // the wheels stand up to 0.4 s longer than the last pair
      while (last + 1 < drive.frame_count() &&
             drive.frame_stamp_ns(last + 1) < drive.frame_stamp_ns(pair.second) + kCompareNs &&
             wheels_stand(drive, wheels, pair.second, last + 1))
        ++last;
      const std::int64_t end = drive.frame_stamp_ns(last);
      if (!spans.empty() && spans.back().second >= begin)
        spans.back().second = std::max(spans.back().second, end);
      else
        spans.emplace_back(begin, end);
    }
    before = std::move(now);
    described = pair.second;
  }
  return spans;
}

std::vector<std::pair<std::int64_t, std::int64_t>> impossible_times(
    const WheelModel& model, const std::vector<WheelReading>& readings) {
  std::vector<std::pair<std::int64_t, std::int64_t>> spans;
  const auto offset_ns = static_cast<std::int64_t>(std::llround(model.time_offset_s * 1e9));
  for (std::size_t i = 1; i < readings.size(); ++i) {
    const WheelReading& a = readings[i - 1];
    const WheelReading& b = readings[i];
    const double dt_s = static_cast<double>(b.t_ns - a.t_ns) * 1e-9;
    if (!is_faster_than_cars((b.left_angle_rad - a.left_angle_rad) * model.radius_left_m, dt_s) &&
        !is_faster_than_cars((b.right_angle_rad - a.right_angle_rad) * model.radius_right_m, dt_s))
      continue;
    if (!spans.empty() && spans.back().second == a.t_ns + offset_ns)
      spans.back().second = b.t_ns + offset_ns;
    else
      spans.emplace_back(a.t_ns + offset_ns, b.t_ns + offset_ns);
  }
  return spans;
}

}  // namespace roadbook
