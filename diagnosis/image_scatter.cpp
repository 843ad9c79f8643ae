#include "diagnosis/image_scatter.hpp"

#include <algorithm>

#include "base/index.hpp"

namespace roadbook {

ImageScatter::ImageScatter(const ViewData& data) : data_(data) {
  const auto width = kEffects * static_cast<Eigen::Index>(data.bundle.cameras.size());
  scores_ = Eigen::MatrixXd::Zero(index(data.bundle.poses.size()), width);
  information_ = Eigen::RowVectorXd::Zero(width);
}

void ImageScatter::add(std::size_t observation,
                       double residual,
                       const Eigen::Ref<const Eigen::RowVectorXd>& columns) {
  const BundleObservation& o = data_.bundle.observations[observation];
  const Eigen::Index first = kEffects * o.camera;
  scores_.row(o.pose).segment(first, kEffects) += residual * columns;
  information_.segment(first, kEffects) += columns.cwiseAbs2();
}

std::vector<double> ImageScatter::ratios() const {
  // Squares of sums over kImagesAlike images in a row weigh products of two that are l apart by
  // 1 - l / kImagesAlike.
  Eigen::RowVectorXd window = Eigen::RowVectorXd::Zero(scores_.cols());
  Eigen::RowVectorXd squares = window;
  for (Eigen::Index k = 0; k < scores_.rows() + kImagesAlike - 1; ++k) {
    if (k < scores_.rows()) window += scores_.row(k);
    if (k >= kImagesAlike) window -= scores_.row(k - kImagesAlike);
    squares += window.cwiseAbs2() / static_cast<double>(kImagesAlike);
  }
  std::vector<double> ratios;
  for (std::size_t c = 0; c < data_.bundle.cameras.size(); ++c) {
    double sum = 0.0;
    double count = 0.0;
    for (Eigen::Index k = kEffects * index(c), end = k + kEffects; k < end; ++k)
      if (information_[k] > 0.0) {
        sum += squares[k] / information_[k];
        count += 1.0;
      }
    ratios.push_back(count > 0.0 ? std::max(1.0, sum / count) : 1.0);
  }
  return ratios;
}

}  // namespace roadbook
