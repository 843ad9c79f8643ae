#include "workflows/friction_update.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "mapping/session_track.hpp"
#include "workflows/property_table.hpp"

namespace roadbook {
namespace {

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
        track_(map, session),
        class_of_(config.class_of_value()) {
    summary_.values.assign(mapper.map().prior().properties.size(), 0);
    GroundTableOptions options;
    options.cell_m = 0.5 * config.spacing_m;
    options.ahead_max_m = config.range_m;
    options.ahead_min_m = -config.range_m;
    options.aside_max_m = config.range_m;
    options.labels_per_m2 = config.labels_per_m2;
    for (const MountedCamera& camera : drive.rig().cameras) tables_.emplace_back(camera, options);
  }

  void add_images(std::size_t pose) {
    const Keyframe& keyframe = map_.keyframes[static_cast<std::size_t>(track_.keyframe(pose))];
    const double travelled =
        pose == 0 ? 0.0 : std::min(1.0, keyframe.travelled_m - last_travelled_m_);
    last_travelled_m_ = keyframe.travelled_m;
    const Eigen::Isometry3d T = map_.T_map_vehicle(track_.keyframe(pose));
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

  void add_value(const PropertyReading& reading) {
    const auto T = track_.at(reading.t_ns);
    if (!T) {
      ++summary_.without_pose;
      return;
    }
    strips_.places_of(T->translation().head<2>(), places_);
    if (places_.empty()) ++summary_.off_lanes;
    for (const PathPlace& place : places_) {
      const PropertyUpdateResult result =
          mapper_.add_value(reading.property, place, reading.value, reading.sigma);
      if (result.status == PropertyUpdate::kDone) ++summary_.values[reading.property];
      if (result.status == PropertyUpdate::kTooLittleEvidence) ++summary_.without_labels;
    }
    summary_.date_ns = std::max(summary_.date_ns, reading.t_ns);
  }

  FrictionSummary run(const std::vector<PropertyReading>& readings, const Progress& progress) {
    std::size_t next = 0;
    for (std::size_t pose = 0; pose < track_.stamps().size(); ++pose) {
      report(progress, "friction", pose, track_.stamps().size());
      add_images(pose);
      for (; next < readings.size() && readings[next].t_ns <= track_.stamps()[pose]; ++next)
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
  SessionTrack track_;
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
  const auto readings = read_properties(drive.folder(), config.properties());
  return Update(drive, map, session, strips, config, mapper).run(readings, progress);
}

}  // namespace roadbook
