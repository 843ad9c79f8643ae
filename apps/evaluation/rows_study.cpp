#include "apps/evaluation/rows_study.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>
#include <optional>

#include "base/random.hpp"
#include "base/temporary_folder.hpp"
#include "drive/true_poses.hpp"
#include "mapping/pipeline/map_stages.hpp"
#include "mapping/similarity.hpp"
#include "semantics/labels/space_rows.hpp"
#include "sim/simulate.hpp"
#include "sim/world/layout.hpp"
#include "vo/own_car_mask.hpp"

namespace roadbook {
namespace {

/// The results of the stages before the last adjustment, and the true pose of each keyframe.
struct DrivenPlace {
  MappingInput input;
  std::vector<LoopClosure> loops;
  Relaxed relaxed;
  std::vector<Rig> rigs;
  std::vector<std::optional<Eigen::Isometry3d>> truth;
  std::vector<ParkingSpace> spaces;
};

/// The true middle of a space, and its label.
struct DrawnSpace {
  Eigen::Vector2d middle;
  Label label;
};

Drive simulated_visit(const RowsDrive& place,
                      const Scenario& scenario,
                      const std::filesystem::path& folder,
                      std::uint64_t seed,
                      int num_threads,
                      const Progress& progress) {
  SimulateOptions options;
  options.seed = 100 * seed + static_cast<std::uint64_t>(scenario.visit);
  options.effects = place.effects;
  options.max_duration_s = place.seconds;
  options.num_threads = num_threads;
  simulate(scenario, folder, options, progress);
  return Drive::open(folder);
}

void add_truth(const Drive& drive, const VoResult& odometry, DrivenPlace& place) {
  std::map<std::int64_t, Eigen::Isometry3d> truth;
  for (const TimedPose& pose : true_poses(drive)) truth.emplace(pose.t_ns, pose.T_world_vehicle);
  for (const VoKeyframe& keyframe : odometry.keyframes) {
    const auto found = truth.find(keyframe.t_ns);
    place.truth.emplace_back(found == truth.end() ? std::nullopt : std::optional(found->second));
  }
}

DrivenPlace drive_through(const RowsDrive& drive,
                          std::uint64_t seed,
                          const MapOptions& options,
                          const Progress& progress) {
  const TemporaryFolder folder;
  DrivenPlace place;
  std::vector<VoResult> odometry;
  std::vector<bool> has_wheels;
  for (int visit = 0; visit < drive.visits; ++visit) {
    Scenario scenario = load_scenario(
        drive.scenario, {.size = drive.size, .visit = visit, .image_scale = drive.image_scale});
    scenario.seed += 1000 * seed;
    const Drive recorded =
        simulated_visit(drive, scenario, folder.path() / ("visit" + std::to_string(visit)), seed,
                        options.num_threads, progress);
    odometry.push_back(
        track_drive(recorded, find_own_car(recorded, {}, 0).masks, options.tracking, progress));
    add_truth(recorded, odometry.back(), place);
    place.rigs.push_back(recorded.rig());
    has_wheels.push_back(odometry.back().uses_wheels);
    place.spaces = make_layout(scenario).spaces;
  }
  place.input = join_drives(std::move(odometry), place.rigs, has_wheels);
  LoopOptions loop_options = options.loops;
  loop_options.num_threads = options.num_threads;
  place.loops = find_loops(place.input, loop_options, progress);
  place.relaxed = relax_poses(place.input, place.loops, options, progress);
  return place;
}

Map map_of(const DrivenPlace& place, const Adjusted& adjusted, const MapOptions& options) {
  Map map = map_of_stages(place.input, place.loops, adjusted, options);
  for (const Rig& rig : place.rigs) {
    map.sessions.emplace_back();
    map.sessions.back().rig = rig;
  }
  return map;
}

// Places the spaces of one row from its first space on. The row is straight and its spaces are
// equal, except for the irregularity in `kind`.
void lay_row(std::vector<ParkingSpace*>& row, const RowsLabels& kind, Random& random) {
  const Eigen::Vector2d first = row.front()->centre;
  const Eigen::Vector2d way = row.back()->centre - first;
  const Eigen::Vector2d along = way.normalized();
  const Eigen::Vector2d across(-along.y(), along.x());
  const double step = way.norm() / static_cast<double>(row.size() - 1);
  const std::size_t middle = row.size() / 2;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const double s = step * (static_cast<double>(i) - static_cast<double>(middle));
    Eigen::Vector2d moved(kind.uneven_m * random.normal(), 0.0);
    if (i >= middle) moved.x() += (i == middle ? 0.5 : 1.0) * kind.wider * step;
    double turn = 0.0;
    if (kind.radius_m > 0.0) {
      moved.y() += s * s / (2.0 * kind.radius_m);
      turn += s / kind.radius_m;
    }
    if (i > middle) {
      moved.y() += s * std::tan(kind.kink_rad);
      turn += kind.kink_rad;
    }
    row[i]->centre += moved.x() * along + moved.y() * across;
    row[i]->heading += turn;
  }
}

std::vector<ParkingSpace> laid_spaces(const DrivenPlace& place,
                                      const RowsLabels& kind,
                                      std::uint64_t seed) {
  std::vector<ParkingSpace> spaces = place.spaces;
  std::map<std::string, std::vector<ParkingSpace*>> rows;
  for (ParkingSpace& space : spaces) rows[space.row].push_back(&space);
  Random random(seed, "uneven rows");
  for (auto& [name, row] : rows)
    if (row.size() > 1) lay_row(row, kind, random);
  return spaces;
}

// Returns the box at which the mosaic shows a space. This is the mean over the images of the
// nearest pass, as in the mosaic. Empty if no vehicle came near.
std::optional<OrientedBox> shown_box(const DrivenPlace& place,
                                     const Map& map,
                                     const ParkingSpace& space) {
  constexpr double kNearM = 12.0;
  constexpr double kLookM = 3.0;
  const Eigen::Vector3d p(space.centre.x(), space.centre.y(), 0.0);
  const auto count = static_cast<int>(place.truth.size());
  const auto truth = [&](int k) { return place.truth[static_cast<std::size_t>(k)]; };
  int nearest = -1;
  double least = kNearM;
  for (int k = 0; k < count; ++k) {
    if (!truth(k)) continue;
    const double distance = (truth(k)->translation() - p).head<2>().norm();
    if (distance >= least) continue;
    least = distance;
    nearest = k;
  }
  if (nearest < 0) return std::nullopt;
  const Keyframe& from = map.keyframes[static_cast<std::size_t>(nearest)];
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int looks = 0;
  for (int k = 0; k < count; ++k) {
    const Keyframe& other = map.keyframes[static_cast<std::size_t>(k)];
    if (!truth(k) || other.session != from.session ||
        std::abs(other.travelled_m - from.travelled_m) > kLookM)
      continue;
    sum += map.T_map_vehicle(k) * truth(k)->inverse() * p;
    ++looks;
  }
  OrientedBox box;
  box.centre = sum.head<2>() / looks;
  box.heading =
      space.heading + heading_of(map.T_map_vehicle(nearest)) - heading_of(*truth(nearest));
  box.length_m = (space.corners[2] - space.corners[1]).norm();
  box.width_m = (space.corners[1] - space.corners[0]).norm();
  return box;
}

std::vector<DrawnSpace> draw_spaces(const DrivenPlace& place,
                                    const Map& map,
                                    const RowsLabels& kind,
                                    std::uint64_t seed) {
  Random random(seed, "hand");
  std::vector<DrawnSpace> drawn;
  for (const ParkingSpace& space : laid_spaces(place, kind, seed)) {
    auto box = shown_box(place, map, space);
    if (!box) continue;
    box->centre += kind.sigma_m * Eigen::Vector2d(random.normal(), random.normal());
    box->heading += 2.0 * kind.sigma_m / box->length_m * random.normal();
    const auto corners = box->corners();
    const auto anchor = most_central_view(map, {corners.begin(), corners.end()});
    if (!anchor) continue;
    drawn.push_back({space.centre, label_of_box(map, *anchor, *box)});
    drawn.back().label.kind = "parking_space";
    drawn.back().label.sigma_m = kind.sigma_m;
    drawn.back().label.id = static_cast<std::int64_t>(drawn.size());
  }
  return drawn;
}

RowsErrors errors_of(const DrivenPlace& place,
                     const Map& map,
                     const std::vector<DrawnSpace>& drawn) {
  std::vector<Eigen::Vector3d> reference;
  std::vector<Eigen::Vector3d> estimate;
  for (std::size_t k = 0; k < place.truth.size(); ++k) {
    if (!place.truth[k]) continue;
    reference.emplace_back(place.truth[k]->translation());
    estimate.emplace_back(map.T_map_vehicle(static_cast<int>(k)).translation());
  }
  const TrajectoryError ate = trajectory_error(reference, estimate, false);
  double sum = 0.0;
  for (const DrawnSpace& space : drawn) {
    const Eigen::Vector3d p =
        vehicle_of(map, space.label.anchor)->T_map_vehicle * middle_of(space.label);
    sum += ((ate.T_reference_estimate * p).head<2>() - space.middle).squaredNorm();
  }
  return {ate.rmse_m, drawn.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(drawn.size()))};
}

}  // namespace

