#include "mapping/pipeline/bundle_problem.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "mapping/union_find.hpp"
#include "sensors/camera_centre.hpp"
#include "vo/planar_motion.hpp"

namespace roadbook {
namespace {

constexpr int kCellPx = 64;                // evenness over the half-size image
constexpr double kLeastShare = 1.0 / 3.0;  // of the key points of an image

int share_of_rig(std::size_t cameras) {
  return cameras >= 4 || cameras == 0 ? 1 : 4 / static_cast<int>(cameras);
}

// Accepts tracks while at least half of their images still need key points in that cell.
class Quota {
 public:
  Quota(const MappingInput& input, int per_image)
      : input_(input), images_(input.odometry.keyframes.size()) {
    for (std::size_t k = 0; k < images_.size(); ++k) {
      const Rig& rig = input.rig_of(static_cast<int>(k));
      const int share = per_image * share_of_rig(rig.cameras.size());
      for (const auto& mounted : rig.cameras) {
        Image image;
        image.columns = mounted.camera.width / kCellPx + 1;
        const int cells = image.columns * (mounted.camera.height / kCellPx + 1);
        image.wanted = share;
        image.per_cell = std::max(1, 2 * share / cells);
        image.taken.assign(static_cast<std::size_t>(cells), 0);
        images_[k].push_back(std::move(image));
      }
    }
  }
  bool take(const std::vector<KeyPointId>& views) {
    int wanted = 0;
    for (const auto& view : views) wanted += wants(view) ? 1 : 0;
    // A track that only few of its images need would fill up the others.
    if (2 * wanted < static_cast<int>(views.size())) return false;
    for (const auto& view : views) {
      Image& image = image_of(view);
      ++image.total;
      ++image.taken[cell_of(view)];
    }
    return true;
  }

  // From here on images need this share of their key points alone.
  void want_less(double share) {
    for (auto& of_keyframe : images_)
      for (Image& image : of_keyframe)
        image.wanted = static_cast<int>(share * static_cast<double>(image.wanted));
  }

 private:
  struct Image {
    int columns = 1;
    int wanted = 0;
    int per_cell = 1;
    int total = 0;
    std::vector<int> taken;
  };
  Image& image_of(const KeyPointId& v) {
    return images_[static_cast<std::size_t>(v.keyframe)][static_cast<std::size_t>(v.camera)];
  }
  std::size_t cell_of(const KeyPointId& v) {
    const Eigen::Vector2d p = input_.pixel(v);
    const auto column = std::max(0, static_cast<int>(p.x()) / kCellPx);
    const auto row = std::max(0, static_cast<int>(p.y()) / kCellPx);
    return std::min(image_of(v).taken.size() - 1,
                    static_cast<std::size_t>(row * image_of(v).columns + column));
  }
  bool wants(const KeyPointId& v) {
    const Image& image = image_of(v);
    return image.total < image.wanted && image.taken[cell_of(v)] < image.per_cell;
  }

  const MappingInput& input_;
  std::vector<std::vector<Image>> images_;
};

// A key point this many keyframes after the previous one belongs to another pass.
constexpr int kPassGapKeyframes = 20;

// Key points of one corner that may become a point of the problem.
struct Candidate {
  std::size_t track;
  bool revisited;  // by the views of this candidate
  int group;       // of passes
  std::vector<KeyPointId> views;
};

// Passes over one place in groups. The last pass of a group is the first one of the next: it holds
// both together.
class PassGroups {
 public:
  PassGroups(std::vector<int> pass_number, int passes_together)
      : number_(std::move(pass_number)), step_(std::max(2, passes_together) - 1) {}
  [[nodiscard]] int group_of(int keyframe) const {
    const int n = number_[static_cast<std::size_t>(keyframe)];
    return n == 0 ? 0 : (n - 1) / step_;
  }
  // The group that begins with the keyframe's pass.
  [[nodiscard]] std::optional<int> next_of(int keyframe) const {
    const int n = number_[static_cast<std::size_t>(keyframe)];
    if (n == 0 || n % step_ != 0) return std::nullopt;
    return n / step_;
  }
  // Whether the keyframe's pass belongs to another group than the first.
  [[nodiscard]] bool is_late(int keyframe) const {
    return number_[static_cast<std::size_t>(keyframe)] > step_;
  }
  [[nodiscard]] bool holds(int group, int keyframe) const {
    return group_of(keyframe) == group || next_of(keyframe) == group;
  }

