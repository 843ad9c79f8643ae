#pragma once

#include <cstddef>
#include <vector>

#include "base/random.hpp"
#include "semantics/detector/gp_classifier.hpp"
#include "semantics/people/person_window.hpp"

namespace roadbook {

// Searches a camera's image for people. Only windows where a person of plausible height on ground
// in range can appear are searched: over azimuth, size and slope of the feet.

struct PersonSearchOptions {
  double min_range_m = 1.5;  ///< horizontal, from the camera
  double max_range_m = 10.0;
  double min_height_m = 1.4;  ///< of people
  double max_height_m = 2.0;
  double tilt_rad = 0.03;      ///< largest slope of the ground against the vehicle's plane
  double size_step = 1.12;     ///< ratio of successive sizes
  double min_seen = 0.85;      ///< smallest share of the window inside the camera's view
  std::size_t hypotheses = 6;  ///< largest number per image, best first
  double max_overlap = 0.3;    ///< largest intersection over union of two hypotheses

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

  /// Best boxes by the latent mean, after non-maximum suppression, best first.
  [[nodiscard]] std::vector<PersonHypothesis> run(const ImagePyramid& image,
                                                  const GpClassifier& classifier) const;
  /// A random window of the search, uniform over sizes, then positions; empty if no window is
  /// usable.
  [[nodiscard]] std::optional<PersonBox> random_box(Random& random) const;
  /// True if the window is inside the searched range of sizes and foot slopes, with some tolerance.
  [[nodiscard]] bool reaches(const PersonBox& box) const;

 private:
  // Part of the cylinder searched at one size, on a grid of HOG cells.
  struct Strip {
    double size = 0.0;
    CylinderPatch patch;
    cv::Mat map_a;  ///< fixed-point remap table for the pyramid's octave
    cv::Mat map_b;
    int octave = 0;
    cv::Size windows;                  ///< columns and rows of the grid of windows
    std::vector<std::uint8_t> usable;  ///< for each window: 1 if the camera sees enough of it
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
  bool sees_ground_ = false;  ///< at least one window is usable
};

}  // namespace roadbook
