#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "apps/evaluation/pictures/annotated_car_parks.hpp"
#include "apps/evaluation/pictures/ground_view_fit.hpp"
#include "apps/evaluation/pictures/xml_file.hpp"
#include "base/error.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

constexpr double kPixelM = 0.05;
constexpr double kAroundM = 8.0;  // ground shown beyond the outermost spaces
constexpr double kSpaceM2 = 5.0 * 2.4;
constexpr double kLeastSeenSpace = 0.6;  // minimum seen share of a space that must be found
constexpr double kCoarsestM = 0.15;      // maximum ground size of a camera pixel

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::vector<fs::path> entries;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder)) entries.push_back(entry.path());
  std::sort(entries.begin(), entries.end());
  return entries;
}

std::vector<QuadOutline> read_outlines(const fs::path& file) {
  const XmlFile xml(file);
  std::vector<QuadOutline> outlines;
  for (const CPLXMLNode* space : xml.children("parking", "space")) {
    const auto points = xml.children(space, "contour", "point");
    if (points.size() != 4)
      throw BadInput(Problem{Severity::kError, file.string(), 0, "space.contour",
                             std::to_string(points.size()) + " points", "4"});
    QuadOutline outline;
    for (std::size_t i = 0; i < 4; ++i)
      outline[i] = {xml.number(points[i], "x"), xml.number(points[i], "y")};
    outlines.push_back(outline);
  }
  return outlines;
}

// Returns the mask of the ground that the camera shows finely enough, in pixels of the rectified
// picture.
cv::Mat seen_ground(const FittedGround& view,
                    const Eigen::Vector2d& corner,
                    cv::Size size,
                    cv::Size picture) {
  cv::Mat seen = cv::Mat::zeros(size, CV_8U);
  const auto pixel = [&](double x, double y) {
    return (view.H_image_ground * Eigen::Vector3d(x, y, 1.0)).eval();
  };
  for (int row = 0; row < size.height; ++row)
    for (int column = 0; column < size.width; ++column) {
      const double x = corner.x() + kPixelM * (column + 0.5);
      const double y = corner.y() - kPixelM * (row + 0.5);
      const Eigen::Vector3d h = pixel(x, y);
      if (h.z() <= 0.0) continue;
      const Eigen::Vector2d p = h.hnormalized();
      if (p.x() < 0.0 || p.y() < 0.0 || p.x() > picture.width - 1 || p.y() > picture.height - 1)
        continue;
      Eigen::Matrix2d J;  // pixels by metres
      J << pixel(x + 0.01, y).hnormalized() - p, pixel(x, y + 0.01).hnormalized() - p;
      const double least = Eigen::JacobiSVD<Eigen::Matrix2d>(J / 0.01).singularValues()[1];
      if (least * kCoarsestM >= 1.0) seen.at<unsigned char>(row, column) = 255;
    }
  return seen;
}