 private:
  std::vector<int> number_;
  int step_;
};

// The key points of one pass around its keyframe nearest to the corner.
struct PassViews {
  int nearest;
  std::vector<KeyPointId> views;
};

std::vector<PassViews> views_by_pass(const JoinedTrack& track,
                                     const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                     const PassGroups& groups,
                                     const BundleStageOptions& options) {
  std::vector<PassViews> passes;
  const auto& views = track.views;
  for (std::size_t begin = 0, end = 0; begin < views.size(); begin = end) {
    PassViews pass{views[begin].keyframe, {}};
    double least = std::numeric_limits<double>::max();
    for (end = begin;
         end < views.size() &&
         (end == begin || views[end].keyframe - views[end - 1].keyframe <= kPassGapKeyframes);
         ++end) {
      const int k = views[end].keyframe;
      const double distance =
          (T_map_vehicle[static_cast<std::size_t>(k)].translation() - *track.p_map).norm();
      if (distance >= least) continue;
      least = distance;
      pass.nearest = k;
    }
    const int reach =
        groups.is_late(pass.nearest) ? options.reach_of_many_passes : options.reach_keyframes;
    for (std::size_t i = begin; i < end; ++i)
      if (std::abs(views[i].keyframe - pass.nearest) <= reach) pass.views.push_back(views[i]);
    passes.push_back(std::move(pass));
  }
  return passes;
}

// Candidates of one corner: one in each group of passes that saw it.
void add_candidates(std::size_t track,
                    const std::vector<PassViews>& passes,
                    const PassGroups& groups,
                    std::vector<Candidate>& candidates) {
  std::map<int, std::vector<KeyPointId>> by_group;
  for (const PassViews& pass : passes) {
    auto& views = by_group[groups.group_of(pass.nearest)];
    views.insert(views.end(), pass.views.begin(), pass.views.end());
  }
  for (const PassViews& pass : passes)
    if (const auto next = groups.next_of(pass.nearest))
      if (const auto found = by_group.find(*next); found != by_group.end())
        found->second.insert(found->second.end(), pass.views.begin(), pass.views.end());
  for (auto& [group, views] : by_group) {
    if (views.size() < 2) continue;
    std::sort(views.begin(), views.end(), [](const KeyPointId& a, const KeyPointId& b) {
      return std::tuple(a.keyframe, a.camera) < std::tuple(b.keyframe, b.camera);
    });
    const bool one_pass =
        by_group.size() > 1 && views.back().keyframe - views.front().keyframe <= kPassGapKeyframes;
    candidates.push_back({track, !one_pass, group, std::move(views)});
  }
}

// Parts of the drives that tracks or odometry join; others have frames of their own.
std::vector<int> joined_pieces(const MappingInput& input, const std::vector<JoinedTrack>& tracks) {
  UnionFind sets(input.odometry.keyframes.size());
  for (std::size_t k = 1; k < input.odometry.keyframes.size(); ++k)
    if (input.session[k] == input.session[k - 1] && !input.odometry.keyframes[k].after_gap)
      sets.join(static_cast<int>(k) - 1, static_cast<int>(k));
  for (const JoinedTrack& track : tracks)
    for (std::size_t v = 1; v < track.views.size(); ++v)
      sets.join(track.views[v - 1].keyframe, track.views[v].keyframe);
  return sets.numbers();
}

// Whether the corners of each keyframe were found in other passes. A pass in the dark, say, ties
// nothing together.
std::vector<bool> are_tied(std::size_t keyframes, const std::vector<JoinedTrack>& tracks) {
  constexpr int kLeastCorners = 10;
  std::vector<int> corners(keyframes, 0);
  for (const JoinedTrack& track : tracks) {
    const auto& views = track.views;
    const bool one_pass = std::adjacent_find(views.begin(), views.end(),
                                             [](const KeyPointId& a, const KeyPointId& b) {
                                               return b.keyframe - a.keyframe > kPassGapKeyframes;
                                             }) == views.end();
    if (one_pass) continue;
    for (const KeyPointId& view : views) ++corners[static_cast<std::size_t>(view.keyframe)];
  }
  std::vector<bool> tied;
  for (const int count : corners) tied.push_back(count >= kLeastCorners);
  return tied;
}

PassGroups groups_of(const MappingInput& input,
                     const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                     const std::vector<JoinedTrack>& tracks,
                     const BundleStageOptions& options) {
  if (options.passes_together <= 0)
    return {std::vector<int>(T_map_vehicle.size(), 0), options.passes_together};
  return {pass_numbers(input, T_map_vehicle, joined_pieces(input, tracks),
                       are_tied(T_map_vehicle.size(), tracks), options.passes),
          options.passes_together};
}

std::vector<Candidate> candidates_of(const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                     const std::vector<JoinedTrack>& tracks,
                                     const PassGroups& groups,
                                     const BundleStageOptions& options) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < tracks.size(); ++i)
    if (tracks[i].p_map)
      add_candidates(i, views_by_pass(tracks[i], T_map_vehicle, groups, options), groups,
                     candidates);
  return candidates;
}

