#include "apps/evaluation/pictures/ground_view_fit.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/core/optim.hpp>

#include "base/error.hpp"
#include "base/median.hpp"

namespace roadbook {
namespace {

// Returns the homography from ground to image. The camera is one unit above the ground and looks
// along y of the ground; z is up. `view`: logarithm of the focal length over the picture's width,
// tilt below the horizon, roll [rad].
Eigen::Matrix3d image_of_ground(const Eigen::Vector3d& view, cv::Size picture) {
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
  K(0, 0) = K(1, 1) = std::exp(view[0]) * picture.width;
  K(0, 2) = 0.5 * picture.width;
  K(1, 2) = 0.5 * picture.height;
  Eigen::Matrix3d level;  // camera that looks along y of the ground
  level << 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0;
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(view[2], Eigen::Vector3d::UnitZ()).toRotationMatrix() *
      Eigen::AngleAxisd(view[1], Eigen::Vector3d::UnitX()).toRotationMatrix() * level;
  Eigen::Matrix3d plane;
  plane << R.col(0), R.col(1), -R.col(2);
  return K * plane;
}

struct Quad {
  OrientedBox box;
  double skew = 0.0;  ///< largest |cosine| of its corners
};

// Empty if a corner is not on the ground in front of the camera.
std::vector<Quad> on_ground(const std::vector<QuadOutline>& outlines, const Eigen::Matrix3d& H) {
  const Eigen::Matrix3d ground_of_image = H.inverse();
  std::vector<Quad> quads;
  for (const QuadOutline& outline : outlines) {
    std::array<Eigen::Vector2d, 4> c;
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Vector3d p = ground_of_image * outline[i].homogeneous();
      const Eigen::Vector2d place = p.hnormalized();
      if (!((H * place.homogeneous()).z() > 1e-3) || !place.allFinite()) return {};
      c[i] = place;
    }
    Eigen::Vector2d along = 0.5 * (c[1] - c[0] + c[2] - c[3]);
    Eigen::Vector2d across = 0.5 * (c[2] - c[1] + c[3] - c[0]);
    if (along.norm() < across.norm()) std::swap(along, across);
    Quad quad;
    quad.box.centre = 0.25 * (c[0] + c[1] + c[2] + c[3]);
    quad.box.heading = std::atan2(along.y(), along.x());
    quad.box.length_m = along.norm();
    quad.box.width_m = across.norm();
    quad.skew = std::abs(along.normalized().dot(across.normalized()));
    quads.push_back(quad);
  }
  return quads;
}

std::vector<double> logs_of_sides(const std::vector<Quad>& quads) {
  std::vector<double> lengths;
  std::vector<double> widths;
  for (const Quad& quad : quads) {
    lengths.push_back(quad.box.length_m);
    widths.push_back(quad.box.width_m);
  }
  const double length = median(lengths);
  const double width = median(widths);
  std::vector<double> logs;
  for (const Quad& quad : quads) {
    logs.push_back(std::abs(std::log(quad.box.length_m / length)));
    logs.push_back(std::abs(std::log(quad.box.width_m / width)));
  }
  return logs;
}

class Unlikeness : public cv::MinProblemSolver::Function {
 public:
  Unlikeness(const std::vector<QuadOutline>& outlines, cv::Size picture)
      : outlines_(outlines), picture_(picture) {}
  [[nodiscard]] int getDims() const override { return 3; }
  double calc(const double* view) const override {
    const Eigen::Vector3d v(view[0], view[1], view[2]);
    constexpr double kImpossible = 1e6;
    if (v[1] < 0.02 || v[1] > 1.5 || std::abs(v[0]) > 2.0) return kImpossible;
    const auto quads = on_ground(outlines_, image_of_ground(v, picture_));
    if (quads.empty()) return kImpossible;
    double sum = 0.0;
    for (const double l : logs_of_sides(quads)) sum += l;
    for (const Quad& quad : quads) sum += quad.skew;
    return sum;
  }

 private:
  const std::vector<QuadOutline>& outlines_;
  cv::Size picture_;
};

}  // namespace

FittedGround fit_ground_view(const std::vector<QuadOutline>& outlines,
                             cv::Size picture,
                             double area_m2) {
  if (outlines.size() < 4) throw InvalidOption("outlines", std::to_string(outlines.size()), ">= 4");
  const auto solver = cv::DownhillSolver::create(
      cv::makePtr<Unlikeness>(outlines, picture), cv::Mat_<double>(1, 3, 0.2),
      cv::TermCriteria(cv::TermCriteria::MAX_ITER + cv::TermCriteria::EPS, 2000, 1e-7));
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (const double tilt : {0.3, 0.6, 0.9}) {
    cv::Mat view = (cv::Mat_<double>(1, 3) << 0.0, tilt, 0.0);
    if (const double cost = solver->minimize(view); cost < least) {
      least = cost;
      best = {view.at<double>(0), view.at<double>(1), view.at<double>(2)};
    }
  }
  Eigen::Matrix3d H = image_of_ground(best, picture);
  std::vector<Quad> quads = on_ground(outlines, H);
  std::vector<double> lengths;
  std::vector<double> widths;
  for (const Quad& quad : quads) {
    lengths.push_back(quad.box.length_m);
    widths.push_back(quad.box.width_m);
  }
  const double height = std::sqrt(area_m2 / (median(lengths) * median(widths)));
  FittedGround fitted;
  fitted.side_spread = median(logs_of_sides(quads));
  H.leftCols<2>() /= height;
  fitted.H_image_ground = H;
  for (Quad& quad : quads) {
    quad.box.centre *= height;
    quad.box.length_m = height * median(lengths);
    quad.box.width_m = height * median(widths);
    fitted.boxes.push_back(quad.box);
  }
  return fitted;
}

}  // namespace roadbook
