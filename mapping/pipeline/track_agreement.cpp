#include "mapping/pipeline/track_agreement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "base/index.hpp"
#include "base/parallel.hpp"

namespace roadbook {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// The key points of one odometry track within a joined track.
struct Strand {
  std::vector<KeyPointId> views;
  std::optional<Eigen::Vector3d> p_map;  // that fits these views alone
  double own_rms_px = 0.0;               // of the residuals there
};

// A position and the strands that agree with it.
struct Corner {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  std::vector<std::size_t> strands;
  std::size_t views = 0;
};

class TrackJudge {
 public:
  TrackJudge(const MappingInput& input,
             const std::vector<Eigen::Isometry3d>& T_map_vehicle,
             const AgreementOptions& options)
      : input_(input),
        T_map_vehicle_(T_map_vehicle),
        options_(options),
        gate_px_(std::sqrt(options.max_chi2) * options.sigma_px) {}

  // Corners of the track, the one with most views first; empty if the track is to stay as it is.
  [[nodiscard]] std::vector<JoinedTrack> corners_of(const JoinedTrack& track,
                                                    std::size_t& views_dropped) const {
    std::vector<Strand> strands = strands_of(track);
    if (strands.size() < 2) return {};
    for (Strand& strand : strands) fit_alone(strand);
    if (track.p_map && agrees_with_all(strands, *track.p_map) &&
        !(is_of_several_sessions(track.views) && has_outliers(track.views, *track.p_map)))
      return {};
    std::vector<JoinedTrack> result;
    while (!strands.empty()) {
      const auto corner = largest_corner(strands, result.empty() ? track.p_map : std::nullopt);
      if (!corner) break;
      result.push_back(joined(strands, *corner, views_dropped));
      for (auto s = corner->strands.rbegin(); s != corner->strands.rend(); ++s)
        strands.erase(strands.begin() + static_cast<std::ptrdiff_t>(*s));
    }
    std::erase_if(result, [](const JoinedTrack& t) { return t.views.size() < 2; });
    if (result.empty()) result.push_back({track.views, std::nullopt, track.revisited});
    return result;
  }

 private:
  [[nodiscard]] std::vector<Strand> strands_of(const JoinedTrack& track) const {
    std::vector<Strand> strands;
    std::map<int, std::size_t> of_track;
    for (const KeyPointId& view : track.views) {
      const int id =
          input_.odometry.keyframes[at(view.keyframe)].tracks[at(view.camera)][at(view.feature)];
      const auto [place, is_new] = of_track.try_emplace(id, strands.size());
      if (id < 0 || is_new) strands.emplace_back();
      strands[id < 0 ? strands.size() - 1 : place->second].views.push_back(view);
    }
    return strands;
  }

  [[nodiscard]] bool is_of_several_sessions(const std::vector<KeyPointId>& views) const {
    return std::any_of(views.begin(), views.end(), [&](const KeyPointId& view) {
      return input_.session[at(view.keyframe)] != input_.session[at(views.front().keyframe)];
    });
  }

  [[nodiscard]] std::optional<Eigen::Vector2d> residual_px(const KeyPointId& view,
                                                           const Eigen::Vector3d& p_map,
                                                           Matrix23d* J = nullptr) const {
    const MountedCamera& mounted = input_.rig_of(view.keyframe).cameras[at(view.camera)];
    const Eigen::Isometry3d T_camera_map =
        (T_map_vehicle_[at(view.keyframe)] * mounted.T_vehicle_camera).inverse();
    const auto pixel = mounted.camera.project(T_camera_map * p_map, J);
    if (!pixel) return std::nullopt;
    if (J != nullptr) *J = *J * T_camera_map.linear();
    return *pixel - input_.pixel(view);
  }

  [[nodiscard]] double rms_px(const std::vector<KeyPointId>& views,
                              const Eigen::Vector3d& p_map) const {
    double sum = 0.0;
    for (const KeyPointId& view : views) {
      const auto r = residual_px(view, p_map);
      if (!r) return kFar;
      sum += r->squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(views.size()));
  }

  // Position of least robust cost (Huber, width of two standard deviations) from `p_map` on.
  [[nodiscard]] std::optional<Eigen::Vector3d> refined(const std::vector<KeyPointId>& views,
                                                       Eigen::Vector3d p_map) const {
    constexpr int kSteps = 5;
    const double width_px = 2.0 * options_.sigma_px;
    for (int step = 0; step < kSteps; ++step) {
      Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
      Eigen::Vector3d b = Eigen::Vector3d::Zero();
      for (const KeyPointId& view : views) {
        Matrix23d J;
        const auto r = residual_px(view, p_map, &J);
        if (!r || !J.allFinite()) continue;
        const double weight = std::min(1.0, width_px / std::max(r->norm(), 1e-12));
        H.noalias() += weight * J.transpose() * J;
        b.noalias() += weight * J.transpose() * *r;
      }
      const Eigen::LDLT<Eigen::Matrix3d> ldlt(H);
      if (ldlt.info() != Eigen::Success || !(ldlt.vectorD().minCoeff() > 0.0)) return std::nullopt;
      p_map -= ldlt.solve(b);
      if (!p_map.allFinite()) return std::nullopt;
    }
    return p_map;
  }

  void fit_alone(Strand& strand) const {
    const auto p =
        triangulate_key_points(input_, T_map_vehicle_, strand.views, options_.triangulation);
    if (p) strand.p_map = refined(strand.views, *p);
    if (!strand.p_map) return;
    strand.own_rms_px = rms_px(strand.views, *strand.p_map);
    if (!std::isfinite(strand.own_rms_px)) strand.p_map.reset();
  }

