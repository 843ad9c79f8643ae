#include "mapping/pipeline/bundle_problem.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <tuple>

#include "vo/planar_motion.hpp"

namespace roadbook {
namespace {

constexpr int kCellPx = 64;  // evenness over the half-size image

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

// The key points of each pass around the keyframe nearest to the corner.
std::vector<KeyPointId> nearest_views(const JoinedTrack& track,
                                      const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                      int reach_keyframes) {
  std::vector<KeyPointId> kept;
  const auto& views = track.views;
  for (std::size_t begin = 0, end = 0; begin < views.size(); begin = end) {
    int nearest = views[begin].keyframe;
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
      nearest = k;
    }
    for (std::size_t i = begin; i < end; ++i)
      if (std::abs(views[i].keyframe - nearest) <= reach_keyframes) kept.push_back(views[i]);
  }
  return kept;
}

// Revisited and long tracks first; before them ground points where only they give the scale.
std::vector<std::size_t> by_worth(const std::vector<JoinedTrack>& tracks,
                                  const std::vector<std::vector<KeyPointId>>& views,
                                  const std::vector<std::uint8_t>& gives_scale) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < tracks.size(); ++i)
    if (views[i].size() > 1) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto worth = [&](std::size_t i) {
      return std::tuple(gives_scale[i], tracks[i].revisited, views[i].size());
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

  std::vector<std::vector<KeyPointId>> near(tracks.size());
  for (std::size_t i = 0; i < tracks.size(); ++i)
    if (tracks[i].p_map) near[i] = nearest_views(tracks[i], T_map_vehicle, options.reach_keyframes);
  const auto views = view_from_above(input, T_map_vehicle, tracks, options.ground);
  const double level = ground_level(views, options.ground);
  // Without wheels, the ground is a reference only where the cameras' height above it is known.
  const auto is_ground = [&](std::size_t i) {
    if (!on_ground(views[i], level, options.ground)) return false;
    const auto session = static_cast<std::size_t>(
        input.session[static_cast<std::size_t>(tracks[i].views.front().keyframe)]);
    return input.has_wheels[session] || known_camera_height(input.half_rigs[session]);
  };
  std::vector<std::uint8_t> gives_scale(tracks.size(), 0);
  for (std::size_t i = 0; i < tracks.size(); ++i)
    gives_scale[i] =
        is_ground(i) &&
        (!input.has_wheels[static_cast<std::size_t>(
             input.session[static_cast<std::size_t>(tracks[i].views.front().keyframe)])] ||
         lacks_wheels(input, views[i].keyframe));
  Quota quota(input, options.per_image);
  std::vector<std::size_t> chosen;
  for (const std::size_t i : by_worth(tracks, near, gives_scale))
    if (quota.take(near[i])) chosen.push_back(i);
  std::sort(chosen.begin(), chosen.end());

  for (const std::size_t i : chosen) {
    const JoinedTrack& track = tracks[i];
    const int point = static_cast<int>(stage.problem.points.size());
    BundlePoint p;
    p.p_map = *track.p_map;
    p.ground = is_ground(i);
    p.ground_pose = p.ground ? views[i].keyframe : -1;
    stage.problem.points.push_back(p);
    stage.track_of_point.push_back(static_cast<int>(i));
    for (const auto& view : near[i])
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
