#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "drive/drive.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

/// Returns the camera images to which labels are anchored, and the outlines of labels in them.
class AnchorViews {
 public:
  /// `map` and `drives` must outlive the object. `drives` has one entry for each session. The entry
  /// is empty where the drive is not available.
  AnchorViews(const Map* map, const std::vector<std::optional<Drive>>* drives);

  /// Returns the image of a label's anchor and the outline of the label in pixels. Each edge is a
  /// line of several points, because a fisheye lens bends it. Returns {"image": null} where the
  /// drive is not available. Returns null where the label has no place. The image is the one in
  /// which the label was drawn, even if that image is no longer a keyframe.
  [[nodiscard]] nlohmann::json view_of(const Label& label) const;

  /// Returns any image of a session's drive as JPEG. The session, time and camera identify the
  /// image. Returns nothing where the image does not exist.
  [[nodiscard]] std::optional<std::string> image(int session, std::int64_t t_ns, int camera) const;

  [[nodiscard]] bool has_drive() const;

 private:
  const Map* map_;
  const std::vector<std::optional<Drive>>* drives_;
};

}  // namespace roadbook
