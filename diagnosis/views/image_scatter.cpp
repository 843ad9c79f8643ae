#include "diagnosis/views/image_scatter.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"

namespace roadbook {

ImageScatter::ImageScatter(const ViewData& data, Eigen::Index draws) : data_(data) {
  const auto width = kEffects * index(data.bundle.cameras.size());
  scores_.assign(static_cast<std::size_t>(1 + draws),
                 Eigen::MatrixXd::Zero(index(data.bundle.poses.size()), width));
  one_by_one_ = Eigen::MatrixXd::Zero(1 + draws, width);
}

void ImageScatter::add(std::size_t observation,
                       const Eigen::Ref<const Eigen::RowVectorXd>& left,
                       const Eigen::Ref<const Eigen::RowVectorXd>& columns) {
  const BundleObservation& o = data_.bundle.observations[observation];
  const Eigen::Index first = kEffects * o.camera;
  for (std::size_t side = 0; side < scores_.size(); ++side) {
    const Eigen::RowVectorXd score = left[index(side)] * columns;
    scores_[side].row(o.pose).segment(first, kEffects) += score;
    one_by_one_.row(index(side)).segment(first, kEffects) += score.cwiseAbs2();
  }
}

Eigen::VectorXd ImageScatter::shared(std::size_t side) const {
  // The squared sums over windows of kImagesAlike images weigh the product of two images at lag l
  // by 1 - l / kImagesAlike (Bartlett weights).
  const Eigen::MatrixXd& scores = scores_[side];
  Eigen::RowVectorXd window = Eigen::RowVectorXd::Zero(scores.cols());
  Eigen::RowVectorXd squares = window;
  for (Eigen::Index k = 0; k < scores.rows() + kImagesAlike - 1; ++k) {
    if (k < scores.rows()) window += scores.row(k);
    if (k >= kImagesAlike) window -= scores.row(k - kImagesAlike);
    squares += window.cwiseAbs2() / static_cast<double>(kImagesAlike);
  }
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(scores.cols() / kEffects);
  for (Eigen::Index c = 0; c < mean.size(); ++c) {
    double count = 0.0;
    for (Eigen::Index k = kEffects * c, end = k + kEffects; k < end; ++k)
      if (const double alone = one_by_one_(index(side), k); alone > 0.0) {
        mean[c] += squares[k] / alone;
        count += 1.0;
      }
    mean[c] /= std::max(1.0, count);
  }
  return mean;
}

std::vector<double> ImageScatter::ratios() const {
  Eigen::VectorXd independent = Eigen::VectorXd::Zero(index(data_.bundle.cameras.size()));
  for (std::size_t side = 1; side < scores_.size(); ++side)
    independent += shared(side) / static_cast<double>(scores_.size() - 1);
  const Eigen::VectorXd read = shared(0);
  // With Bartlett weights the variance of an effect's ratio is 4/3 over the number of windows. The
  // ratios of a camera's effects are correlated, so averaging them does not reduce it.
  const double windows =
      std::max(1.0, static_cast<double>(data_.bundle.poses.size()) / kImagesAlike);
  const double least = 1.0 + 2.0 * std::sqrt(4.0 / 3.0 / windows);
  std::vector<double> ratios;
  for (Eigen::Index c = 0; c < read.size(); ++c) {
    const double ratio = independent[c] > 0.0 ? read[c] / independent[c] : 1.0;
    ratios.push_back(ratio > least ? ratio : 1.0);
  }
  return ratios;
}

}  // namespace roadbook
