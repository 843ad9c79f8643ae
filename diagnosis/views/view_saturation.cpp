#include "diagnosis/views/view_saturation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/median.hpp"
#include "base/parallel.hpp"
#include "diagnosis/numerics/student_noise.hpp"
#include "diagnosis/views/body_motion_correlation.hpp"
#include "diagnosis/views/image_scatter.hpp"
#include "diagnosis/views/landmark_scatter.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kSaturationProbes = 4;
constexpr double kMedianOfSquare = 0.4549;  // median of a squared standard normal variable
constexpr double kLeastRedundancy =
    0.02;  // redundancy below which a channel has no information about its noise

Eigen::MatrixXd sums_of(const std::vector<ViewCause>& causes, std::size_t basis) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(index(basis), index(causes.size()));
  for (std::size_t c = 0; c < causes.size(); ++c)
    for (const std::size_t column : causes[c].columns) sums(index(column), index(c)) = 1.0;
  return sums;
}

// For each camera the sides that hold its effects.
class CameraSides {
 public:
  CameraSides(const std::vector<ViewCause>& causes, const ViewBasis& basis)
      : sides_(basis.cameras, std::vector<Eigen::Index>(kCameraColumns.size(), -1)) {
    for (std::size_t i = 0; i < causes.size(); ++i)
      for (std::size_t c = 0; c < basis.cameras && causes[i].columns.size() == 1; ++c)
        if (const std::size_t column = causes[i].columns.front();
            column >= basis.camera(c) && column < basis.camera(c) + kCameraColumns.size())
          sides_[c][column - basis.camera(c)] = 1 + index(i);
  }
  template <typename Row>
  [[nodiscard]] Eigen::RowVectorXd of(std::size_t camera, const Row& row) const {
    Eigen::RowVectorXd columns(index(kCameraColumns.size()));
    for (std::size_t k = 0; k < kCameraColumns.size(); ++k)
      columns[index(k)] = sides_[camera][k] < 0 ? 0.0 : row[sides_[camera][k]];
    return columns;
  }

 private:
  std::vector<std::vector<Eigen::Index>> sides_;
};

double size_in(const ViewPoint& point, const ViewCause& cause) {
  if (cause.name.empty())
    return point.linear.size() > 0 ? point.linear[index(cause.columns.front())] : 0.0;
  const auto found = point.effects.find(cause.name);
  return found == point.effects.end() ? 0.0 : found->second;
}

// Noise of a channel relative to the assumed one. Uses the median, which single bumps of the road
// do not change.
double channel_scale(const Saturated& s, std::size_t channel) {
  const auto& squares = s.squares[channel];
  if (squares.empty()) return 1.0;
  const double share = s.redundancy[channel] / static_cast<double>(squares.size());
  if (share < kLeastRedundancy) return 1.0;  // the fit follows these rows completely
  return std::clamp(std::sqrt(median(squares) / kMedianOfSquare / share), 0.05, 20.0);
}

// Squared residuals of the views of each camera in units of its noise, corrected for the
// redundancy.
std::vector<std::vector<double>> view_squares(const Saturated& s, const ViewData& data) {
  std::vector<std::vector<double>> squares(data.bundle.cameras.size());
  std::vector<double> share;
  for (std::size_t c = 0; c < squares.size(); ++c)
    share.push_back(std::max(
        kLeastRedundancy,
        s.redundancy[c] / static_cast<double>(std::max<std::size_t>(1, s.squares[c].size()))));
  for (std::size_t o = 0; o < s.view_square.size(); ++o) {
    const BundleObservation& seen = data.bundle.observations[o];
    squares[at(seen.camera)].push_back(s.view_square[o] * seen.sigma_px * seen.sigma_px /
                                       share[at(seen.camera)]);
  }
  return squares;
}

// Adds Gaussian priors about the known sizes to the normal equations.
void add_priors(const std::vector<ViewCause>& causes,
                const ViewPoint& point,
                const ViewPoint& known,
                Eigen::MatrixXd& F) {
  for (std::size_t c = 0; c < causes.size(); ++c) {
    const double prior = 1.0 / (causes[c].tau * causes[c].tau);
    F(1 + index(c), 1 + index(c)) += prior;
    F(1 + index(c), 0) -= prior * (size_in(point, causes[c]) - size_in(known, causes[c]));
  }
}

// Variance inflation of each camera by common errors of landmarks and images.
class Scatters {
 public:
  Scatters(const ViewData& data, CameraSides sides)
      : sides_(std::move(sides)), by_landmark_(data), by_image_(data, index(kSaturationProbes)) {}

  void add(const ViewRow& row,
           const Eigen::Ref<const Eigen::RowVectorXd>& left,
           const Eigen::Ref<const Eigen::RowVectorXd>& columns) {
    const Eigen::RowVectorXd own = sides_.of(row.channel, columns);
    by_landmark_.add(at(row.observation), left[0], own);
    by_image_.add(at(row.observation), left, own);
  }

