#include "apps/friction_update.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace roadbook {
namespace {

// Poses of one session in the order of time.
struct Track {
  std::vector<std::int64_t> t_ns;
  std::vector<int> keyframes;
};

Track track_of(const Map& map, int session) {
  Track track;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    if (map.keyframes[i].session == session) {
      track.t_ns.push_back(map.keyframes[i].t_ns);
      track.keyframes.push_back(static_cast<int>(i));
    }
  return track;
}

// Between the keyframes before and after, if they are one movement.
std::optional<Eigen::Vector2d> position_at(const Map& map, const Track& track, std::int64_t t_ns) {
  constexpr double kFarthest = 3.0;  // [m] between keyframes
  const auto after = std::lower_bound(track.t_ns.begin(), track.t_ns.end(), t_ns);
  if (after == track.t_ns.end()) return std::nullopt;
  const auto i = static_cast<std::size_t>(after - track.t_ns.begin());
  const Eigen::Vector3d b = map.T_map_vehicle(track.keyframes[i]).translation();
  if (*after == t_ns) return b.head<2>();
  if (i == 0 || map.keyframes[static_cast<std::size_t>(track.keyframes[i])].after_gap)
    return std::nullopt;
  const Eigen::Vector3d a = map.T_map_vehicle(track.keyframes[i - 1]).translation();
  if ((b - a).norm() > kFarthest) return std::nullopt;
  const double part = static_cast<double>(t_ns - track.t_ns[i - 1]) /
                      static_cast<double>(track.t_ns[i] - track.t_ns[i - 1]);
  return (a + part * (b - a)).head<2>();
}

class Update {
 public:
  Update(const Drive& drive,
         const Map& map,
         int session,
         const LaneStrips& strips,
         const FrictionConfig& config,
         PropertyMapper& mapper)
      : drive_(drive),
        map_(map),
        strips_(strips),
        mapper_(mapper),
        track_(track_of(map, session)),
        class_of_(config.class_of_value()) {
    GroundTableOptions options;
    options.cell_m = 0.5 * config.spacing_m;
    options.ahead_max_m = config.range_m;
    options.ahead_min_m = -config.range_m;
    options.aside_max_m = config.range_m;
    options.labels_per_m2 = config.labels_per_m2;
    for (const MountedCamera& camera : drive.rig().cameras) tables_.emplace_back(camera, options);
  }

  void add_images(std::size_t pose) {
    const Keyframe& keyframe = map_.keyframes[static_cast<std::size_t>(track_.keyframes[pose])];
    const double travelled =
        pose == 0 ? 0.0 : std::min(1.0, keyframe.travelled_m - last_travelled_m_);
    last_travelled_m_ = keyframe.travelled_m;
    const Eigen::Isometry3d T = map_.T_map_vehicle(track_.keyframes[pose]);
    for (std::size_t camera = 0; camera < tables_.size() && travelled > 0.0; ++camera) {
      cv::Mat image =
          drive_.read_segmentation(static_cast<std::size_t>(keyframe.drive_frame), camera);
      if (image.empty()) continue;
      for (int row = 0; row < image.rows; ++row) {
        auto* const pixel = image.ptr<std::uint8_t>(row);
        for (int column = 0; column < image.cols; ++column)
          pixel[column] = class_of_[pixel[column]];
      }
      add_cells(tables_[camera], image, T, travelled);
      ++summary_.frames;
      summary_.date_ns = std::max(summary_.date_ns, keyframe.t_ns);
    }
  }

  void add_value(const FrictionReading& reading) {
    const auto p = position_at(map_, track_, reading.t_ns);
    if (!p) {
      ++summary_.without_pose;
      return;
    }
    strips_.places_of(*p, places_);
    if (places_.empty()) ++summary_.off_lanes;
    for (const PathPlace& place : places_) {
      const PropertyUpdateResult result = mapper_.add_value(0, place, reading.friction);
      if (result.status == PropertyUpdate::kDone) ++summary_.values;
      if (result.status == PropertyUpdate::kTooLittleEvidence) ++summary_.without_labels;
    }
    summary_.date_ns = std::max(summary_.date_ns, reading.t_ns);
  }

  FrictionSummary run(const Progress& progress) {
    std::vector<FrictionReading> readings;
    drive_.for_each_friction_reading([&](const FrictionReading& r) { readings.push_back(r); });
    std::size_t next = 0;
    for (std::size_t pose = 0; pose < track_.t_ns.size(); ++pose) {
      report(progress, "friction", pose, track_.t_ns.size());
      add_images(pose);
      for (; next < readings.size() && readings[next].t_ns <= track_.t_ns[pose]; ++next)
        add_value(readings[next]);
      if (mapper_.travelled(last_travelled_m_)) ++summary_.refreshes;
    }
    summary_.without_pose += readings.size() - next;
    mapper_.refresh();
    ++summary_.refreshes;
    return summary_;
  }

 private:
  void add_cells(const GroundTable& table,
                 const cv::Mat& classes,
                 const Eigen::Isometry3d& T_map_vehicle,
                 double travelled_m) {
    const std::size_t K = mapper_.map().classes();
    table.count(classes.ptr<std::uint8_t>(), classes.step, K, counts_);
    const double cell = table.options().cell_m;
    const double worth = table.options().labels_per_m2 * cell * cell * travelled_m;
    std::vector<double> weights(K);
    for (std::size_t i = 0; i < table.centres().size(); ++i) {
      double total = 0.0;
      for (std::size_t c = 0; c < K; ++c) total += counts_[i * K + c];
      if (total == 0.0) continue;
      for (std::size_t c = 0; c < K; ++c) weights[c] = worth * counts_[i * K + c] / total;
      const Eigen::Vector3d p(table.centres()[i].x(), table.centres()[i].y(), 0.0);
      strips_.places_of((T_map_vehicle * p).head<2>(), places_);
      for (const PathPlace& place : places_)
        summary_.cells += mapper_.map().add_labels(place, weights) ? 1 : 0;
    }
  }

  const Drive& drive_;
  const Map& map_;
  const LaneStrips& strips_;
  PropertyMapper& mapper_;
  Track track_;
  std::vector<std::uint8_t> class_of_;
  std::vector<GroundTable> tables_;
  std::vector<std::uint32_t> counts_;
  std::vector<PathPlace> places_;
  double last_travelled_m_ = 0.0;
  FrictionSummary summary_;
};

}  // namespace

FrictionSummary update_friction(const Drive& drive,
                                const Map& map,
                                int session,
                                const LaneStrips& strips,
                                const FrictionConfig& config,
                                PropertyMapper& mapper,
                                const Progress& progress) {
  return Update(drive, map, session, strips, config, mapper).run(progress);
}

}  // namespace roadbook