AnnotatedCarPark rectified(const cv::Mat& grey, const FittedGround& view) {
  AnnotatedCarPark lot;
  Eigen::Vector2d low = view.boxes.front().centre;
  Eigen::Vector2d high = low;
  for (const OrientedBox& box : view.boxes) {
    low = low.cwiseMin(box.centre);
    high = high.cwiseMax(box.centre);
  }
  low.array() -= kAroundM;
  high.array() += kAroundM;
  const cv::Size size(static_cast<int>((high.x() - low.x()) / kPixelM),
                      static_cast<int>((high.y() - low.y()) / kPixelM));
  lot.image.corner = {low.x(), high.y()};
  lot.image.resolution_m = kPixelM;
  Eigen::Matrix3d ground_of_pixel;  // of the rectified picture
  ground_of_pixel << kPixelM, 0.0, low.x() + 0.5 * kPixelM, 0.0, -kPixelM, high.y() - 0.5 * kPixelM,
      0.0, 0.0, 1.0;
  const Eigen::Matrix3d H = view.H_image_ground * ground_of_pixel;
  cv::Matx33d map;
  for (int i = 0; i < 9; ++i) map(i / 3, i % 3) = H(i / 3, i % 3);
  cv::warpPerspective(grey, lot.image.grey, map, size, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  lot.image.seen = seen_ground(view, lot.image.corner, size, grey.size());
  lot.spaces = view.boxes;
  return lot;
}

/// A line between two parts of a car park. Points p on its right have `normal` . p > `offset`.
struct Divide {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double offset = 0.0;
};

// Returns a line through the middle of the widest strip that contains no middle of a space. At
// least a third of the spaces lie on each side.
Divide widest_gap(const std::vector<OrientedBox>& spaces) {
  constexpr int kDirections = 36;
  Divide divide;
  double widest = -1.0;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = (static_cast<double>(i) / kDirections - 0.5) * std::numbers::pi;
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    std::vector<double> along;
    for (const OrientedBox& box : spaces) along.push_back(normal.dot(box.centre));
    std::sort(along.begin(), along.end());
    for (std::size_t k = along.size() / 3; k + along.size() / 3 < along.size(); ++k)
      if (k > 0 && along[k] - along[k - 1] > widest) {
        widest = along[k] - along[k - 1];
        divide = {normal, 0.5 * (along[k] + along[k - 1])};
      }
  }
  return divide;
}

void crop_to_seen(GroundImage& image) {
  const cv::Rect seen = cv::boundingRect(image.seen);
  image.grey = image.grey(seen).clone();
  image.seen = image.seen(seen).clone();
  image.corner += image.resolution_m * Eigen::Vector2d(seen.x, -seen.y);
}

AnnotatedCarPark half_of(const AnnotatedCarPark& lot, const Divide& divide, bool right) {
  const auto is_in = [&](const Eigen::Vector2d& p) {
    return (divide.normal.dot(p) > divide.offset) == right;
  };
  AnnotatedCarPark half;
  half.image = lot.image;
  half.image.seen = lot.image.seen.clone();
  for (int row = 0; row < lot.image.seen.rows; ++row)
    for (int column = 0; column < lot.image.seen.cols; ++column)
      if (!is_in(lot.image.corner + kPixelM * Eigen::Vector2d(column + 0.5, -row - 0.5)))
        half.image.seen.at<unsigned char>(row, column) = 0;
  for (const OrientedBox& box : lot.spaces)
    if (is_in(box.centre) && seen_share(half.image, box) >= kLeastSeenSpace)
      half.spaces.push_back(box);
  crop_to_seen(half.image);
  return half;
}

}  // namespace

std::vector<AnnotatedCarPark> pklot_annotations(const fs::path& folder) {
  std::vector<AnnotatedCarPark> lots;
  for (const fs::path& sequence : sorted_entries(folder)) {
    std::vector<AnnotatedCarPark> halves[2];
    for (const fs::path& file : sorted_entries(sequence / "bounding_boxes")) {
      const fs::path frame = sequence / "frames" / (file.stem().string() + ".png");
      const cv::Mat grey = cv::imread(frame.string(), cv::IMREAD_GRAYSCALE);
      if (grey.empty())
        throw BadInput(
            Problem{Severity::kError, frame.string(), 0, "", "no picture", "a PNG file"});
      const FittedGround view = fit_ground_view(read_outlines(file), grey.size(), kSpaceM2);
      const AnnotatedCarPark whole = rectified(grey, view);
      const Divide divide = widest_gap(whole.spaces);
      halves[0].push_back(half_of(whole, divide, false));
      halves[1].push_back(half_of(whole, divide, true));
    }
    for (int i = 0; i < 2; ++i) {
      if (halves[i].empty()) continue;  // no such sequence
      lots.push_back(side_by_side(halves[i], 3, 2.0));
      lots.back().name = sequence.filename().string() + (i == 0 ? ", left" : ", right");
    }
  }
  return lots;
}

}  // namespace roadbook
