#include "apps/evaluation/occupancy/occupancy_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "apps/report/chart.hpp"
#include "base/error.hpp"

namespace roadbook {
namespace {

constexpr int kPanel_px = 620;
constexpr int kTitle_px = 30;

// The part of a grid that readings reached, enlarged to a panel with a title.
cv::Mat panel_of(const NamedGrid& named) {
  const OccupancyGrid& grid = named.grid.grid;
  cv::Mat cells(grid.shape.rows, grid.shape.columns, CV_8UC3, cv::Scalar(214, 190, 160));
  int low_c = grid.shape.columns, high_c = -1, low_r = grid.shape.rows, high_r = -1;
  for (int r = 0; r < grid.shape.rows; ++r)
    for (int c = 0; c < grid.shape.columns; ++c) {
      const std::size_t i = grid.shape.index(c, r);
      if (grid.seen[i] == 0) continue;
      const double p = grid.probability(i, named.grid.prior_log_odds);
      const auto grey = static_cast<std::uint8_t>(std::lround(255.0 * (1.0 - p)));
      const int row = grid.shape.rows - 1 - r;
      cells.at<cv::Vec3b>(row, c) = {grey, grey, grey};
      low_c = std::min(low_c, c);
      high_c = std::max(high_c, c);
      low_r = std::min(low_r, row);
      high_r = std::max(high_r, row);
    }
  cv::Mat panel(kPanel_px + kTitle_px, kPanel_px, CV_8UC3, cv::Scalar(255, 255, 255));
  if (high_c < 0) return panel;
  const cv::Mat seen = cells(cv::Range(low_r, high_r + 1), cv::Range(low_c, high_c + 1));
  const double scale = static_cast<double>(kPanel_px - 10) / std::max(seen.rows, seen.cols);
  cv::Mat large;
  cv::resize(seen, large, {}, scale, scale, scale > 1.0 ? cv::INTER_NEAREST : cv::INTER_AREA);
  large.copyTo(panel(cv::Rect(5, kTitle_px, large.cols, large.rows)));
  cv::putText(panel, named.name, {8, 21}, cv::FONT_HERSHEY_SIMPLEX, 0.6, cv::Scalar(30, 30, 30), 1,
              cv::LINE_AA);
  return panel;
}

}  // namespace

void write_grid_pictures(const std::filesystem::path& file,
                         const std::vector<NamedGrid>& grids,
                         int columns) {
  std::vector<cv::Mat> panels;
  int height = 0;
  for (const NamedGrid& grid : grids) {
    panels.push_back(panel_of(grid));
    cv::Mat used;
    cv::Mat grey;
    cv::cvtColor(panels.back(), grey, cv::COLOR_BGR2GRAY);
    cv::findNonZero(grey < 255, used);
    height = std::max(height, used.empty() ? 0 : cv::boundingRect(used).br().y + 8);
  }
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  cv::Mat page(rows * height, columns * kPanel_px, CV_8UC3, cv::Scalar(255, 255, 255));
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const int row = static_cast<int>(i) / columns, column = static_cast<int>(i) % columns;
    const int used = std::min(height, panels[i].rows);
    panels[i].rowRange(0, used).copyTo(
        page(cv::Rect(column * kPanel_px, row * height, kPanel_px, used)));
  }
  if (!cv::imwrite(file.string(), page))
    throw StorageError("error: " + file.string() +
                       ": picture: got no file, want a disk that takes it");
}

std::string calibration_chart(const std::vector<std::pair<std::string, OccupancyTruth>>& scores) {
  std::vector<ChartSeries> series;
  ChartSeries ideal;
  ideal.name = "calibrated";
  ideal.points = {{0.0, 0.0}, {1.0, 1.0}};
  ideal.dashed = true;
  series.push_back(ideal);
  for (const auto& [name, score] : scores) {
    ChartSeries one;
    one.name = name;
    constexpr std::size_t kFewest = 20;  // cells of an interval that is drawn
    for (std::size_t k = 0; k < score.count.size(); ++k)
      if (score.count[k] >= kFewest)
        one.points.emplace_back(score.mean_probability[k], score.true_share[k]);
    series.push_back(std::move(one));
  }
  return chart_svg({.title = "Calibration of cells",
                    .x_name = "mean probability that a cell is occupied",
                    .y_name = "true share of occupied cells",
                    .y_max = 1.0},
                   series);
}

}  // namespace roadbook
