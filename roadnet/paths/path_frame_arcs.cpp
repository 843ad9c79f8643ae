#include <algorithm>
#include <cmath>
#include <limits>

#include "roadnet/paths/path_frame.hpp"

// The grid of a PathFrame: which arcs of the path can have a point in their tube.

namespace roadbook {
namespace {

constexpr double kArcTurn = 0.1;  // [rad] where the tube folds: at most one foot of a kind an arc

}  // namespace

std::uint64_t PathFrame::cell_of(double x, double y) const {
  const auto part = [this](double value) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(
        static_cast<std::int64_t>(std::floor(std::clamp(value / cell_m_, -1e9, 1e9)))));
  };
  return part(x) << 32U | part(y);
}

void PathFrame::cut_arcs() {
  const double e_max = tube_.half_width_m();
  const auto& pieces = curve_.pieces();
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const PathPiece& piece = pieces[k];
    double tightest = 0.0;
    for (int i = 0; i <= 8; ++i) {
      const auto d = piece.at(-1.0 + 0.25 * i);
      const double speed2 = d.dx * d.dx + d.dy * d.dy;
      tightest =
          std::max(tightest, std::abs(d.dx * d.ddy - d.dy * d.ddx) / (speed2 * std::sqrt(speed2)));
    }
    // Where the centre of curvature may lie in the tube, arcs turn little; elsewhere the slope has
    // one zero on an arc of any length.
    const double turn = tightest * piece.length_m;
    const double by_turn = tightest * e_max > 0.5 ? turn / kArcTurn : 1.0;
    const double by_length = piece.length_m / std::max(e_max, 0.5);
    const int count = static_cast<int>(std::ceil(std::max({1.0, by_turn, by_length})));
    for (int i = 0; i < count; ++i) {
      const double a = -1.0 + 2.0 * i / count;
      const double b = i + 1 == count ? 1.0 : -1.0 + 2.0 * (i + 1) / count;
      // Arcs share the values at their joint: rounding must not let a foot slip between them.
      arcs_.push_back({k, a, b, arcs_.empty() ? piece.at(a) : arcs_.back().end, piece.at(b)});
    }
  }
  if (curve_.closed()) arcs_.front().begin = arcs_.back().end;
}

void PathFrame::register_arcs() {
  const double e_max = tube_.half_width_m();
  cell_m_ = std::max(e_max, 0.5);
  for (std::size_t i = 0; i < arcs_.size(); ++i) {
    const Arc& arc = arcs_[i];
    const PathPiece& piece = curve_.pieces()[arc.piece];
    // The arc lies in a ball about its middle, its tube e_max farther out.
    const double middle_v = 0.5 * (arc.v_begin + arc.v_end);
    const auto middle = piece.at(middle_v);
    const double middle_s = piece.arc_at(middle_v);
    const double reach =
        std::max(piece.arc_at(arc.v_end) - middle_s, middle_s - piece.arc_at(arc.v_begin)) + e_max +
        1e-6;
    const auto low = [this](double v) { return static_cast<int>(std::floor(v / cell_m_)); };
    for (int x = low(middle.x - reach); x <= low(middle.x + reach); ++x)
      for (int y = low(middle.y - reach); y <= low(middle.y + reach); ++y)
        cells_[cell_of((x + 0.5) * cell_m_, (y + 0.5) * cell_m_)].push_back(static_cast<int>(i));
  }
}

ProjectionStatus PathFrame::why_outside(const Eigen::Vector2d& p) const {
  if (curve_.closed()) return ProjectionStatus::kOutsideTube;
  const auto distance2 = [&p](const PathPiece::Derivatives& d) {
    return (d.x - p.x()) * (d.x - p.x()) + (d.y - p.y()) * (d.y - p.y());
  };
  const auto ahead = [&p](const PathPiece::Derivatives& d) {
    return (p.x() - d.x) * d.dx + (p.y() - d.y) * d.dy;
  };
  const auto& start = arcs_.front().begin;
  const auto& end = arcs_.back().end;
  double nearest2 = std::numeric_limits<double>::max();
  for (std::size_t i = 1; i < arcs_.size(); ++i)
    nearest2 = std::min(nearest2, distance2(arcs_[i].begin));
  if (ahead(start) < 0.0 && distance2(start) <= std::min(nearest2, distance2(end)))
    return ProjectionStatus::kBeforeStart;
  if (ahead(end) > 0.0 && distance2(end) <= nearest2) return ProjectionStatus::kBeyondEnd;
  return ProjectionStatus::kOutsideTube;
}

}  // namespace roadbook