  [[nodiscard]] bool agrees(const Strand& strand, const Eigen::Vector3d& p_map) const {
    const double rms = rms_px(strand.views, p_map);
    const double own = strand.p_map ? strand.own_rms_px : 0.0;
    return rms * rms <= own * own + gate_px_ * gate_px_;
  }

  [[nodiscard]] bool agrees_with_all(const std::vector<Strand>& strands,
                                     const Eigen::Vector3d& p_map) const {
    return std::all_of(strands.begin(), strands.end(),
                       [&](const Strand& strand) { return agrees(strand, p_map); });
  }

  [[nodiscard]] bool is_outlier(const KeyPointId& view, const Eigen::Vector3d& p_map) const {
    const auto r = residual_px(view, p_map);
    return !r || r->norm() > gate_px_;
  }

  [[nodiscard]] bool has_outliers(const std::vector<KeyPointId>& views,
                                  const Eigen::Vector3d& p_map) const {
    return std::any_of(views.begin(), views.end(),
                       [&](const KeyPointId& view) { return is_outlier(view, p_map); });
  }

  [[nodiscard]] std::vector<KeyPointId> views_of(const std::vector<Strand>& strands,
                                                 const std::vector<std::size_t>& chosen) const {
    std::vector<KeyPointId> views;
    for (const std::size_t s : chosen)
      views.insert(views.end(), strands[s].views.begin(), strands[s].views.end());
    return views;
  }

  // The strands that agree with a position, which moves to fit them.
  [[nodiscard]] std::optional<Corner> corner_at(const std::vector<Strand>& strands,
                                                const Eigen::Vector3d& start) const {
    constexpr int kRounds = 3;
    Corner corner;
    corner.p_map = start;
    for (int round = 0; round < kRounds; ++round) {
      std::vector<std::size_t> chosen;
      for (std::size_t s = 0; s < strands.size(); ++s)
        if (agrees(strands[s], corner.p_map)) chosen.push_back(s);
      if (chosen.empty() || chosen == corner.strands) break;
      const auto views = views_of(strands, chosen);
      const auto p = refined(views, corner.p_map);
      if (!p) break;
      corner = {*p, std::move(chosen), views.size()};
    }
    std::erase_if(corner.strands, [&](std::size_t s) { return !agrees(strands[s], corner.p_map); });
    corner.views = views_of(strands, corner.strands).size();
    if (corner.views < 2) return std::nullopt;
    return corner;
  }

  // A strand that agrees with an earlier corner starts no search of its own.
  [[nodiscard]] std::optional<Corner> largest_corner(
      const std::vector<Strand>& strands, const std::optional<Eigen::Vector3d>& whole) const {
    std::optional<Corner> best;
    std::vector<bool> is_covered(strands.size(), false);
    const auto try_at = [&](const Eigen::Vector3d& start) {
      auto corner = corner_at(strands, start);
      if (!corner) return;
      for (const std::size_t s : corner->strands) is_covered[s] = true;
      if (!best || corner->views > best->views) best = std::move(corner);
    };
    if (whole) try_at(*whole);
    for (std::size_t s = 0; s < strands.size(); ++s)
      if (strands[s].p_map && !is_covered[s]) try_at(*strands[s].p_map);
    return best;
  }

  [[nodiscard]] JoinedTrack joined(const std::vector<Strand>& strands,
                                   const Corner& corner,
                                   std::size_t& views_dropped) const {
    JoinedTrack track;
    track.views = views_of(strands, corner.strands);
    track.p_map = corner.p_map;
    track.revisited = corner.strands.size() > 1;
    std::sort(track.views.begin(), track.views.end(), [](const auto& a, const auto& b) {
      return std::pair(a.keyframe, a.camera) < std::pair(b.keyframe, b.camera);
    });
    if (!is_of_several_sessions(track.views)) return track;
    views_dropped += std::erase_if(
        track.views, [&](const KeyPointId& view) { return is_outlier(view, corner.p_map); });
    if (const auto p = refined(track.views, corner.p_map)) track.p_map = p;
    return track;
  }

  const MappingInput& input_;
  const std::vector<Eigen::Isometry3d>& T_map_vehicle_;
  const AgreementOptions& options_;
  double gate_px_;
};

}  // namespace

double sigma_of_median_px(double median_px) {
  constexpr double kMedianOfRayleigh = 1.17741;  // of lengths, in standard deviations
  constexpr double kLeast_px = 0.1;              // no corner is measured better
  return std::max(kLeast_px, median_px / kMedianOfRayleigh);
}

AgreementCounts split_disagreeing_tracks(const MappingInput& input,
                                         const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                         const AgreementOptions& options,
                                         std::vector<JoinedTrack>& tracks) {
  const TrackJudge judge(input, T_map_vehicle, options);
  const std::size_t count = tracks.size();
  std::vector<std::vector<JoinedTrack>> corners(count);
  std::vector<std::size_t> dropped(count, 0);
  parallel_for_small(count, options.num_threads, [&](std::size_t t) {
    if (tracks[t].revisited) corners[t] = judge.corners_of(tracks[t], dropped[t]);
  });
  AgreementCounts counts;
  for (std::size_t t = 0; t < count; ++t) {
    counts.views_dropped += dropped[t];
    if (corners[t].empty()) continue;
    counts.split += corners[t].size() > 1 ? 1 : 0;
    tracks[t] = std::move(corners[t].front());
    for (std::size_t c = 1; c < corners[t].size(); ++c) tracks.push_back(std::move(corners[t][c]));
  }
  return counts;
}

}  // namespace roadbook
