#include "mapping/localisation/spread_ransac.hpp"

#include <cmath>
#include <functional>
#include <memory>
#include <opengv/absolute_pose/NoncentralAbsoluteMultiAdapter.hpp>
#include <opengv/sac/MultiRansac.hpp>
#include <opengv/sac_problems/absolute_pose/MultiNoncentralAbsolutePoseSacProblem.hpp>
#include <vector>

#include "base/index.hpp"
#include "base/random.hpp"
#include "base/se3.hpp"

namespace roadbook {
namespace {

using SpreadProblem = opengv::sac_problems::absolute_pose::MultiNoncentralAbsolutePoseSacProblem;

constexpr std::size_t kSample = 4;  // three for a pose, the fourth to choose among its solutions

// OpenGV's problem draws from the clock and from rand(); this one from a seed.
class SeededProblem : public SpreadProblem {
 public:
  SeededProblem(adapter_t& adapter, bool is_central, std::uint64_t seed)
      : SpreadProblem(adapter, is_central), random_(seed, "spread rig pose") {
    rng_gen_ = std::make_shared<std::function<int()>>(
        [this] { return static_cast<int>(random_.below(0x7FFFFFFF)); });
  }
  // One observation of each camera in turn, from a random one on.
  [[nodiscard]] std::vector<int> getSampleSizes() const override {
    std::vector<int> sizes(_adapter.getNumberFrames(), 0);
    const std::size_t first = random_.below(sizes.size());
    for (std::size_t i = 0; i < kSample; ++i) ++sizes[(first + i) % sizes.size()];
    return sizes;
  }

 private:
  mutable Random random_;
};

struct OfCamera {
  std::shared_ptr<opengv::bearingVectors_t> bearings = std::make_shared<opengv::bearingVectors_t>();
  std::shared_ptr<opengv::points_t> points = std::make_shared<opengv::points_t>();
};

std::optional<Eigen::Isometry3d> checked(const opengv::transformation_t& model) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = nearest_rotation(model.leftCols<3>());
  T.translation() = model.col(3);
  if (!T.matrix().allFinite()) return std::nullopt;
  return T;
}

}  // namespace

std::optional<Eigen::Isometry3d> find_spread_rig_pose(const Rig& rig,
                                                      std::span<const RigObservation> observations,
                                                      const SpreadRansacOptions& options) {
  std::vector<OfCamera> all(rig.cameras.size());
  for (const RigObservation& seen : observations) {
    const auto bearing = rig.cameras[at(seen.camera)].camera.bearing(seen.pixel);
    if (!bearing) continue;
    all[at(seen.camera)].bearings->push_back(*bearing);
    all[at(seen.camera)].points->push_back(seen.p_world);
  }
  std::vector<std::shared_ptr<opengv::bearingVectors_t>> bearings;
  std::vector<std::shared_ptr<opengv::points_t>> points;
  opengv::translations_t offsets;
  opengv::rotations_t rotations;
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (all[c].points->size() < kSample) continue;
    bearings.push_back(all[c].bearings);
    points.push_back(all[c].points);
    offsets.push_back(rig.cameras[c].T_vehicle_camera.translation());
    rotations.push_back(rig.cameras[c].T_vehicle_camera.linear());
  }
  if (points.empty()) return std::nullopt;
  opengv::absolute_pose::NoncentralAbsoluteMultiAdapter adapter(bearings, points, offsets,
                                                                rotations);
  opengv::sac::MultiRansac<SpreadProblem> sampler;
  sampler.sac_model_ = std::make_shared<SeededProblem>(adapter, points.size() == 1, options.seed);
  sampler.threshold_ = 1.0 - std::cos(options.inlier_rad);
  sampler.max_iterations_ = options.iterations;
  if (!sampler.computeModel(0)) return std::nullopt;
  return checked(sampler.model_coefficients_);
}

}  // namespace roadbook
