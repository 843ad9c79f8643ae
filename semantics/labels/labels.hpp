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
#include "semantics/labels/keyframe_index.hpp"
#include "semantics/oriented_box.hpp"
#include "semantics/people/person_camera.hpp"

namespace roadbook {

// Labels of things on the ground. A label is stored relative to the vehicle pose of its image,
// never in map coordinates. When the map is optimised again, the label moves with that pose and
// stays right without new work. Source: [metric-semantic maps, section V-A.3].
//
// Labels of image windows are stored in the same log: windows that show a person, or none. They
// belong to an image and have no position on the ground, so functions that return a position return
// none for them. Source: [metric-semantic maps, section VI-B].

/// Image to which a label is anchored. Session, stamp and camera identify the image permanently. It
/// was a keyframe when the label was drawn; a rebuilt map may choose other keyframes.
struct LabelAnchor {
  int session = 0;        ///< index in the map
  std::int64_t t_ns = 0;  ///< stamp of the image
  int camera = 0;         ///< index in the session's rig
  [[nodiscard]] friend auto operator<=>(const LabelAnchor&, const LabelAnchor&) = default;
};

/// kUpright: bounding box of a person in the anchor's image. kImage: the whole image, in which
/// every person is labelled.
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

/// A further measurement of a label's position, in another image. A right map places it where the
/// label's own anchor does (semantics/labels/label_agreement.hpp).
struct LabelSighting {
  LabelAnchor anchor;
  Eigen::Vector3d middle_vehicle = Eigen::Vector3d::Zero();  ///< in `anchor`'s vehicle frame [m]
  double sigma_m = 0.05;  ///< standard deviation, each coordinate
};

/// Position of a label in the map when a person last confirmed it. It does not define the position;
/// later positions are compared with it.
struct LabelSeen {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();      ///< map frame [m]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of the middle at that time [m^2]
  int sessions = 0;  ///< number of sessions of the map at that time; 0: unknown
};

/// Standard deviation of the middle of a box found by a search and not corrected, each coordinate
/// [m].
inline constexpr double kFoundSigma_m = 0.12;

/// State of a label. Coordinates are in the vehicle frame of its anchor [m].
struct Label {
  std::int64_t id = 0;       ///< assigned by the store, from 1; never reused
  std::int64_t version = 0;  ///< number of changes, from 1
  LabelState state = LabelState::kActive;
  std::string kind;  ///< class: "parking_space", "crossing", ...
  LabelSource source = LabelSource::kDrawn;
  std::string who;        ///< labeller who changed it last
  std::int64_t t_ns = 0;  ///< time of that change, since 1970 [ns]
  double score = 1.0;     ///< detector's probability; 1 if drawn by hand or unknown
  double sigma_m = 0.03;  ///< standard deviation of the drawn middle, each coordinate
  LabelAnchor anchor;
  LabelShape shape = LabelShape::kBox;
  // Box: pose of its middle (x along its length, z up) and sides. Polygon: its corners.
  Eigen::Isometry3d T_vehicle_label = Eigen::Isometry3d::Identity();
  double length_m = 0.0;
  double width_m = 0.0;
  std::vector<Eigen::Vector3d> corners_vehicle;
  // kUpright: window in the anchor's camera, and its crop as PNG. kImage: crops of windows that
  // show no person. The crops allow training without the recording.
  PersonBox window;
  std::vector<std::string> pictures;
  std::vector<LabelSighting> sightings;  ///< further measurements of the position
  std::optional<LabelSeen> seen;         ///< position when last drawn, accepted or changed
  std::string note;
};

/// True for a label on the ground, false for a window of an image.
[[nodiscard]] constexpr bool is_on_ground(const Label& label) {
  return label.shape == LabelShape::kBox || label.shape == LabelShape::kPolygon;
}

/// True if a search found the label with probability `score` before a person answered. Only such
/// labels measure the quality of searches.
[[nodiscard]] constexpr bool was_found(const Label& label) {
  return label.source != LabelSource::kDrawn && label.score < 1.0;
}

/// Pose of the anchor's vehicle at the current map state. All functions that place a label use it.
/// The pose of the anchor's keyframe or, if keyframes were chosen again, interpolated on the
/// session's track (mapping/session_track.hpp). Empty if the map has no pose at that time.
[[nodiscard]] std::optional<TrackPose> vehicle_of(const Map& map, const LabelAnchor& anchor);

/// Index of the anchor's keyframe; empty if its image is no keyframe.
[[nodiscard]] std::optional<int> keyframe_of(const Map& map, const LabelAnchor& anchor);
/// The keyframe of the anchor's session nearest in time; empty if the session has none.
[[nodiscard]] std::optional<int> nearest_keyframe_of(const Map& map, const LabelAnchor& anchor);

/// Middle of a label's shape, in the vehicle frame of its anchor [m].
[[nodiscard]] Eigen::Vector3d middle_of(const Label& label);

/// Corners of a box or polygon on the ground, vehicle frame of the anchor [m]; empty for a window.
[[nodiscard]] std::vector<Eigen::Vector3d> corners_of(const Label& label);

/// Box or corners of a label at the current map state, map frame. Empty if the map has no pose for
/// the anchor.
[[nodiscard]] std::optional<OrientedBox> box_in_map(const Map& map, const Label& label);
[[nodiscard]] std::vector<Eigen::Vector3d> corners_in_map(const Map& map, const Label& label);

/// Covariance of the label's middle, x and y in the map frame [m^2]: covariance of the pose
/// (relative to the first keyframe of its piece) plus that of the drawing. Empty if the map has no
/// pose for the anchor or does not know its covariance.
[[nodiscard]] std::optional<Eigen::Matrix2d> covariance_in_map(const Map& map, const Label& label);

/// Standard deviation of the middle in its least certain direction [m].
[[nodiscard]] std::optional<double> sigma_in_map(const Map& map, const Label& label);

/// Current position, covariance (NaN: unknown) and number of sessions, to be stored as Label::seen
/// if all are known; empty if the label has no position.
[[nodiscard]] std::optional<LabelSeen> seen_in_map(const Map& map, const Label& label);

/// Converts a box or polygon in map coordinates to a label of `anchor`, on the ground plane of the
/// anchor's vehicle. Throws InvalidOption if the map has no pose for the anchor.
[[nodiscard]] Label label_of_box(const Map& map, const LabelAnchor& anchor, const OrientedBox& box);
[[nodiscard]] Label label_of_polygon(const Map& map,
                                     const LabelAnchor& anchor,
                                     const std::vector<Eigen::Vector2d>& corners);

struct AnchorOptions {
  double max_range_m = 12.0;  ///< largest distance from the camera to the middle of the label
  /// Current anchor, if any. It is kept if its angle exceeds the smallest by at most
  /// `as_central_rad`, so that a small edit does not change the image.
  std::optional<LabelAnchor> now{};
  double as_central_rad = 0.25;
};

/// The image that shows all corners with the middle nearest to the optical axis, or `options.now`
/// (see there); empty if no image shows all corners. `corners`: map frame; they are projected to
/// the ground plane of each vehicle.
[[nodiscard]] std::optional<LabelAnchor> most_central_view(
    const Map& map, const std::vector<Eigen::Vector2d>& corners, const AnchorOptions& options = {});

/// All views of one session that show all corners, sorted by angle from the optical axis. Views of
/// one camera are at least half a metre apart.
[[nodiscard]] std::vector<LabelAnchor> central_views(const Map& map,
                                                     const std::vector<Eigen::Vector2d>& corners,
                                                     int session,
                                                     const AnchorOptions& options = {});

/// `most_central_view` within 12 m; if there is none, within 30 m.
[[nodiscard]] std::optional<LabelAnchor> anchor_for(
    const Map& map,
    const std::vector<Eigen::Vector2d>& corners,
    const std::optional<LabelAnchor>& now = std::nullopt);
/// The same result, without a scan of all keyframes: for many labels of one map.
[[nodiscard]] std::optional<LabelAnchor> anchor_for(
    const KeyframeIndex& keyframes,
    const std::vector<Eigen::Vector2d>& corners,
    const std::optional<LabelAnchor>& now = std::nullopt);

}  // namespace roadbook
