#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "semantics/detector/gp_classifier.hpp"
#include "semantics/detector/hog_window.hpp"

namespace roadbook {

// Searches an overhead image for boxes that a classifier rates as positive: over position,
// orientation and scale relative to the mean size of the positives. Source: [metric-semantic maps,
// section V-A.2].
//
// HOG blocks are computed once for each orientation and scale and kept; another classifier for the
// same windows then needs only matrix products. Orientations beyond half a turn reuse the same
// blocks.

struct WindowSearchOptions {
  int orientations = 24;                      ///< over half a turn
  std::vector<double> scales{0.9, 1.0, 1.1};  ///< relative to the typical box
  std::size_t hypotheses = 400;               ///< largest number, best first
  double max_overlap = 0.15;                  ///< largest intersection over union of two hypotheses
  double min_seen = 0.6;                      ///< smallest share of the box that was observed
  bool refine = true;                         ///< refine below the grid of cells and orientations
  int num_threads = 0;                        ///< 0: all cores; the result does not depend on it

  /// Throws InvalidOption.
  void check() const;
};

struct Hypothesis {
  OrientedBox box;
  GpPrediction prediction;
};

class WindowSearch {
 public:
  /// `image` must outlive the search. Its pixel size should be near the window's
  /// (`HogWindow::pixel_m`, see `coarser`).
  WindowSearch(const GroundImage& image,
               const HogWindow& window,
               const WindowSearchOptions& options);

  /// Best boxes by the latent mean, after non-maximum suppression, best first.
  [[nodiscard]] std::vector<Hypothesis> run(const GpClassifier& classifier) const;

 private:
  // Rows of windows of a view, limited to windows on observed ground and their neighbours. The
  // corners of a turned image hold no ground.
  struct Band {
    cv::Rect windows;  ///< range of their first blocks
    cv::Size grid;     ///< size of `blocks`: all blocks of these windows
    Eigen::MatrixXf blocks;
  };
  struct View {
    double heading = 0.0;  ///< map direction of the image's columns [rad]
    double pixel_m = 0.0;
    double scale = 1.0;
    cv::Size size;  ///< of the turned image [px]
    cv::Size grid;  ///< of its blocks
    std::vector<Band> bands;
    std::vector<std::uint8_t> seen;  ///< for each window, by its first block: 1 if observed
  };
  struct Scored {
    OrientedBox box;
    double score = 0.0;
  };
  [[nodiscard]] View make_view(double heading, double scale) const;
  [[nodiscard]] Band make_band(const cv::Mat& turned, cv::Size grid, cv::Rect windows) const;
  void score_view(const View& view,
                  const Eigen::MatrixXf& weights,
                  double bias,
                  double half_turn,
                  std::vector<Scored>& found) const;
  [[nodiscard]] OrientedBox box_at(const View& view, int column, int row, double half_turn) const;
  [[nodiscard]] Scored refined(const GpClassifier& classifier, Scored start) const;

  const GroundImage& image_;
  HogWindow window_;
  WindowSearchOptions options_;
  std::vector<View> views_;
};

}  // namespace roadbook
