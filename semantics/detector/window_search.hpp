#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "semantics/detector/gp_classifier.hpp"
#include "semantics/detector/hog_window.hpp"

namespace roadbook {

// Search of a whole picture of the ground for boxes that a classifier takes for positives (document
// 004, V-A.2): over place, orientation and scale, relative to the mean size of the positives.
//
// Blocks of gradients are computed once for each orientation and scale and kept, so that another
// classifier over the same windows is a product of matrices. Half a turn needs no blocks of its
// own.

struct WindowSearchOptions {
  int orientations = 24;                      ///< over half a turn
  std::vector<double> scales{0.9, 1.0, 1.1};  ///< of the typical box
  std::size_t hypotheses = 400;               ///< at most, best first
  double max_overlap = 0.15;                  ///< of two hypotheses: intersection over union
  double min_seen = 0.6;                      ///< share of the box that was seen
  bool refine = true;                         ///< to below a cell and a step of orientation
  int num_threads = 0;                        ///< 0: all cores; the result is the same for any

  /// Throws InvalidOption.
  void check() const;
};

struct Hypothesis {
  OrientedBox box;
  GpPrediction prediction;
};

class WindowSearch {
 public:
  /// `image` must outlive the search; its pixels should be about those of the window
  /// (`HogWindow::pixel_m`, see `coarser`).
  WindowSearch(const GroundImage& image,
               const HogWindow& window,
               const WindowSearchOptions& options);

  /// Best boxes by the mean of f, none overlapping, best first.
  [[nodiscard]] std::vector<Hypothesis> run(const GpClassifier& classifier) const;

 private:
  // Rows of windows of a view, as far as they and their neighbours lie on seen ground: a picture
  // that is turned has corners without any.
  struct Band {
    cv::Rect windows;  ///< by their first blocks
    cv::Size grid;     ///< of `blocks`: the windows' and what reaches beyond them
    Eigen::MatrixXf blocks;
  };
  struct View {
    double heading = 0.0;  ///< of the picture's columns in the map
    double pixel_m = 0.0;
    double scale = 1.0;
    cv::Size size;  ///< of the turned picture [px]
    cv::Size grid;  ///< of its blocks
    std::vector<Band> bands;
    std::vector<std::uint8_t> seen;  ///< of each window, by its first block
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
