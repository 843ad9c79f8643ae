#include <cpl_minixml.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "apps/evaluation/pictures/annotated_car_parks.hpp"
#include "apps/evaluation/pictures/xml_file.hpp"
#include "base/error.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// Size of the annotated frames.
constexpr int kMarkedWidth = 192;
constexpr int kHeight = 600;
constexpr double kMouthM = 2.4;
constexpr double kInM = 1.2;
constexpr double kOutM = 0.8;
// Two points belong to one mouth if their distance is in this range [share of the usual distance].
constexpr double kNarrowest = 0.75;
constexpr double kWidestMouth = 1.4;
constexpr double kSamePointPx = 25.0;

/// One side of the car in one car park.
struct Side {
  std::string park;
  bool left = false;
  std::vector<std::pair<fs::path, fs::path>> frames;  ///< image, points
};

struct MarkedFrame {
  cv::Mat grey;
  bool left = false;
  std::vector<Eigen::Vector2d> points;  ///< from the front to the back [px]
};

std::vector<Eigen::Vector2d> read_points(const fs::path& file) {
  const XmlFile xml(file);
  std::vector<Eigen::Vector2d> points;
  for (const CPLXMLNode* object : xml.children("annotation", "object")) {
    if (std::string(CPLGetXMLValue(object, "deleted", "0")) == "1") continue;
    const Eigen::Vector2d p(xml.number(object, "polygon.pt.x"), xml.number(object, "polygon.pt.y"));
    const bool twice = std::any_of(points.begin(), points.end(), [&](const Eigen::Vector2d& q) {
      return (p - q).norm() < kSamePointPx;
    });
    if (!twice) points.push_back(p);
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const auto& a, const auto& b) { return a.y() < b.y(); });
  return points;
}

// Finds the folders NAME_L_xml and NAME_R_xml. The pictures are next to them, in NAME_L or
// NAME_L_images.
std::vector<Side> find_sides(const fs::path& folder, int frames) {
  std::vector<fs::path> folders;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_directory()) folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  std::vector<Side> sides;
  for (const fs::path& xml : folders) {
    const std::string name = xml.filename().string();
    const std::string end = name.size() > 6 ? name.substr(name.size() - 6) : "";
    if (end != "_L_xml" && end != "_R_xml") continue;
    const std::string stem = name.substr(0, name.size() - 4);
    fs::path images = xml.parent_path() / stem;
    if (!fs::is_directory(images)) images += "_images";
    std::vector<std::pair<fs::path, fs::path>> all;
    for (const auto& entry : fs::directory_iterator(xml)) {
      const fs::path image = images / (entry.path().stem().string() + ".jpg");
      if (entry.path().extension() == ".xml" && fs::exists(image))
        all.emplace_back(image, entry.path());
    }
    std::sort(all.begin(), all.end());
    Side side{stem.substr(0, stem.size() - 2), end == "_L_xml", {}};
    const auto count = static_cast<std::size_t>(frames);
    for (std::size_t i = 0; i < std::min(count, all.size()); ++i)
      side.frames.push_back(all[i * all.size() / std::min(count, all.size())]);
    if (side.frames.size() >= 2) sides.push_back(side);
  }
  return sides;
}

std::vector<MarkedFrame> read_frames(const Side& side) {
  std::vector<MarkedFrame> frames;
  for (const auto& [image, points] : side.frames) {
    MarkedFrame frame;
    frame.grey = cv::imread(image.string(), cv::IMREAD_GRAYSCALE);
    if (frame.grey.empty())
      throw BadInput(Problem{Severity::kError, image.string(), 0, "", "no picture", "a JPEG file"});
    cv::resize(frame.grey, frame.grey, {kMarkedWidth / 2, kHeight / 2}, 0, 0, cv::INTER_AREA);
    frame.left = side.left;
    frame.points = read_points(points);
    frames.push_back(frame);
  }
  return frames;
}

