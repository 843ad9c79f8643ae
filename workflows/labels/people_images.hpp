#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "drive/drive.hpp"
#include "semantics/labels/labels.hpp"
#include "semantics/people/person_learner.hpp"

namespace roadbook {

/// The camera images in which the server searches for people. It takes one image per time interval
/// from each camera of each session whose drive is available. A LabelAnchor names an image. Safe to
/// use from several threads.
class PeopleImages {
 public:
  /// `map` and `drives` must outlive the object. `drives` has one entry for each session, empty
  /// where the drive is not available. `every_s` is the time between two images.
  PeopleImages(const Map* map,
               const std::vector<std::optional<Drive>>* drives,
               const PersonLearnerOptions& options,
               double every_s);
  ~PeopleImages();

  /// Returns all images, ordered by session, time and camera.
  [[nodiscard]] const std::vector<LabelAnchor>& all() const { return all_; }
  /// Returns whether the session has this camera, and its drive has a frame with this stamp.
  [[nodiscard]] bool has(const LabelAnchor& image) const;
  /// Returns whether the session's drive is available.
  [[nodiscard]] bool at_hand(int session) const {
    return (*drives_)[static_cast<std::size_t>(session)].has_value();
  }
  [[nodiscard]] const Map& map() const { return *map_; }
  /// Returns the image of the same camera `step` images later in `all` (earlier if `step` is
  /// negative).
  [[nodiscard]] std::optional<LabelAnchor> neighbour(const LabelAnchor& image, int step) const;

  /// Empty where the image is missing.
  [[nodiscard]] std::vector<PersonHypothesis> search(const LabelAnchor& image,
                                                     const GpClassifier& classifier) const;
  /// PNG of a window; empty where the image is missing.
  [[nodiscard]] std::string picture(const LabelAnchor& image, const PersonBox& box) const;
  /// Returns the PNGs of several windows of one image. Empty if the image is missing.
  [[nodiscard]] std::vector<std::string> pictures(const LabelAnchor& image,
                                                  const std::vector<PersonBox>& boxes) const;
  /// Returns windows at random positions in the image as PNG. The windows overlap none of `not_on`.
  [[nodiscard]] std::vector<std::string> random_pictures(const LabelAnchor& image,
                                                         const std::vector<PersonBox>& not_on,
                                                         std::size_t count) const;

 private:
  // The search objects of a session's cameras. They are created at the first use and kept.
  struct Eyes {
    std::once_flag made;
    std::vector<PersonSearch> searches;
  };
  [[nodiscard]] const PersonSearch& search_of(const LabelAnchor& image) const;
  [[nodiscard]] ImagePyramid read(const LabelAnchor& image) const;
  [[nodiscard]] std::optional<std::size_t> frame_of(const LabelAnchor& image) const;

  const Map* map_;
  const std::vector<std::optional<Drive>>* drives_;
  PersonLearnerOptions options_;
  std::vector<LabelAnchor> all_;
  std::vector<std::unique_ptr<Eyes>> eyes_;  ///< one per session
};

/// Returns the index of the frame with that stamp.
[[nodiscard]] std::optional<std::size_t> frame_at(const Drive& drive, std::int64_t t_ns);

}  // namespace roadbook
