#include "drive/checks/gyro_check.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

#include "drive/table_faults.hpp"

namespace roadbook {
namespace {

constexpr std::int64_t kPoint_ns = 100'000'000;
constexpr std::int64_t kPiece_ns = 1'000'000'000;
constexpr std::int64_t kGap_ns = 300'000'000;

double way_at(const std::vector<WheelTrace::Point>& points, std::int64_t t_ns) {
  const auto after = std::lower_bound(points.begin(), points.end(), t_ns,
                                      [](const auto& p, std::int64_t t) { return p.t_ns < t; });
  if (after == points.begin()) return after->way_m;
  const auto before = after - 1;
  const double share =
      static_cast<double>(t_ns - before->t_ns) / static_cast<double>(after->t_ns - before->t_ns);
  return before->way_m + share * (after->way_m - before->way_m);
}

}  // namespace

void WheelTrace::add(std::int64_t t_ns, const WheelReading& reading, const WheelModel& model) {
  if (before_) {
    const Eigen::Vector2d moved =
        wheel_increment(reading.left_angle_rad - before_->left_angle_rad,
                        reading.right_angle_rad - before_->right_angle_rad, model.radius_left_m,
                        model.radius_right_m, model.track_width_m);
    way_m_ += std::abs(moved.x());
    heading_rad_ += moved.y();
  }
  before_ = reading;
  if (points_.empty() || t_ns - points_.back().t_ns >= kPoint_ns)
    points_.push_back({t_ns, way_m_, heading_rad_});
}

double WheelTrace::way_m(std::int64_t first_ns, std::int64_t last_ns) const {
  if (points_.empty() || first_ns < points_.front().t_ns || last_ns > points_.back().t_ns)
    return -1.0;
  return way_at(points_, last_ns) - way_at(points_, first_ns);
}

void GyroCheck::add(std::int64_t t_ns, double rate_rad_s) {
  const auto& points = wheels_.points();
  const auto last_ns = std::exchange(before_ns_, t_ns);
  const double last_rad_s = std::exchange(before_rad_s_, rate_rad_s);
  if (last_ns) {
    turned_rad_ += 0.5 * (last_rad_s + rate_rad_s) * 1e-9 * static_cast<double>(t_ns - *last_ns);
    covered_ = covered_ && t_ns - *last_ns <= kGap_ns;
  }
  for (; next_ < points.size() && points[next_].t_ns <= t_ns; ++next_) {
    const std::int64_t piece_ns = points[next_].t_ns - points[begin_].t_ns;
    if (covered_ && piece_ns < kPiece_ns) continue;
    if (covered_ && piece_ns <= kPiece_ns + kGap_ns)
      close_piece(points[next_].heading_rad - points[begin_].heading_rad);
    begin_ = next_;
    turned_rad_ = 0.0;
    covered_ = last_ns.has_value();
  }
}

void GyroCheck::close_piece(double by_wheels_rad) {
  if (!std::isfinite(by_wheels_rad) || !std::isfinite(turned_rad_)) return;
  wheels2_ += by_wheels_rad * by_wheels_rad;
  gyro2_ += turned_rad_ * turned_rad_;
  both_ += by_wheels_rad * turned_rad_;
  ++pieces_;
}

void GyroCheck::report(const std::string& file, ProblemList& problems) const {
  constexpr std::size_t kFewest = 20;
  constexpr double kStraight_rad = 0.02;  // a piece: on a straight drive the noise decides
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  if (pieces_ < kFewest || wheels2_ < kStraight_rad * kStraight_rad * static_cast<double>(pieces_))
    return;
  if (!(std::abs(both_) > 0.9 * std::sqrt(wheels2_ * gyro2_))) return;
  const double ratio = both_ / wheels2_;
  if (ratio >= 0.4 && ratio <= 2.5) return;
  const auto near = [&](double factor) { return std::abs(ratio / factor - 1.0) < 0.3; };
  std::string cause;
  if (ratio < 0.0) cause = "the sign, or T_BS?";
  if (near(kDegrees)) cause = "degrees?";
  if (near(1.0 / kDegrees)) cause = "radians divided by 57.3?";
  std::ostringstream got;
  got.precision(3);
  got << "turns " << ratio << " times those of the wheels" << in_brackets(cause);
  problems.warning(file, 0, "w_RS_S_x, _y, _z", got.str(),
                   "rad/s about the axes that T_BS states, as the wheels turn");
}

}  // namespace roadbook
