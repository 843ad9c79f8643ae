#include "semantics/detector/window_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "semantics/detector/hog_scan.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kPeaks =
    20;  // windows kept for each hypothesis asked for, before suppression
constexpr std::size_t kFewestPeaks = 500;

// The middle of the image.
Eigen::Vector2d middle_of(const GroundImage& image) {
  return image.corner +
         0.5 * image.resolution_m * Eigen::Vector2d(image.grey.cols, -image.grey.rows);
}

Eigen::Vector2d direction(double heading) { return {std::cos(heading), std::sin(heading)}; }

template <typename T>
void keep_best(std::vector<T>& items, std::size_t count) {
  const auto better = [](const T& a, const T& b) { return a.score > b.score; };
  std::stable_sort(items.begin(), items.end(), better);
  if (items.size() > count) items.resize(count);
}

// For each row, the range of windows from the neighbour before the first seen window to the
// neighbour after the last one.
std::vector<cv::Range> rows_to_score(const std::vector<std::uint8_t>& seen,
                                     int stride,
                                     cv::Size windows) {
  std::vector<cv::Range> own(static_cast<std::size_t>(std::max(0, windows.height)), {0, 0});
  for (int row = 0; row < windows.height; ++row) {
    const auto begin = seen.begin() + row * stride;
    const auto end = begin + windows.width;
    const auto first = std::find(begin, end, 1);
    if (first == end) continue;
    const auto last =
        std::find(std::make_reverse_iterator(end), std::make_reverse_iterator(begin), 1).base();
    own[static_cast<std::size_t>(row)] = {
        std::max(0, static_cast<int>(first - begin) - 1),
        std::min(windows.width, static_cast<int>(last - begin) + 1)};
  }
  return own;
}

cv::Range joined(const cv::Range& a, const cv::Range& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.start, b.start), std::max(a.end, b.end)};
}

// Windows of a view that are seen, and their neighbours, as rectangles of several rows. `stride`:
// offset from one row of `seen` to the next.
std::vector<cv::Rect> bands_of(const std::vector<std::uint8_t>& seen,
                               int stride,
                               cv::Size windows) {
  constexpr int kRows = 16;  // more: less is left out; fewer: more is computed twice
  const std::vector<cv::Range> own = rows_to_score(seen, stride, windows);
  const auto range_of = [&](int row) {
    const bool any = row >= 0 && row < windows.height;
    return any ? own[static_cast<std::size_t>(row)] : cv::Range(0, 0);
  };
  std::vector<cv::Rect> bands;
  for (int first = 0; first < windows.height; first += kRows) {
    const int rows = std::min(kRows, windows.height - first);
    cv::Range columns(0, 0);
    for (int row = first - 1; row <= first + rows; ++row) columns = joined(columns, range_of(row));
    if (!columns.empty()) bands.push_back({columns.start, first, columns.size(), rows});
  }
  return bands;
}

}  // namespace

void WindowSearchOptions::check() const {
  if (orientations < 1 || orientations > 360)
    throw InvalidOption("orientations", std::to_string(orientations), "1 to 360");
  if (scales.empty()) throw InvalidOption("scales", "none", "at least one");
  for (const double scale : scales)
    if (!(scale > 0.1 && scale < 10.0))
      throw InvalidOption("scales", std::to_string(scale), "0.1 to 10");
  if (hypotheses < 1) throw InvalidOption("hypotheses", "0", ">= 1");
}

WindowSearch::WindowSearch(const GroundImage& image,
                           const HogWindow& window,
                           const WindowSearchOptions& options)
    : image_(image), window_(window), options_(options) {
  options_.check();
  const std::size_t scales = options_.scales.size();
  views_.resize(static_cast<std::size_t>(options_.orientations) * scales);
  parallel_for(views_.size(), options_.num_threads, [&](std::size_t i) {
    const double turn = static_cast<double>(i / scales) / options_.orientations;
    views_[i] = make_view(std::numbers::pi * turn, options_.scales[i % scales]);
  });
}

