#include "semantics/detector/window_search.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "base/random.hpp"
#include "tests/semantics/outlined_boxes.hpp"

namespace roadbook {
namespace {

using test::outlined_boxes;
using test::OutlinedBoxes;

GpClassifier trained(const OutlinedBoxes& lot,
                     const HogWindow& window,
                     int positives,
                     std::uint64_t seed) {
  Random random(seed, "negatives");
  std::vector<Eigen::VectorXd> rows;
  std::vector<int> labels;
  for (int i = 0; i < positives; ++i) {
    rows.push_back(window.feature(lot.image, lot.spaces[static_cast<std::size_t>(i)]));
    labels.push_back(1);
  }
  while (rows.size() < 150) {
    OrientedBox box{{random.uniform(-5.0, 65.0), random.uniform(-5.0, 45.0)},
                    random.uniform(-std::numbers::pi, std::numbers::pi),
                    5.0,
                    2.5};
    bool clear = true;
    for (const auto& other : lot.spaces) clear = clear && intersection_over_union(box, other) < 0.3;
    if (!clear) continue;
    rows.push_back(window.feature(lot.image, box));
    labels.push_back(-1);
  }
  Eigen::MatrixXd X(static_cast<Eigen::Index>(rows.size()), window.feature_size());
  for (std::size_t i = 0; i < rows.size(); ++i) X.row(static_cast<Eigen::Index>(i)) = rows[i];
  return GpClassifier::train(X, labels);
}

TEST(HogWindow, AWindowsFeatureStandsInTheBlocksOfTheWholePicture) {
  const OutlinedBoxes lot = outlined_boxes(20, 1);
  const HogWindow window(5.0, 2.5);
  // A turned image with the pixel size of the window: its blocks are those of the windows on its
  // grid.
  const cv::Size size(40 * HogWindow::kCell, 30 * HogWindow::kCell);
  const Eigen::Vector2d centre(30.0, 20.0);
  const double heading = 0.3;
  const cv::Mat turned = upright_patch(lot.image, centre, heading, window.pixel_m(), size);
  cv::Size grid;
  const Eigen::MatrixXf blocks = window.blocks_of(turned, grid);
  const int column = 11;
  const int row = 7;
  const double u =
      HogWindow::kCell * (column + 0.5 * (window.blocks().width + 1)) - 0.5 * size.width;
  const double v =
      HogWindow::kCell * (row + 0.5 * (window.blocks().height + 1)) - 0.5 * size.height;
  OrientedBox box;
  box.heading = heading;
  box.centre =
      centre + window.pixel_m() * (u * Eigen::Vector2d(std::cos(heading), std::sin(heading)) +
                                   v * Eigen::Vector2d(std::sin(heading), -std::cos(heading)));
  const Eigen::VectorXd feature = window.feature(lot.image, box);
  for (int a = 0; a < window.blocks().width; ++a)
    for (int b = 0; b < window.blocks().height; ++b) {
      const Eigen::VectorXd part = feature.segment<HogWindow::kBlockSize>(
          Eigen::Index{HogWindow::kBlockSize} * (a * window.blocks().height + b));
      const Eigen::VectorXf whole = blocks.col((row + b) * grid.width + column + a);
      // Warping uses fixed-point numbers, so pixels may differ by one grey level.
      EXPECT_LT((part - whole.cast<double>()).norm(), 0.05) << a << ' ' << b;
    }
}

TEST(HogWindow, TurnedWeightsScoreTheBoxSeenFromBehind) {
  const OutlinedBoxes lot = outlined_boxes(20, 2);
  const HogWindow window(5.0, 2.5);
  // OpenCV weighs the pixels of a block by a Gaussian with its centre half a pixel off the middle.
  // The two features are therefore similar, not equal. `turned` is applied to a feature instead of
  // weights, because it is its own inverse.
  for (OrientedBox box : lot.spaces) {
    box.centre += Eigen::Vector2d(1.0, 0.7);  // off the outline, which is its own mirror image
    OrientedBox behind = box;
    behind.heading += std::numbers::pi;
    const Eigen::VectorXd ahead = window.feature(lot.image, box);
    const Eigen::VectorXd seen = window.feature(lot.image, behind);
    const double unturned = (seen - ahead).norm() / seen.norm();
    EXPECT_LT((seen - window.turned(ahead)).norm() / seen.norm(), std::min(0.2, 0.5 * unturned));
    EXPECT_EQ(window.turned(window.turned(ahead)), ahead);
  }
}

TEST(WindowSearch, FindsBoxesOfAnyHeadingFromAFewExamples) {
  const OutlinedBoxes lot = outlined_boxes(40, 4);
  const HogWindow window(5.0, 2.5);
  const GpClassifier classifier = trained(lot, window, 8, 5);
  WindowSearchOptions options;
  options.hypotheses = 40;
  const WindowSearch search(lot.image, window, options);
  const auto found = search.run(classifier);
  std::vector<OrientedBox> boxes;
  for (const auto& hypothesis : found) boxes.push_back(hypothesis.box);
  const auto match = match_boxes(boxes, lot.spaces, 0.6);
  const auto right = std::count_if(match.begin(), match.end(), [](int m) { return m >= 0; });
  EXPECT_GE(right, 38);
  for (std::size_t i = 1; i < found.size(); ++i)
    EXPECT_GE(found[i - 1].prediction.mean, found[i].prediction.mean - 1e-9);
  // Tolerances: places to a twentieth of the box's width, headings to three degrees.
  double place = 0.0;
  for (std::size_t i = 0; i < match.size(); ++i)
    if (match[i] >= 0)
      place += (boxes[i].centre - lot.spaces[static_cast<std::size_t>(match[i])].centre).norm();
  EXPECT_LT(place / static_cast<double>(right), 0.15);
}

// A window that touches the border of the picture has no neighbour on that side.
TEST(WindowSearch, FindsABoxAtEachBorderOfThePicture) {
  const OutlinedBoxes lot = outlined_boxes(40, 4);
  const HogWindow window(5.0, 2.5);
  const GpClassifier classifier = trained(lot, window, 8, 5);
  const double cell_m = HogWindow::kCell * window.pixel_m();
  const Eigen::Vector2d half =
      0.5 * cell_m * Eigen::Vector2d(window.blocks().width + 1, window.blocks().height + 1);
  // Whole cells, so that windows start at every border.
  GroundImage ground;
  ground.resolution_m = window.pixel_m();
  ground.grey = cv::Mat(30 * HogWindow::kCell, 40 * HogWindow::kCell, CV_8U);
  Random random(3, "ground");
  for (int row = 0; row < ground.grey.rows; ++row)
    for (int column = 0; column < ground.grey.cols; ++column)
      ground.grey.at<unsigned char>(row, column) =
          cv::saturate_cast<unsigned char>(95.0 + 12.0 * random.normal());
  ground.seen = cv::Mat(ground.grey.size(), CV_8U, cv::Scalar(255));
  const Eigen::Vector2d size =
      ground.resolution_m * Eigen::Vector2d(ground.grey.cols, ground.grey.rows);
  ground.corner = {0.0, size.y()};
  WindowSearchOptions options;
  options.hypotheses = 3;
  options.orientations = 1;
  options.scales = {1.0};
  options.refine = false;
  for (const Eigen::Vector2d& centre :
       {Eigen::Vector2d(0.5 * size.x(), size.y() - half.y()),
        Eigen::Vector2d(0.5 * size.x(), half.y()), Eigen::Vector2d(half.x(), 0.5 * size.y()),
        Eigen::Vector2d(size.x() - half.x(), 0.5 * size.y())}) {
    GroundImage image = ground;
    image.grey = ground.grey.clone();
    const OrientedBox box{centre, 0.0, 5.0, 2.5};
    test::paint_outline(box, image);
    const auto found = WindowSearch(image, window, options).run(classifier);
    ASSERT_FALSE(found.empty()) << centre.transpose();
    EXPECT_GT(intersection_over_union(found.front().box, box), 0.8) << centre.transpose();
  }
}

TEST(WindowSearch, GivesTheSameHypothesesOnAnyNumberOfThreads) {
  const OutlinedBoxes lot = outlined_boxes(15, 6);
  const HogWindow window(5.0, 2.5);
  const GpClassifier classifier = trained(lot, window, 5, 7);
  std::vector<std::vector<Hypothesis>> found;
  for (const int threads : {1, 2}) {
    WindowSearchOptions options;
    options.orientations = 8;
    options.scales = {1.0};
    options.num_threads = threads;
    found.push_back(WindowSearch(lot.image, window, options).run(classifier));
  }
  ASSERT_EQ(found[0].size(), found[1].size());
  for (std::size_t i = 0; i < found[0].size(); ++i) {
    EXPECT_EQ(found[0][i].box.centre, found[1][i].box.centre);
    EXPECT_EQ(found[0][i].prediction.probability, found[1][i].prediction.probability);
  }
}

TEST(WindowSearch, LeavesGroundThatNobodySawAlone) {
  OutlinedBoxes lot = outlined_boxes(30, 8);
  const HogWindow window(5.0, 2.5);
  const GpClassifier classifier = trained(lot, window, 8, 9);
  lot.image.seen.colRange(400, 800).setTo(0);
  WindowSearchOptions options;
  options.orientations = 12;
  options.scales = {1.0};
  options.refine = false;
  for (const auto& hypothesis : WindowSearch(lot.image, window, options).run(classifier))
    EXPECT_GE(seen_share(lot.image, hypothesis.box), options.min_seen);
}

}  // namespace
}  // namespace roadbook