// Revisited and long tracks first; before them ground points where only they give the scale.
std::vector<std::size_t> by_worth(const std::vector<JoinedTrack>& tracks,
                                  const std::vector<Candidate>& candidates,
                                  const std::vector<std::uint8_t>& gives_scale) {
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto worth = [&](std::size_t c) {
      const Candidate& one = candidates[c];
      return std::tuple(gives_scale[c], one.revisited && tracks[one.track].revisited,
                        one.views.size());
    };
    return worth(a) > worth(b);
  });
  return order;
}

// The motion to this keyframe is known by the cameras alone.
bool lacks_wheels(const MappingInput& input, int keyframe) {
  const VoKeyframe& k = input.odometry.keyframes[static_cast<std::size_t>(keyframe)];
  return keyframe > 0 && !k.after_gap && !k.wheels;
}

void add_motions(const MappingInput& input, const BundleStageOptions& options, BundleStage& stage) {
  stage.scale_of_session.assign(input.half_rigs.size(), -1);
  const auto& keyframes = input.odometry.keyframes;
  for (std::size_t k = 1; k < keyframes.size(); ++k) {
    if (!keyframes[k].wheels || input.session[k] != input.session[k - 1]) continue;
    int& scale = stage.scale_of_session[static_cast<std::size_t>(input.session[k])];
    if (scale < 0) {
      scale = static_cast<int>(stage.problem.scales.size());
      stage.problem.scales.push_back({1.0, 1.0, options.wheel_scale_sigma, false});
    }
    stage.problem.motions.push_back({static_cast<int>(k) - 1, static_cast<int>(k),
                                     planar_transform(*keyframes[k].wheels),
                                     planar_information(*keyframes[k].wheels), scale});
  }
}

}  // namespace

std::vector<std::optional<Eigen::Vector3d>> adjusted_places(
    const BundleStage& stage, const std::vector<std::uint8_t>& point_kept, std::size_t tracks) {
  std::vector<std::optional<Eigen::Vector3d>> places(tracks);
  std::vector<double> views(stage.problem.points.size(), 0.0);
  for (const BundleObservation& o : stage.problem.observations)
    views[static_cast<std::size_t>(o.point)] += 1.0;
  std::vector<double> weight(tracks, 0.0);
  for (std::size_t p = 0; p < stage.problem.points.size(); ++p) {
    if (point_kept[p] == 0) continue;
    const auto track = static_cast<std::size_t>(stage.track_of_point[p]);
    const Eigen::Vector3d& p_map = stage.problem.points[p].p_map;
    weight[track] += views[p];
    // The mean by views; of a single point its own bits.
    places[track] =
        places[track]
            ? Eigen::Vector3d(*places[track] + views[p] / weight[track] * (p_map - *places[track]))
            : p_map;
  }
  return places;
}

