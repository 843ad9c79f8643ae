#include "diagnosis/view_whiteness.hpp"

#include <cmath>

#include "base/index.hpp"
#include "diagnosis/student_tail.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kNullDraws = 32;

// Q over the sum of squares, of each camera (rows) and side (columns), image by image.
class ImageCorrelation {
 public:
  ImageCorrelation(const ViewData& data, Eigen::Index sides)
      : data_(data),
        axes_(2 * data.bundle.cameras.size(), Axis(sides)),
        products_(Eigen::ArrayXXd::Zero(index(data.bundle.cameras.size()), sides)),
        squares_(products_) {}

  void add(const std::vector<ViewRow>& info, const ViewPanel& values) {
    for (std::size_t i = 0; i < info.size(); ++i) {
      if (info[i].observation < 0) continue;
      const bool second = i > 0 && info[i - 1].observation == info[i].observation;
      const int point = data_.bundle.observations[at(info[i].observation)].point;
      const auto left = values.row(index(i)).array();
      axes_[2 * info[i].channel + (second ? 1 : 0)].now.row(point % 2) += left;
      squares_.row(index(info[i].channel)) += left.square();
    }
    for (std::size_t a = 0; a < axes_.size(); ++a) axes_[a].next(products_.row(index(a / 2)));
  }

  [[nodiscard]] Eigen::ArrayXXd ratios() const { return products_ / squares_.max(1e-300); }

 private:
  // One component of a camera's pixels; rows are the two halves of the landmarks.
  struct Axis {
    explicit Axis(Eigen::Index sides)
        : now(Eigen::ArrayXXd::Zero(2, sides)), before(Eigen::ArrayXXd::Zero(2, sides)) {}
    Eigen::ArrayXXd now;     ///< of this image
    Eigen::ArrayXXd before;  ///< of those before, by 0.9 for each

    template <typename Row>
    void next(Row&& products) {
      constexpr double kAsBefore = 0.9;
      before *= kAsBefore;
      products += now.row(0) * (now.row(1) + before.row(1)) + now.row(1) * before.row(0);
      before += now;
      now.setZero();
    }
  };

  const ViewData& data_;
  std::vector<Axis> axes_;
  Eigen::ArrayXXd products_;
  Eigen::ArrayXXd squares_;
};

// Of the residual and so many random signs.
Eigen::ArrayXXd correlations(const ViewSystem& system, const ViewData& data, std::size_t draws) {
  const ViewSides sides = system.sides({}, draws);
  ImageCorrelation all(data, sides.count);
  ViewPanel values;
  for (std::size_t k = 0; k < system.poses(); ++k) {
    system.rows(k, sides, values);
    all.add(system.row_info(k), values);
  }
  return all.ratios();
}

}  // namespace

NullCorrelation null_correlation(const ViewSystem& system, const ViewData& data) {
  const Eigen::ArrayXXd drawn = correlations(system, data, kNullDraws).rightCols(kNullDraws);
  NullCorrelation null;
  null.mean = drawn.rowwise().mean();
  null.sigma = ((drawn.colwise() - null.mean).square().rowwise().sum() / (kNullDraws - 1.0)).sqrt();
  return null;
}

std::vector<double> image_whiteness(const ViewSystem& system,
                                    const ViewData& data,
                                    const NullCorrelation& null) {
  const Eigen::ArrayXd left = correlations(system, data, 0).col(0);
  // Mean and scatter are themselves those of so many draws.
  const double uncertain = std::sqrt(1.0 + 1.0 / kNullDraws);
  std::vector<double> p;
  for (Eigen::Index c = 0; c < left.size(); ++c)
    p.push_back(null.sigma[c] > 0.0
                    ? student_tail((left[c] - null.mean[c]) / (uncertain * null.sigma[c]),
                                   static_cast<int>(kNullDraws) - 1)
                    : 1.0);
  return p;
}

}  // namespace roadbook
