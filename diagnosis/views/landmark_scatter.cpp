#include "diagnosis/views/landmark_scatter.hpp"

#include <algorithm>

#include "base/index.hpp"

namespace roadbook {
namespace {

// A ratio from some hundred landmarks has a standard error of about this excess.
constexpr double kLeastRatio = 1.15;

}  // namespace

LandmarkScatter::LandmarkScatter(const ViewData& data) : data_(data) {
  const int last =
      data.landmark.empty() ? -1 : *std::max_element(data.landmark.begin(), data.landmark.end());
  const auto width = kEffects * static_cast<Eigen::Index>(data.bundle.cameras.size());
  scores_ = Eigen::MatrixXd::Zero(last + 1, width);
  information_ = Eigen::RowVectorXd::Zero(width);
}

void LandmarkScatter::add(std::size_t observation,
                          double residual,
                          const Eigen::Ref<const Eigen::RowVectorXd>& columns) {
  const BundleObservation& o = data_.bundle.observations[observation];
  const Eigen::Index first = kEffects * o.camera;
  scores_.row(data_.landmark[at(o.point)]).segment(first, kEffects) += residual * columns;
  information_.segment(first, kEffects) += columns.cwiseAbs2();
}

std::vector<double> LandmarkScatter::ratios() const {
  const Eigen::RowVectorXd squares = scores_.colwise().squaredNorm();
  std::vector<double> ratios;
  for (std::size_t c = 0; c < data_.bundle.cameras.size(); ++c) {
    double sum = 0.0;
    double count = 0.0;
    for (Eigen::Index k = kEffects * static_cast<Eigen::Index>(c), end = k + kEffects; k < end; ++k)
      if (information_[k] > 0.0) {
        sum += squares[k] / information_[k];
        count += 1.0;
      }
    const double mean = count > 0.0 ? sum / count : 1.0;
    ratios.push_back(mean > kLeastRatio ? mean : 1.0);
  }
  return ratios;
}

}  // namespace roadbook