BundleStage make_bundle(const MappingInput& input,
                        const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                        const std::vector<JoinedTrack>& tracks,
                        const BundleStageOptions& options) {
  BundleStage stage;
  for (const auto& rig : input.half_rigs) {
    stage.camera_base.push_back(static_cast<int>(stage.problem.cameras.size()));
    stage.problem.cameras.insert(stage.problem.cameras.end(), rig.cameras.begin(),
                                 rig.cameras.end());
  }
  for (const auto& T : T_map_vehicle) stage.problem.poses.push_back({T, false});
  add_motions(input, options, stage);

  const PassGroups groups = groups_of(input, T_map_vehicle, tracks, options);
  const auto candidates = candidates_of(T_map_vehicle, tracks, groups, options);
  const auto views = view_from_above(input, T_map_vehicle, tracks, options.ground);
  const double level = ground_level(views, options.ground);
  // Without wheels, the ground is a reference only where the cameras' height above it is known.
  const auto is_ground = [&](const Candidate& c) {
    if (!on_ground(views[c.track], level, options.ground)) return false;
    const auto session = static_cast<std::size_t>(
        input.session[static_cast<std::size_t>(tracks[c.track].views.front().keyframe)]);
    // With wheels the scale is known without a pose of another group.
    if (input.has_wheels[session] && !groups.holds(c.group, views[c.track].keyframe)) return false;
    return input.has_wheels[session] || known_camera_height(input.half_rigs[session]);
  };
  std::vector<std::uint8_t> gives_scale;
  for (const Candidate& c : candidates)
    gives_scale.push_back(
        is_ground(c) &&
        (!input.has_wheels[static_cast<std::size_t>(
             input.session[static_cast<std::size_t>(tracks[c.track].views.front().keyframe)])] ||
         lacks_wheels(input, views[c.track].keyframe)));
  Quota quota(input, options.per_image);
  std::vector<std::size_t> chosen;
  // A track in one group: a variety of corners. In more where images would have too few key points.
  std::vector<bool> taken(tracks.size(), false);
  std::vector<std::size_t> others;
  for (const std::size_t c : by_worth(tracks, candidates, gives_scale)) {
    if (taken[candidates[c].track]) {
      others.push_back(c);
    } else if (quota.take(candidates[c].views)) {
      taken[candidates[c].track] = true;
      chosen.push_back(c);
    }
  }
  quota.want_less(kLeastShare);
  for (const std::size_t c : others)
    if (quota.take(candidates[c].views)) chosen.push_back(c);
  std::sort(chosen.begin(), chosen.end());

  std::size_t observations = 0;
  for (const std::size_t c : chosen) observations += candidates[c].views.size();
  stage.problem.observations.reserve(observations);
  for (const std::size_t c : chosen) {
    const Candidate& candidate = candidates[c];
    const int point = static_cast<int>(stage.problem.points.size());
    BundlePoint p;
    p.p_map = *tracks[candidate.track].p_map;
    const bool again = !stage.track_of_point.empty() &&
                       stage.track_of_point.back() == static_cast<int>(candidate.track);
    p.corner = again ? stage.problem.points.back().corner : point;
    p.ground = is_ground(candidate);
    p.ground_pose = p.ground ? views[candidate.track].keyframe : -1;
    stage.problem.points.push_back(p);
    stage.track_of_point.push_back(static_cast<int>(candidate.track));
    for (const auto& view : candidate.views)
      stage.problem.observations.push_back(
          {view.keyframe, point,
           stage.camera_base[static_cast<std::size_t>(
               input.session[static_cast<std::size_t>(view.keyframe)])] +
               view.camera,
           input.pixel(view), options.feature_sigma_px});
  }
  return stage;
}

}  // namespace roadbook
