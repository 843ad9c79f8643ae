#include "semantics/labels/label_evidence.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"

namespace roadbook {
namespace {

constexpr double kStepM = 0.10;    // along the outline
constexpr double kBesideM = 0.22;  // from the middle of a line to the ground next to the line
constexpr double kSigmaM = 0.05;   // standard deviation of a place found in an image

// A point on the outline and the direction across the outline, map frame.
struct OutlinePoint {
  Eigen::Vector3d p;
  Eigen::Vector3d across;
};

std::vector<OutlinePoint> outline_of(const Map& map, const Label& label) {
  const auto corners = corners_in_map(map, label);
  std::vector<OutlinePoint> points;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d edge = corners[(i + 1) % corners.size()] - corners[i];
    const Eigen::Vector3d across = Eigen::Vector3d(-edge.y(), edge.x(), 0.0).normalized();
    const int steps = std::max(1, static_cast<int>(edge.norm() / kStepM));
    for (int k = 0; k < steps; ++k)
      points.push_back({corners[i] + edge * (k + 0.5) / steps, across});
  }
  return points;
}

/// An image of the ground. Its pixels are read by map coordinates.
class EvidenceView {
 public:
  EvidenceView(const Map& map, int keyframe, int camera, cv::Mat image)
      : mounted_(map.sessions[static_cast<std::size_t>(
                                  map.keyframes[static_cast<std::size_t>(keyframe)].session)]
                     .rig.cameras[static_cast<std::size_t>(camera)]),
        T_camera_map_((map.T_map_vehicle(keyframe) * mounted_.T_vehicle_camera).inverse()),
        image_(std::move(image)) {}

  /// Grey value between pixels; negative outside.
  [[nodiscard]] double grey(const Eigen::Vector3d& p) const {
    const auto pixel = mounted_.camera.project(T_camera_map_ * p);
    if (!pixel || !(pixel->x() >= 0.0 && pixel->y() >= 0.0 && pixel->x() < image_.cols - 1 &&
                    pixel->y() < image_.rows - 1))
      return -1.0;
    const int u = static_cast<int>(pixel->x());
    const int v = static_cast<int>(pixel->y());
    const double fu = pixel->x() - u;
    const double fv = pixel->y() - v;
    const auto at = [&](int row, int column) -> double {
      return image_.at<std::uint8_t>(row, column);
    };
    return (1 - fv) * ((1 - fu) * at(v, u) + fu * at(v, u + 1)) +
           fv * ((1 - fu) * at(v + 1, u) + fu * at(v + 1, u + 1));
  }