std::vector<RowsOutcome> study_rows(const RowsDrive& drive,
                                    const std::vector<RowsLabels>& kinds,
                                    std::uint64_t seed,
                                    int num_threads,
                                    const Progress& progress) {
  MapOptions options;
  options.covariances = false;
  options.num_threads = options.tracking.num_threads = num_threads;
  DrivenPlace place = drive_through(drive, seed, options, progress);
  const Map off =
      map_of(place, adjust(place.input, place.loops, place.relaxed, options, progress), options);
  std::vector<RowsOutcome> outcomes;
  for (const RowsLabels& kind : kinds) {
    const std::vector<DrawnSpace> drawn = draw_spaces(place, off, kind, seed);
    std::vector<Label> labels;
    for (const DrawnSpace& space : drawn) labels.push_back(space.label);
    options.equal_rows = [&](const Map& map) { return space_rows(map, labels); };
    const Adjusted with_rows = adjust(place.input, place.loops, place.relaxed, options, progress);
    const Map on = map_of(place, with_rows, options);
    outcomes.push_back({kind.name, errors_of(place, off, drawn), errors_of(place, on, drawn),
                        drawn.size(), with_rows.rows});
  }
  return outcomes;
}

RatioInterval ratio_interval(const std::vector<double>& ratios) {
  const auto n = static_cast<double>(ratios.size());
  if (ratios.empty()) return {};
  double mean = 0.0;
  for (const double ratio : ratios) mean += std::log(ratio) / n;
  if (ratios.size() < 2) return {std::exp(mean), 0.0, std::numeric_limits<double>::infinity()};
  double variance = 0.0;
  for (const double ratio : ratios)
    variance += (std::log(ratio) - mean) * (std::log(ratio) - mean) / (n - 1.0);
  const boost::math::students_t student(n - 1.0);
  const double half = boost::math::quantile(student, 0.975) * std::sqrt(variance / n);
  return {std::exp(mean), std::exp(mean - half), std::exp(mean + half)};
}

}  // namespace roadbook
