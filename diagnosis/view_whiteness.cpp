#include "diagnosis/view_whiteness.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "base/index.hpp"
#include "base/random.hpp"

namespace roadbook {
namespace {

constexpr int kNullDraws = 32;

// Of the map: what several passes see of one landmark are several points.
int landmark_of(const ViewData& data, int observation) {
  return data.landmark[at(data.bundle.observations[at(observation)].point)];
}

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
      const auto left = values.row(index(i)).array();
      const int landmark = landmark_of(data_, info[i].observation);
      axes_[2 * info[i].channel + (second ? 1 : 0)].now.row(landmark % 2) += left;
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

// What is left of every row, with a sign of its own in each draw; views of one landmark of the map
// share theirs.
std::vector<ViewDraw> signed_errors(const ViewSystem& system, const ViewData& data) {
  const ViewSides left = system.sides({});
  std::vector<ViewDraw> draws;
  draws.reserve(system.row_count());
  ViewPanel values;
  for (std::size_t k = 0; k < system.poses(); ++k) {
    system.rows(k, left, values);
    Random own(1, "signs of rows", k);
    for (const ViewRow& row : system.row_info(k)) {
      const double error = values(index(draws.size() - system.first_row(k)), 0);
      if (row.observation < 0) {
        draws.push_back({error, own()});
        continue;
      }
      const auto landmark = static_cast<std::uint64_t>(landmark_of(data, row.observation));
      draws.push_back({error, Random(1, "signs of landmarks", landmark)()});
    }
  }
  return draws;
}

}  // namespace

std::vector<double> image_whiteness(const ViewSystem& system, const ViewData& data) {
  const ViewSides sides = system.drawn_sides(signed_errors(system, data), kNullDraws);
  ImageCorrelation correlation(data, sides.count);
  ViewPanel values;
  for (std::size_t k = 0; k < system.poses(); ++k) {
    system.rows(k, sides, values);
    correlation.add(system.row_info(k), values);
  }
  const Eigen::ArrayXXd ratios = correlation.ratios();
  // Mean and scatter are themselves those of so many draws.
  const double uncertain = std::sqrt(1.0 + 1.0 / kNullDraws);
  const boost::math::students_t drawn_from(kNullDraws - 1);
  std::vector<double> p;
  for (Eigen::Index c = 0; c < ratios.rows(); ++c) {
    const auto drawn = ratios.row(c).tail(kNullDraws);
    const double mean = drawn.mean();
    const double sigma = std::sqrt((drawn - mean).square().sum() / (kNullDraws - 1));
    p.push_back(sigma > 0.0
                    ? cdf(complement(drawn_from, (ratios(c, 0) - mean) / (uncertain * sigma)))
                    : 1.0);
  }
  return p;
}

}  // namespace roadbook