 private:
  const MountedCamera& mounted_;
  Eigen::Isometry3d T_camera_map_;
  cv::Mat image_;
};

struct Profile {
  bool seen = false;
  double contrast = 0.0;  ///< brightness of the middle minus the brighter of the two sides
  double ground = 0.0;    ///< mean brightness of the two sides
  double spread = 0.0;    ///< largest difference between the middle and the two sides
};

Profile profile_at(const EvidenceView& view,
                   const OutlinePoint& point,
                   const Eigen::Vector3d& shift) {
  const Eigen::Vector3d p = point.p + shift;
  const std::array<double, 3> g{view.grey(p - kBesideM * point.across), view.grey(p),
                                view.grey(p + kBesideM * point.across)};
  Profile profile;
  const auto [low, high] = std::minmax_element(g.begin(), g.end());
  if (*low < 0.0) return profile;
  profile.seen = true;
  profile.contrast = g[1] - std::max(g[0], g[2]);
  profile.ground = 0.5 * (g[0] + g[2]);
  profile.spread = *high - *low;
  return profile;
}

struct Paint {
  OutlinePoint point;
  Profile own;
};

struct Score {
  double paint = 0.0;
  double bare = 0.0;
  double match = 0.0;  ///< mean share of the paint's contrast; highest where the paint of both
                       ///< images coincides
};

// Computes the share of the label's paint that another view shows too, and the share that is plain
// ground in that view. The exposure of the two images may differ by a factor. The ground next to
// the paint gives this factor.
Score score_of(const EvidenceView& view,
               const std::vector<Paint>& paint,
               const Eigen::Vector3d& shift,
               double least_contrast) {
  Score score;
  for (const Paint& one : paint) {
    const Profile now = profile_at(view, one.point, shift);
    if (!now.seen) continue;
    const double gain = std::clamp(now.ground / std::max(1.0, one.own.ground), 0.5, 2.0);
    const double least = std::max(0.5 * least_contrast, 0.4 * gain * one.own.contrast);
    score.match += std::clamp(now.contrast / (gain * one.own.contrast), 0.0, 1.0);
    if (now.contrast > least)
      score.paint += 1.0;
    else if (now.spread < least && std::abs(now.ground - one.own.ground) < 0.3 * one.own.ground)
      score.bare += 1.0;
  }
  score.match /= static_cast<double>(paint.size());
  score.paint /= static_cast<double>(paint.size());
  score.bare /= static_cast<double>(paint.size());
  return score;
}

// The directions in which the paint determines the shift. `across` is the direction across most of
// the paint. `both`: enough paint runs in other directions to determine the shift along `along`
// too.
struct Directions {
  Eigen::Vector2d across;
  Eigen::Vector2d along;
  bool both = false;
};

Directions directions_of(const std::vector<Paint>& paint) {
  Eigen::Matrix2d normals = Eigen::Matrix2d::Zero();
  for (const Paint& one : paint) {
    const Eigen::Vector2d n = one.point.across.head<2>();
    normals += n * n.transpose() / static_cast<double>(paint.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(normals);
  constexpr double kLeastShare = 0.1;
  return {axes.eigenvectors().col(1), axes.eigenvectors().col(0),
          axes.eigenvalues()[0] > kLeastShare};
}

// Finds the shift with the best match: first in steps of 10 cm, then in steps of 2 cm near the best
// shift. Of equal matches, the shortest shift wins.
std::pair<Eigen::Vector2d, Score> best_shift(const EvidenceView& view,
                                             const std::vector<Paint>& paint,
                                             const Directions& directions,
                                             const EvidenceOptions& options) {
  Eigen::Vector2d best = Eigen::Vector2d::Zero();
  Score most = score_of(view, paint, Eigen::Vector3d::Zero(), options.least_contrast);
  const auto search = [&](double reach, double step) {
    const Eigen::Vector2d about = best;
    const int n = static_cast<int>(std::lround(reach / step));
    for (int i = -n; i <= n; ++i)
      for (int j = -n; j <= n; ++j) {
        if (!directions.both && j != 0) continue;
        const Eigen::Vector2d shift = about + step * (i * directions.across + j * directions.along);
        const Score score =
            score_of(view, paint, {shift.x(), shift.y(), 0.0}, options.least_contrast);
        const bool nearer = score.match == most.match && shift.norm() < best.norm();
        if (score.match > most.match || nearer) {
          most = score;
          best = shift;
        }
      }
  };
  if (most.paint < 0.9) search(options.search_m, 0.1);
  search(0.1, 0.02);
  return {best, most};
}

// The session's views of the label, the most central view first, at most one view of each camera.
// The label's own keyframe is left out.
std::vector<LabelAnchor> views_of(
    const Map& map, const Label& label, int own, int session, const EvidenceOptions& options) {
  std::vector<Eigen::Vector2d> corners;
  for (const auto& corner : corners_in_map(map, label)) corners.emplace_back(corner.head<2>());
  std::vector<LabelAnchor> views;
  for (LabelAnchor& view : central_views(map, corners, session, {options.max_range_m}))
    if (keyframe_of(map, view) != own)
      if (static_cast<int>(views.size()) < options.views) views.push_back(view);
  return views;
}

// The points of the outline with paint in the label's own image. Empty if there is too little paint
// to look for.
std::vector<Paint> paint_of(const Map& map,
                            const Label& label,
                            const EvidenceView& own,
                            double least_contrast) {
  std::vector<Paint> paint;
  const auto outline = outline_of(map, label);
  for (const OutlinePoint& point : outline) {
    const Profile profile = profile_at(own, point, Eigen::Vector3d::Zero());
    if (profile.seen && profile.contrast > least_contrast) paint.push_back({point, profile});
  }
  if (paint.size() < std::max<std::size_t>(10, outline.size() / 5)) paint.clear();
  return paint;
}

// Evaluates one more view. Keeps its result if it shows more paint than the views before, and
// keeps the largest share of plain ground.
void look_into(const EvidenceView& view,
               const LabelAnchor& anchor,
               const std::vector<Paint>& paint,
               const EvidenceOptions& options,
               LabelEvidence& evidence) {
  const auto [shift, score] = best_shift(view, paint, directions_of(paint), options);
  // Plain ground is measured at the place itself, not at the shift where other paint matches best.
  const Score here = score_of(view, paint, Eigen::Vector3d::Zero(), options.least_contrast);
  evidence.bare = std::max(evidence.bare, here.bare);
  if (score.paint <= evidence.paint && evidence.status != EvidenceStatus::kUnseen) return;
  evidence.status = EvidenceStatus::kCovered;
  evidence.view = anchor;
  evidence.paint = score.paint;
  evidence.shift = shift;
}

}  // namespace

LabelEvidence look_again(const Map& map,
                         const Label& label,
                         int session,
                         const KeyframeImages& images,
                         const EvidenceOptions& options) {
  LabelEvidence evidence;
  evidence.id = label.id;
  // A newly built map may have other keyframes, so the label's own image may be missing. The
  // nearest keyframe in time shows the same scene.
  const auto own = nearest_keyframe_of(map, label.anchor);
  if (!own || !vehicle_of(map, label.anchor)) return evidence;
  const cv::Mat own_image = images(*own, label.anchor.camera);
  if (own_image.empty()) return evidence;
  const auto paint = paint_of(map, label, EvidenceView(map, *own, label.anchor.camera, own_image),
                              options.least_contrast);
  if (paint.empty()) {
    evidence.status = EvidenceStatus::kNoPaint;
    return evidence;
  }
  for (const LabelAnchor& view : views_of(map, label, *own, session, options)) {
    const int keyframe = *keyframe_of(map, view);
    const cv::Mat image = images(keyframe, view.camera);
    if (!image.empty())
      look_into(EvidenceView(map, keyframe, view.camera, image), view, paint, options, evidence);
  }
  if (evidence.status == EvidenceStatus::kUnseen) return evidence;
  if (evidence.paint >= options.least_paint)
    evidence.status = EvidenceStatus::kFound;
  else if (evidence.bare >= options.least_bare)
    evidence.status = EvidenceStatus::kGone;
  return evidence;
}

LabelSighting sighting_of(const Map& map, const Label& label, const LabelEvidence& evidence) {
  const auto own = vehicle_of(map, label.anchor);
  const auto other = vehicle_of(map, evidence.view);
  if (!own || !other)
    throw InvalidOption("evidence", "an image without a pose in the map", "an image with a pose");
  Eigen::Vector3d place = own->T_map_vehicle * middle_of(label);
  place.head<2>() += evidence.shift;
  return {evidence.view, other->T_map_vehicle.inverse() * place, kSigmaM};
}

}  // namespace roadbook
