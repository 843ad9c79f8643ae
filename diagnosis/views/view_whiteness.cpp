#include "diagnosis/views/view_whiteness.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "base/index.hpp"
#include "base/random.hpp"

namespace roadbook {
namespace {

constexpr int kNullDraws = 32;

// The landmark in the map, which several points may share.
int landmark_of(const ViewData& data, int observation) {
  return data.landmark[at(data.bundle.observations[at(observation)].point)];
}

// Pixel coordinates of a view, scaled to [-1, 1].
Eigen::Array2d place_in_image(const ViewData& data, int observation) {
  const BundleObservation& seen = data.bundle.observations[at(observation)];
  const Camera& camera = data.bundle.cameras[at(seen.camera)].camera;
  return {2.0 * seen.pixel.x() / camera.width - 1.0, 2.0 * seen.pixel.y() / camera.height - 1.0};
}

// Sums over an image, one row for each half of the landmarks, and their products with earlier
// images.
struct ImageSum {
  explicit ImageSum(Eigen::Index sides)
      : now(Eigen::ArrayXXd::Zero(2, sides)), before(Eigen::ArrayXXd::Zero(2, sides)) {}
  Eigen::ArrayXXd now;     ///< sums of the current image
  Eigen::ArrayXXd before;  ///< decayed sums of earlier images

  template <typename Row>
  void next(Row&& products) {
    constexpr double kAsBefore = 0.9;
    before *= kAsBefore;
    products += now.row(0) * (now.row(1) + before.row(1)) + now.row(1) * before.row(0);
    before += now;
    now.setZero();
  }
};

// Q over the sum of squares; rows: camera and kind of error, columns: sides. The plain sums test
// for a shift, the sums weighted by pixel coordinates for a turn or a stretch.
class ImageCorrelation {
 public:
  static constexpr std::size_t kKinds = 2;

  ImageCorrelation(const ViewData& data, Eigen::Index sides)
      : data_(data),
        sums_(kSums * data.bundle.cameras.size(), ImageSum(sides)),
        products_(Eigen::ArrayXXd::Zero(index(kKinds * data.bundle.cameras.size()), sides)),
        squares_(products_) {}

  void add(const std::vector<ViewRow>& info, const ViewPanel& values) {
    for (std::size_t i = 0; i < info.size(); ++i) {
      if (info[i].observation < 0) continue;
      const std::size_t second = i > 0 && info[i - 1].observation == info[i].observation ? 1 : 0;
      const auto left = values.row(index(i)).array();
      const Eigen::Index half = landmark_of(data_, info[i].observation) % 2;
      const Eigen::Array2d place = place_in_image(data_, info[i].observation);
      ImageSum* sums = &sums_[kSums * info[i].channel + 3 * second];
      sums[0].now.row(half) += left;
      sums[1].now.row(half) += place.x() * left;
      sums[2].now.row(half) += place.y() * left;
      squares_.row(index(kKinds * info[i].channel)) += left.square();
      squares_.row(index(kKinds * info[i].channel + 1)) += place.square().sum() * left.square();
    }
    for (std::size_t s = 0; s < sums_.size(); ++s)
      sums_[s].next(products_.row(index(kKinds * (s / kSums) + (s % 3 == 0 ? 0 : 1))));
  }

  [[nodiscard]] Eigen::ArrayXXd ratios() const { return products_ / squares_.max(1e-300); }

 private:
  static constexpr std::size_t kSums = 6;  ///< three for each pixel component
  const ViewData& data_;
  std::vector<ImageSum> sums_;
  Eigen::ArrayXXd products_;
  Eigen::ArrayXXd squares_;
};

// Draws under the null hypothesis: the residual of every row with random signs. All views of a
// landmark of the map share their signs.
std::vector<ViewDraw> signed_errors(const ViewSystem& system, const ViewData& data) {
  const ViewSides left = system.sides({});
  std::vector<ViewDraw> draws;
  draws.reserve(system.row_count());
  system.each_pose(left, [&](std::size_t k, const ViewPanel& values) {
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
  });
  return draws;
}

// p-value of the first ratio under the Student t distribution of the draws.
double chance_of(const Eigen::Ref<const Eigen::ArrayXXd>& ratios) {
  const auto drawn = ratios.row(0).tail(kNullDraws);
  const double mean = drawn.mean();
  const double sigma = std::sqrt((drawn - mean).square().sum() / (kNullDraws - 1));
  if (sigma <= 0.0) return 1.0;
  // Mean and standard deviation come from a finite number of draws.
  const double uncertain = std::sqrt(1.0 + 1.0 / kNullDraws);
  const boost::math::students_t drawn_from(kNullDraws - 1);
  return cdf(complement(drawn_from, (ratios(0, 0) - mean) / (uncertain * sigma)));
}

}  // namespace

std::vector<double> image_whiteness(const ViewSystem& system, const ViewData& data) {
  const ViewSides sides = system.drawn_sides(signed_errors(system, data), kNullDraws);
  ImageCorrelation correlation(data, sides.count);
  system.each_pose(sides, [&](std::size_t k, const ViewPanel& values) {
    correlation.add(system.row_info(k), values);
  });
  const Eigen::ArrayXXd ratios = correlation.ratios();
  std::vector<double> p;
  for (Eigen::Index c = 0; c < ratios.rows(); c += ImageCorrelation::kKinds) {
    double least = 1.0;
    for (std::size_t kind = 0; kind < ImageCorrelation::kKinds; ++kind)
      least = std::min(least, chance_of(ratios.row(c + index(kind))));
    // Correction for the smallest of several p-values.
    p.push_back(-std::expm1(ImageCorrelation::kKinds * std::log1p(-least)));
  }
  return p;
}

}  // namespace roadbook