  [[nodiscard]] std::vector<double> ratios() const {
    std::vector<double> ratios = by_landmark_.ratios();
    const std::vector<double> by_image = by_image_.ratios();
    for (std::size_t c = 0; c < ratios.size(); ++c) ratios[c] = std::max(ratios[c], by_image[c]);
    return ratios;
  }

 private:
  CameraSides sides_;
  LandmarkScatter by_landmark_;
  ImageScatter by_image_;
};

// Residuals after a step by `sizes` (one column for the residual, one a probe), by channel and
// view. `rows`: the projected rows of each pose.
Saturated left_over(const ViewSystem& system,
                    const ViewSides& sides,
                    const std::vector<ViewPanel>& rows,
                    const Eigen::MatrixXd& sizes,
                    Scatters scatters,
                    const ViewData& data) {
  const ViewChannels channels{data.bundle.cameras.size()};
  constexpr auto kProbes = static_cast<Eigen::Index>(kSaturationProbes);
  Saturated s;
  s.squares.resize(channels.size());
  s.redundancy.assign(channels.size(), 0.0);
  s.view_square.assign(data.bundle.observations.size(), 0.0);
  std::array<std::vector<double>, 6> motions;
  ViewPanel signs;
  for (std::size_t k = 0; k < system.poses(); ++k) {
    system.rows(k, sides, signs, true);
    ViewPanel left(rows[k].rows(), 1 + kProbes);
    left << rows[k].col(0), rows[k].rightCols(kProbes);
    left.noalias() -= rows[k].middleCols(1, sizes.rows()) * sizes;
    const auto& info = system.row_info(k);
    for (std::size_t r = 0; r < info.size(); ++r) {
      const Eigen::Index i = index(r);
      const double square = left(i, 0) * left(i, 0);
      s.squares[info[r].channel].push_back(square);
      s.redundancy[info[r].channel] +=
          signs.row(i).tail(kProbes).dot(rows[k].row(i).tail(kProbes)) / kProbes;
      if (info[r].channel >= channels.motion(0) && info[r].channel <= channels.motion(5))
        motions[info[r].channel - channels.motion(0)].push_back(left(i, 0));
      if (info[r].observation < 0) continue;
      s.view_square[at(info[r].observation)] += square;
      scatters.add(info[r], left.row(i), rows[k].row(i));
    }
  }
  s.scatter = scatters.ratios();
  s.sway = motion_variance_inflation(data.bundle.motions, data.wheels.wheelbase_m, motions);
  return s;
}

}  // namespace

Saturated saturate(const ViewSystem& system,
                   const std::vector<ViewCause>& causes,
                   const ViewBasis& basis,
                   const ViewData& data,
                   const EffectSizes& known,
                   ViewPoint& point) {
  const auto n = index(causes.size());
  const ViewSides sides = system.sides(sums_of(causes, basis.size()), kSaturationProbes);
  ROADBOOK_ASSERT(sides.count == 1 + n + index(kSaturationProbes));
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(sides.count, sides.count);
  std::vector<ViewPanel> rows(system.poses());
  parallel_for(rows.size(), system.num_threads(),
               [&](std::size_t k) { system.rows(k, sides, rows[k]); });
  for (const ViewPanel& values : rows) F.noalias() += values.transpose() * values;
  add_priors(causes, point, {{}, known, {}, {}}, F);
  Eigen::MatrixXd scores(n, 1 + index(kSaturationProbes));
  scores << F.block(1, 0, n, 1), F.block(1, 1 + n, n, index(kSaturationProbes));
  const Eigen::MatrixXd sizes = F.block(1, 1, n, n).ldlt().solve(scores);
  const Eigen::VectorXd size = sizes.col(0);
  system.move(point, sides, size);
  for (Eigen::Index c = 0; c < n; ++c) {
    const ViewCause& cause = causes[static_cast<std::size_t>(c)];
    if (cause.name.empty())
      point.linear[index(cause.columns.front())] += size[c];
    else
      point.effects[cause.name] += size[c];
  }
  return left_over(system, sides, rows, sizes, Scatters(data, CameraSides(causes, basis)), data);
}

void renew_noise(const Saturated& s,
                 const ViewData& data,
                 ViewNoise& noise,
                 std::vector<double>& freedom) {
  const ViewChannels channels{data.bundle.cameras.size()};
  const auto squares = view_squares(s, data);
  freedom.assign(channels.cameras, kNormalFreedom);
  for (std::size_t c = 0; c < channels.cameras; ++c) {
    if (squares[c].empty()) continue;
    const StudentNoise student = student_noise(squares[c]);
    noise.pixel[c] = std::max(0.01, noise.pixel[c] * student.sigma);
    freedom[c] = student.freedom;
  }
  for (std::size_t axis = 0; axis < 6; ++axis)
    noise.motion[axis] =
        std::clamp(noise.motion[axis] * channel_scale(s, channels.motion(axis)), 0.01, 20.0);
  noise.ground_m = std::max(5e-4, noise.ground_m * channel_scale(s, channels.ground()));
}

}  // namespace roadbook
