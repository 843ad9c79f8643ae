#include "mapping/pipeline/build_summary.hpp"

#include <algorithm>
#include <iterator>

#include "mapping/layers/map_layers.hpp"
#include "mapping/pieces.hpp"
#include "mapping/store/map_file.hpp"
#include "vo/track_options.hpp"

namespace roadbook {

std::vector<VehicleSource> sources_of(const std::vector<SessionVehicle>& vehicles) {
  std::vector<VehicleSource> sources;
  for (const SessionVehicle& vehicle : vehicles) sources.push_back(vehicle.source);
  return sources;
}

void count_contents(const Map& map, MapSummary& summary) {
  summary.keyframes = map.keyframes.size();
  summary.landmarks = map.landmarks.size();
  summary.sessions = map.sessions.size();
  for (const auto& loop : map.loops)
    (loop.accepted ? summary.loops_accepted : summary.loops_rejected) += 1;
  summary.scale_source = map.sessions.front().scale_source;
  if (map.sessions.front().scale_sigma > 0.0)
    summary.scale_sigma = map.sessions.front().scale_sigma;
  summary.components = static_cast<std::size_t>(piece_count(map));
  for (const Session& session : map.sessions)
    summary.vehicles.push_back({session.name, session.vehicle_source});
}

void add_warnings_of(const std::vector<Drive>& drives, MapSummary& summary) {
  for (const Drive& drive : drives) {
    const auto warnings = drive.warnings();
    summary.warnings.insert(summary.warnings.end(), warnings.begin(), warnings.end());
  }
}

void add_truth_errors(const std::vector<DriveTruth>& truths, const Map& map, MapSummary& summary) {
  const TruthErrors errors = truth_errors(map, truths);
  summary.truth_apart = errors.apart;
  if (errors.together) {
    summary.ate_median_m = errors.together->median_m;
    summary.ate_p95_m = errors.together->p95_m;
  }
  if (errors.sessions.empty()) return;
  for (std::size_t s = 0; s < map.sessions.size(); ++s) {
    SessionTruth& session = summary.truth_sessions.emplace_back();
    session.session = map.sessions[s].name;
    const SessionTruthError* found = errors.of_session(static_cast<int>(s));
    if (found == nullptr) continue;
    session.ate_median_m = found->error.median_m;
    session.ate_p95_m = found->error.p95_m;
    session.offset = found->offset;
  }
}

void add_dropped(const std::vector<std::string>& names_before,
                 const std::filesystem::path& file,
                 MapSummary& summary) {
  const auto names_now = layer_names(file);
  std::set_difference(names_before.begin(), names_before.end(), names_now.begin(), names_now.end(),
                      std::back_inserter(summary.dropped));
  summary.digest = load_meta(file).digest;
}

void add_reprojection(const BundleResult& result, MapSummary& summary) {
  if (std::find(result.inlier.begin(), result.inlier.end(), 1) == result.inlier.end()) return;
  summary.reprojection_median_px = kFullPerHalfPixel * result.reprojection_median_px;
  summary.reprojection_rms_px = kFullPerHalfPixel * result.reprojection_rms_px;
}

}  // namespace roadbook
