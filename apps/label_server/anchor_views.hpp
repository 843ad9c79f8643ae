#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "drive/drive.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

/// The camera images that labels hang on, and labels drawn into them.
class AnchorViews {
 public:
  /// Both must outlive it. `drives`: one a session, empty where it is not at hand.
  AnchorViews(const Map* map, const std::vector<std::optional<Drive>>* drives);

  /// The image of a label's anchor and the label's outline in it, in pixels; edges are lines of
  /// several points, because a fisheye bends them. {"image": null} where the drive is not at hand;
  /// null where the label has no place. The image is the one the label was drawn for, whether it is
  /// still a keyframe's or not.
  [[nodiscard]] nlohmann::json view_of(const Label& label) const;

  /// JPEG of any image of a session's drive by what names it; empty where there is none.
  [[nodiscard]] std::optional<std::string> image(int session, std::int64_t t_ns, int camera) const;

  [[nodiscard]] bool has_drive() const;

 private:
  const Map* map_;
  const std::vector<std::optional<Drive>>* drives_;
};

}  // namespace roadbook
