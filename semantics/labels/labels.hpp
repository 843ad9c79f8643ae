#pragma once

#include <Eigen/Geometry>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/se3.hpp"
#include "mapping/map.hpp"
#include "mapping/session_track.hpp"
#include "semantics/oriented_box.hpp"
#include "semantics/people/person_camera.hpp"

namespace roadbook {

// Labels of things on the ground (document 004, V-A.3). A label is stored relative to the vehicle
// pose that saw it, never in map coordinates: when the map is optimised again, its place moves with
// that pose and nobody labels anew.
//
// Labels in images (document 004, VI-B) are kept beside them: windows that show somebody or nobody.
// They hang on an image, have no place on the ground, and are in none of the functions below that
// speak of the map: those answer as for a label that has no place.

/// Where a label hangs: the image by what names it for ever. It was a keyframe's when the label was
/// drawn; a map that is built again may choose others.
struct LabelAnchor {
  int session = 0;        ///< index in the map
  std::int64_t t_ns = 0;  ///< stamp of the image
  int camera = 0;         ///< index in the session's rig
  [[nodiscard]] friend auto operator<=>(const LabelAnchor&, const LabelAnchor&) = default;
};

/// Upright: a window of the anchor's image. Image: all of it, with nobody but whom other labels
/// show.
enum class LabelShape { kBox, kPolygon, kUpright, kImage };
enum class LabelSource { kDrawn, kAccepted, kDetected };
enum class LabelState { kActive, kDeleted };

[[nodiscard]] constexpr const char* to_text(LabelShape shape) {
  switch (shape) {
    case LabelShape::kBox:
      return "box";
    case LabelShape::kPolygon:
      return "polygon";
    case LabelShape::kUpright:
      return "upright";
    case LabelShape::kImage:
      return "image";
  }
  return "";
}

[[nodiscard]] constexpr const char* to_text(LabelSource source) {
  switch (source) {
    case LabelSource::kDrawn:
      return "drawn";
    case LabelSource::kAccepted:
      return "accepted";
    case LabelSource::kDetected:
      return "detected";
  }
  return "";
}

/// Another image in which the same thing was found, and where: what it says about the label's place
/// must agree with the label's own anchor (semantics/labels/label_agreement.hpp).
struct LabelSighting {
  LabelAnchor anchor;
  Eigen::Vector3d middle_vehicle = Eigen::Vector3d::Zero();  ///< of the thing, anchor's vehicle [m]
  double sigma_m = 0.05;                                     ///< each coordinate
};

/// Where somebody saw a label in the map of that day. No place of the label: what it is compared
/// with when the map has moved.
struct LabelSeen {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();      ///< map frame [m]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of the middle, then [m^2]
  int sessions = 0;                                      ///< that the map had; 0: not known
};

/// Of the middle of a box as a search found it, each coordinate [m]: nobody has put it right.
inline constexpr double kFoundSigma_m = 0.12;

/// A label as it stands. Coordinates are in the frame of its anchor's vehicle [m].
struct Label {
  std::int64_t id = 0;       ///< given by the store, from 1; never used again
  std::int64_t version = 0;  ///< counts the label's changes, from 1
  LabelState state = LabelState::kActive;
  std::string kind;  ///< class: "parking_space", "crossing", ...
  LabelSource source = LabelSource::kDrawn;
  std::string who;        ///< who changed it last
  std::int64_t t_ns = 0;  ///< when, since 1970
  double score = 1.0;     ///< probability with which a detector found it; 1 where none did, or
                          ///< nobody told with which
  double sigma_m = 0.03;  ///< of the drawing: standard deviation of the middle, each coordinate
  LabelAnchor anchor;
  LabelShape shape = LabelShape::kBox;
  // A box: pose of its middle (x along its length, z up) and sides. A polygon: its corners.
  Eigen::Isometry3d T_vehicle_label = Eigen::Isometry3d::Identity();
  double length_m = 0.0;
  double width_m = 0.0;
  std::vector<Eigen::Vector3d> corners_vehicle;
  // An upright window, of the anchor's camera; and as PNG what it showed (of an image: what some of
  // its windows that show nobody did), so that it teaches without the recording.
  PersonBox window;
  std::vector<std::string> pictures;
  std::vector<LabelSighting> sightings;  ///< in further images
  std::optional<LabelSeen> seen;         ///< when it was last drawn, accepted or changed
  std::string note;
};

/// A thing on the ground, not a window of an image.
[[nodiscard]] constexpr bool is_on_ground(const Label& label) {
  return label.shape == LabelShape::kBox || label.shape == LabelShape::kPolygon;
}

/// Whether a search is known to have found it, with probability `score`, before somebody said what
/// it is: only that tells of searches.
[[nodiscard]] constexpr bool was_found(const Label& label) {
  return label.source != LabelSource::kDrawn && label.score < 1.0;
}

/// Where the anchor's vehicle was in the map of today: what all else that places labels asks. Its
/// keyframe's pose or, where keyframes have been chosen anew, one of the session's track
/// (mapping/session_track.hpp). Empty where the map has no pose of that moment.
[[nodiscard]] std::optional<TrackPose> vehicle_of(const Map& map, const LabelAnchor& anchor);

/// Index of the anchor's keyframe; empty where its image is none (any more).
[[nodiscard]] std::optional<int> keyframe_of(const Map& map, const LabelAnchor& anchor);
/// The keyframe of the anchor's session that is nearest in time; empty where the session has none.
[[nodiscard]] std::optional<int> nearest_keyframe_of(const Map& map, const LabelAnchor& anchor);

/// The middle of a label's shape, in the frame of its anchor's vehicle [m].
[[nodiscard]] Eigen::Vector3d middle_of(const Label& label);

/// Corners of a box or polygon on the ground, in the same frame; none of a window.
[[nodiscard]] std::vector<Eigen::Vector3d> corners_of(const Label& label);

/// Where a label is in the map of today. All empty where the map has no pose for its anchor.
[[nodiscard]] std::optional<OrientedBox> box_in_map(const Map& map, const Label& label);
[[nodiscard]] std::vector<Eigen::Vector3d> corners_in_map(const Map& map, const Label& label);

/// Covariance of the label's middle in the map, x and y [m^2]: the pose's (gauge: the map's first
/// keyframe) and the drawing's.
[[nodiscard]] std::optional<Eigen::Matrix2d> covariance_in_map(const Map& map, const Label& label);

/// Standard deviation of the middle in its least certain direction [m].
[[nodiscard]] std::optional<double> sigma_in_map(const Map& map, const Label& label);

/// What a person sees of a label in the map of today; empty where it has no place.
[[nodiscard]] std::optional<LabelSeen> seen_in_map(const Map& map, const Label& label);

/// A box or polygon of the map, standing on the ground at the anchor's vehicle plane, as a label of
/// that anchor. Throws InvalidOption where the map has no pose for it.
[[nodiscard]] Label label_of_box(const Map& map, const LabelAnchor& anchor, const OrientedBox& box);
[[nodiscard]] Label label_of_polygon(const Map& map,
                                     const LabelAnchor& anchor,
                                     const std::vector<Eigen::Vector2d>& corners);

struct AnchorOptions {
  double max_range_m = 12.0;  ///< from the camera to the middle of the thing
  /// The image it hangs on. It stays there while that is as near to central but for
  /// `as_central_rad`: a label moved by less than a metre would go through many images.
  std::optional<LabelAnchor> now{};
  double as_central_rad = 0.25;
};

/// The image in which all corners are seen and the middle is nearest to the image's (as angle from
/// the optical axis), or `now`; empty where no image sees it. `corners`: map frame, on the ground
/// plane of the nearest vehicle.
[[nodiscard]] std::optional<LabelAnchor> most_central_view(
    const Map& map, const std::vector<Eigen::Vector2d>& corners, const AnchorOptions& options = {});

/// All views of one session that see all corners, the most central first, one of each camera every
/// half metre.
[[nodiscard]] std::vector<LabelAnchor> central_views(const Map& map,
                                                     const std::vector<Eigen::Vector2d>& corners,
                                                     int session,
                                                     const AnchorOptions& options = {});

/// The most central view from nearby or, where there is none, from up to 30 m.
[[nodiscard]] std::optional<LabelAnchor> anchor_for(
    const Map& map,
    const std::vector<Eigen::Vector2d>& corners,
    const std::optional<LabelAnchor>& now = std::nullopt);

}  // namespace roadbook
