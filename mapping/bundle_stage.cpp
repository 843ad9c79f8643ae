#include "mapping/bundle_stage.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "vo/visual_odometry.hpp"

namespace roadbook {
namespace {

constexpr int kCellPx = 64;  // evenness over the half-size image

// Takes corners in order of worth while any of their images still wants some in that part of it.
class Quota {
 public:
  Quota(const MappingInput& input, int per_image)
      : input_(input), images_(input.odometry.keyframes.size()) {
    for (std::size_t k = 0; k < images_.size(); ++k) {
      const Rig& rig = input.rig_of(static_cast<int>(k));
      for (const auto& mounted : rig.cameras) {
        Image image;
        image.columns = mounted.camera.width / kCellPx + 1;
        const int cells = image.columns * (mounted.camera.height / kCellPx + 1);
        image.per_cell = std::max(1, 2 * per_image / cells);
        image.taken.assign(static_cast<std::size_t>(cells), 0);
        images_[k].push_back(std::move(image));
      }
    }
    per_image_ = per_image;
  }
  bool take(const CornerTrack& track) {
    int wanted = 0;
    for (const auto& view : track.views) wanted += wants(view) ? 1 : 0;
    // A corner that only few of its images want would crowd the others.
    if (2 * wanted < static_cast<int>(track.views.size())) return false;
    for (const auto& view : track.views) {
      Image& image = image_of(view);
      ++image.total;
      ++image.taken[cell_of(view)];
    }
    return true;
  }

 private:
  struct Image {
    int columns = 1;
    int per_cell = 1;
    int total = 0;
    std::vector<int> taken;
  };
  Image& image_of(const CornerView& v) {
    return images_[static_cast<std::size_t>(v.keyframe)][static_cast<std::size_t>(v.camera)];
  }
  std::size_t cell_of(const CornerView& v) {
    const Eigen::Vector2d p = input_.pixel(v);
    const auto column = std::max(0, static_cast<int>(p.x()) / kCellPx);
    const auto row = std::max(0, static_cast<int>(p.y()) / kCellPx);
    return std::min(image_of(v).taken.size() - 1,
                    static_cast<std::size_t>(row * image_of(v).columns + column));
  }
  bool wants(const CornerView& v) {
    const Image& image = image_of(v);
    return image.total < per_image_ && image.taken[cell_of(v)] < image.per_cell;
  }

  const MappingInput& input_;
  std::vector<std::vector<Image>> images_;
  int per_image_ = 0;
};

std::vector<std::size_t> by_worth(const std::vector<CornerTrack>& tracks) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < tracks.size(); ++i)
    if (tracks[i].p_map) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto worth = [&](std::size_t i) {
      return std::tuple(tracks[i].revisited, tracks[i].views.size());
    };
    return worth(a) > worth(b);
  });
  return order;
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
                        const std::vector<CornerTrack>& tracks,
                        const BundleStageOptions& options) {
  BundleStage stage;
  for (const auto& rig : input.half_rigs) {
    stage.camera_base.push_back(static_cast<int>(stage.problem.cameras.size()));
    stage.problem.cameras.insert(stage.problem.cameras.end(), rig.cameras.begin(),
                                 rig.cameras.end());
  }
  for (const auto& T : T_map_vehicle) stage.problem.poses.push_back({T, false});
  add_motions(input, options, stage);

  Quota quota(input, options.per_image);
  std::vector<std::size_t> chosen;
  for (const std::size_t i : by_worth(tracks))
    if (quota.take(tracks[i])) chosen.push_back(i);
  std::sort(chosen.begin(), chosen.end());

  const auto views = view_from_above(input, T_map_vehicle, tracks, options.ground);
  const double level = ground_level(views, options.ground);
  for (const std::size_t i : chosen) {
    const CornerTrack& track = tracks[i];
    const int point = static_cast<int>(stage.problem.points.size());
    BundlePoint p;
    p.p_map = *track.p_map;
    p.ground = on_ground(views[i], level, options.ground);
    p.ground_pose = p.ground ? views[i].keyframe : -1;
    stage.problem.points.push_back(p);
    stage.track_of_point.push_back(static_cast<int>(i));
    for (const auto& view : track.views)
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