WindowSearch::View WindowSearch::make_view(double heading, double scale) const {
  View view;
  view.heading = heading;
  view.scale = scale;
  view.pixel_m = window_.pixel_m() * scale;
  const double width_m = image_.grey.cols * image_.resolution_m;
  const double height_m = image_.grey.rows * image_.resolution_m;
  const double c = std::abs(std::cos(heading));
  const double s = std::abs(std::sin(heading));
  constexpr int kCell = HogWindow::kCell;
  const auto whole_cells = [&](double metres) {
    return kCell * std::max(1, static_cast<int>(std::ceil(metres / (view.pixel_m * kCell))));
  };
  view.size = {whole_cells(c * width_m + s * height_m), whole_cells(s * width_m + c * height_m)};
  const cv::Mat turned = upright_patch(image_, middle_of(image_), heading, view.pixel_m, view.size);
  view.grid = {view.size.width / kCell - 1, view.size.height / kCell - 1};
  view.seen.assign(static_cast<std::size_t>(view.grid.area()), 0);
  for (int row = 0; row + window_.blocks().height <= view.grid.height; ++row)
    for (int column = 0; column + window_.blocks().width <= view.grid.width; ++column)
      view.seen[static_cast<std::size_t>(row * view.grid.width + column)] =
          seen_share(image_, box_at(view, column, row, 0.0)) >= options_.min_seen ? 1 : 0;
  const cv::Size windows(view.grid.width - window_.blocks().width + 1,
                         view.grid.height - window_.blocks().height + 1);
  if (windows.width < 1 || windows.height < 1) return view;
  for (const cv::Rect& band : bands_of(view.seen, view.grid.width, windows))
    view.bands.push_back(make_band(turned, view.grid, band));
  return view;
}

WindowSearch::Band WindowSearch::make_band(const cv::Mat& turned,
                                           cv::Size grid,
                                           cv::Rect windows) const {
  constexpr int kCell = HogWindow::kCell;
  Band band{
      windows,
      {windows.width + window_.blocks().width - 1, windows.height + window_.blocks().height - 1},
      {}};
  // One block more on each side: gradients at the border of the cut-out differ from those of the
  // picture.
  const cv::Rect wide =
      cv::Rect(windows.x - 1, windows.y - 1, band.grid.width + 2, band.grid.height + 2) &
      cv::Rect(0, 0, grid.width, grid.height);
  cv::Size size;
  const Eigen::MatrixXf blocks = window_.blocks_of(
      turned({kCell * wide.x, kCell * wide.y, kCell * (wide.width + 1), kCell * (wide.height + 1)}),
      size);
  ROADBOOK_ASSERT(size == wide.size());
  band.blocks.resize(HogWindow::kBlockSize, band.grid.area());
  for (int row = 0; row < band.grid.height; ++row)
    band.blocks.middleCols(row * band.grid.width, band.grid.width) = blocks.middleCols(
        (row + windows.y - wide.y) * wide.width + windows.x - wide.x, band.grid.width);
  return band;
}

OrientedBox WindowSearch::box_at(const View& view, int column, int row, double half_turn) const {
  constexpr int kCell = HogWindow::kCell;
  // Middle of the window, relative to the middle of the turned picture [px].
  const double u = kCell * (column + 0.5 * (window_.blocks().width + 1)) - 0.5 * view.size.width;
  const double v = kCell * (row + 0.5 * (window_.blocks().height + 1)) - 0.5 * view.size.height;
  const Eigen::Vector2d along = direction(view.heading);
  OrientedBox box;
  box.centre =
      middle_of(image_) + view.pixel_m * (u * along + v * Eigen::Vector2d(along.y(), -along.x()));
  box.heading = view.heading + half_turn;
  box.length_m = view.scale * window_.length_m();
  box.width_m = view.scale * window_.width_m();
  return box;
}

// Windows that score above 0 and no worse than their neighbours.
void WindowSearch::score_view(const View& view,
                              const Eigen::MatrixXf& weights,
                              double bias,
                              double half_turn,
                              std::vector<Scored>& found) const {
  // Windows outside all bands have no seen neighbour, so their score does not matter.
  WindowScores score =
      WindowScores::Constant(std::max(0, view.grid.height - window_.blocks().height + 1),
                             std::max(0, view.grid.width - window_.blocks().width + 1), 0.0F);
  for (const Band& band : view.bands)
    score.block(band.windows.y, band.windows.x, band.windows.height, band.windows.width) =
        scan_windows(weights, bias, window_.blocks(), band.blocks, band.grid);
  const auto rows = static_cast<int>(score.rows());
  const auto columns = static_cast<int>(score.cols());
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      if (view.seen[static_cast<std::size_t>(row * view.grid.width + column)] == 0) continue;
      const float own = score(row, column);
      const bool top = (row == 0 || score(row - 1, column) <= own) &&
                       (row + 1 == rows || score(row + 1, column) <= own) &&
                       (column == 0 || score(row, column - 1) <= own) &&
                       (column + 1 == columns || score(row, column + 1) <= own);
      if (top) found.push_back({box_at(view, column, row, half_turn), static_cast<double>(own)});
    }
}