// Returns the pixels that are brighter than black in at least one frame.
cv::Mat seen_in(const std::vector<MarkedFrame>& frames) {
  cv::Mat brightest = frames.front().grey.clone();
  for (const MarkedFrame& frame : frames) cv::max(brightest, frame.grey, brightest);
  constexpr double kBlack = 40.0;  // above the JPEG noise near an edge
  cv::Mat seen = brightest > kBlack;
  return seen;
}

double usual_distance(const std::vector<MarkedFrame>& frames) {
  std::vector<double> distances;
  for (const MarkedFrame& frame : frames)
    for (std::size_t i = 1; i < frame.points.size(); ++i)
      distances.push_back((frame.points[i] - frame.points[i - 1]).norm());
  if (distances.empty()) return 0.0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

// Converts the frame to a picture of the ground with the mouths of its spaces.
AnnotatedCarPark lot_of(const MarkedFrame& frame, const cv::Mat& seen, double usual_px) {
  const double marked_m = kMouthM / usual_px;  // a pixel of the marked frame
  AnnotatedCarPark lot;
  lot.image.grey = frame.grey;
  lot.image.seen = seen;
  lot.image.resolution_m = 2.0 * marked_m;
  for (std::size_t i = 1; i < frame.points.size(); ++i) {
    const auto ground = [&](const Eigen::Vector2d& p) {
      return Eigen::Vector2d(marked_m * p.x(), -marked_m * p.y());
    };
    const Eigen::Vector2d a = ground(frame.points[i - 1]);
    const Eigen::Vector2d across = ground(frame.points[i]) - a;
    if (across.norm() < kNarrowest * kMouthM || across.norm() > kWidestMouth * kMouthM) continue;
    // The direction into the space. On the left of the car, it points to the right of the way from
    // the front point to the rear point. On the right of the car, it points to the left.
    Eigen::Vector2d in = Eigen::Vector2d(across.y(), -across.x()).normalized();
    if (!frame.left) in = -in;
    OrientedBox box;
    box.centre = a + 0.5 * across + 0.5 * (kInM - kOutM) * in;
    box.heading = std::atan2(in.y(), in.x());
    box.length_m = kInM + kOutM;
    box.width_m = across.norm();
    if (seen_share(lot.image, box) >= 0.6) lot.spaces.push_back(box);
  }
  return lot;
}

// Joins frames of both sides of the car, from the first or the second half of the drive.
AnnotatedCarPark half_of_drive(const std::vector<std::vector<MarkedFrame>>& sides,
                               bool second,
                               double usual_px) {
  std::vector<AnnotatedCarPark> pictures;
  for (const auto& frames : sides) {
    const cv::Mat seen = seen_in(frames);
    const std::size_t middle = frames.size() / 2;
    for (std::size_t i = second ? middle : 0; i < (second ? frames.size() : middle); ++i)
      pictures.push_back(lot_of(frames[i], seen, usual_px));
  }
  constexpr int kColumns = 12;
  constexpr double kGapM = 1.0;
  return side_by_side(pictures, kColumns, kGapM);
}

}  // namespace

std::vector<AnnotatedCarPark> psv_annotations(const fs::path& folder, int frames) {
  std::map<std::string, std::vector<Side>> parks;
  for (const Side& side : find_sides(folder, frames)) parks[side.park].push_back(side);
  std::vector<AnnotatedCarPark> lots;
  for (const auto& [park, sides] : parks) {
    std::vector<std::vector<MarkedFrame>> read;
    std::vector<MarkedFrame> all;
    for (const Side& side : sides) {
      read.push_back(read_frames(side));
      all.insert(all.end(), read.back().begin(), read.back().end());
    }
    const double usual_px = usual_distance(all);
    if (usual_px <= 0.0) continue;
    for (const bool second : {false, true}) {
      AnnotatedCarPark lot = half_of_drive(read, second, usual_px);
      lot.name = park + (second ? ", second half" : ", first half");
      if (!lot.spaces.empty()) lots.push_back(lot);
    }
  }
  return lots;
}

}  // namespace roadbook
