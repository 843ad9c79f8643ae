#pragma once

#include <cstddef>
#include <vector>

#include "base/random.hpp"
#include "semantics/detector/gp_classifier.hpp"
#include "semantics/people/person_window.hpp"

namespace roadbook {

// Search of a camera's image for people: only where somebody of a person's height who stands on
// ground in range would appear, over azimuth, size and the place of the feet.

struct PersonSearchOptions {
  double min_range_m = 1.5;  ///< from the camera, over the ground
  double max_range_m = 10.0;
  double min_height_m = 1.4;  ///< of a person
  double max_height_m = 2.0;
  double tilt_rad = 0.03;      ///< of the ground against the vehicle's, either way
  double size_step = 1.12;     ///< from one size to the next
  double min_seen = 0.85;      ///< share of the window that the camera sees
  std::size_t hypotheses = 6;  ///< of an image at most, best first
  double max_overlap = 0.3;    ///< of two hypotheses: intersection over union

  /// Throws InvalidOption.
  void check() const;
};

struct PersonHypothesis {
  PersonBox box;
  GpPrediction prediction;
};

class PersonSearch {
 public:
  PersonSearch(int index, const PersonCamera& camera, const PersonSearchOptions& options);

  [[nodiscard]] const PersonCamera& camera() const { return camera_; }

  /// Best boxes by the mean of f, none overlapping, best first.
  [[nodiscard]] std::vector<PersonHypothesis> run(const ImagePyramid& image,
                                                  const GpClassifier& classifier) const;
  /// Some window of the search, each size and place as likely; empty where the camera sees none.
  [[nodiscard]] std::optional<PersonBox> random_box(Random& random) const;
  /// Whether the window lies where the search looks, near enough in size and place.
  [[nodiscard]] bool reaches(const PersonBox& box) const;

 private:
  // A strip of the cylinder at one size: windows stand on its grid of cells.
  struct Strip {
    double size = 0.0;
    CylinderPatch patch;
    cv::Mat map_a;  ///< fixed point, of the pyramid's octave
    cv::Mat map_b;
    int octave = 0;
    cv::Size windows;                  ///< columns, rows of the grid
    std::vector<std::uint8_t> usable;  ///< of each window
  };
  struct Scored {
    PersonBox box;
    double score = 0.0;
  };
  [[nodiscard]] Strip make_strip(double size) const;
  [[nodiscard]] PersonBox box_at(const Strip& strip, int column, int row) const;
  [[nodiscard]] Scored refined(const ImagePyramid& image,
                               const GpClassifier& classifier,
                               Scored start) const;
  [[nodiscard]] double least_foot_slope(double size) const;
  [[nodiscard]] double greatest_foot_slope(double size) const;

  int index_;
  PersonCamera camera_;
  PersonSearchOptions options_;
  PersonWindow window_;
  std::vector<Strip> strips_;
  bool sees_ground_ = false;  ///< any window is usable
};

}  // namespace roadbook