// Climbs in place, orientation and size with steps that halve.
WindowSearch::Scored WindowSearch::refined(const GpClassifier& classifier, Scored start) const {
  const auto score = [&](const OrientedBox& box) {
    return classifier.weights().dot(window_.feature(image_, box)) + classifier.bias();
  };
  start.score = score(start.box);
  double step_m = 0.5 * HogWindow::kCell * window_.pixel_m();
  double step_rad = 0.5 * std::numbers::pi / options_.orientations;
  double step_scale = 0.05;
  for (int round = 0; round < 3; ++round) {
    for (const auto& [along, across, turn, grow] :
         {std::array{1.0, 0.0, 0.0, 0.0}, std::array{0.0, 1.0, 0.0, 0.0},
          std::array{0.0, 0.0, 1.0, 0.0}, std::array{0.0, 0.0, 0.0, 1.0}})
      for (const double sign : {1.0, -1.0}) {
        OrientedBox box = start.box;
        const Eigen::Vector2d ahead = direction(box.heading);
        box.centre +=
            sign * step_m * (along * ahead + across * Eigen::Vector2d(-ahead.y(), ahead.x()));
        box.heading += sign * step_rad * turn;
        const double factor = 1.0 + sign * step_scale * grow;
        box.length_m *= factor;
        box.width_m *= factor;
        const double size = box.length_m / window_.length_m();
        if (size < 0.95 * options_.scales.front() || size > 1.05 * options_.scales.back()) continue;
        if (const double s = score(box); s > start.score) {
          start = {box, s};
          break;
        }
      }
    step_m *= 0.5;
    step_rad *= 0.5;
    step_scale *= 0.5;
  }
  return start;
}

std::vector<Hypothesis> WindowSearch::run(const GpClassifier& classifier) const {
  ROADBOOK_ASSERT(classifier.feature_size() == window_.feature_size());
  const Eigen::MatrixXf ahead = block_weights(classifier.weights());
  const Eigen::MatrixXf behind = block_weights(window_.turned(classifier.weights()));
  const std::size_t peaks = std::max(kFewestPeaks, kPeaks * options_.hypotheses);
  std::vector<std::vector<Scored>> by_view(views_.size());
  parallel_for(views_.size(), options_.num_threads, [&](std::size_t i) {
    score_view(views_[i], ahead, classifier.bias(), 0.0, by_view[i]);
    score_view(views_[i], behind, classifier.bias(), std::numbers::pi, by_view[i]);
    keep_best(by_view[i], peaks);
  });
  std::vector<Scored> found;
  for (auto& some : by_view) found.insert(found.end(), some.begin(), some.end());
  keep_best(found, peaks);

  const auto suppress = [&](double max_overlap, std::size_t most) {
    std::vector<OrientedBox> boxes;
    std::vector<double> scores;
    for (const Scored& f : found) {
      boxes.push_back(f.box);
      scores.push_back(f.score);
    }
    std::vector<Scored> kept;
    for (const std::size_t i : non_maximum_suppression(boxes, scores, max_overlap, most))
      kept.push_back(found[i]);
    found = std::move(kept);
  };
  // Boxes that overlap a little may separate during refinement.
  suppress(std::max(0.3, options_.max_overlap), 2 * options_.hypotheses);
  if (options_.refine)
    parallel_for(found.size(), options_.num_threads,
                 [&](std::size_t i) { found[i] = refined(classifier, found[i]); });
  suppress(options_.max_overlap, options_.hypotheses);
  std::vector<Hypothesis> hypotheses(found.size());
  parallel_for(found.size(), options_.num_threads, [&](std::size_t i) {
    hypotheses[i] = {found[i].box, classifier.predict(window_.feature(image_, found[i].box))};
  });
  return hypotheses;
}

}  // namespace roadbook
