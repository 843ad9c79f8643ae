#include "vo/two_view.hpp"

#include <cmath>
#include <opengv/relative_pose/CentralRelativeAdapter.hpp>
#include <opengv/sac/Ransac.hpp>
#include <opengv/sac_problems/relative_pose/CentralRelativePoseSacProblem.hpp>

#include "base/se3.hpp"

namespace roadbook {

std::optional<TwoView> find_two_view(const std::vector<BearingPair>& pairs, double inlier_rad) {
  using Problem = opengv::sac_problems::relative_pose::CentralRelativePoseSacProblem;
  if (pairs.size() < 20) return std::nullopt;
  opengv::bearingVectors_t old_bearings;
  opengv::bearingVectors_t new_bearings;
  for (const auto& pair : pairs) {
    old_bearings.push_back(pair.old_bearing);
    new_bearings.push_back(pair.new_bearing);
  }
  opengv::relative_pose::CentralRelativeAdapter adapter(old_bearings, new_bearings);
  opengv::sac::Ransac<Problem> sampler;
  constexpr bool kRandomSeed = false;  // the same samples every time
  sampler.sac_model_ = std::make_shared<Problem>(adapter, Problem::NISTER, kRandomSeed);
  sampler.threshold_ = 2.0 * (1.0 - std::cos(inlier_rad));
  sampler.max_iterations_ = 500;
  if (!sampler.computeModel()) return std::nullopt;
  Problem::model_t refined = sampler.model_coefficients_;
  sampler.sac_model_->optimizeModelCoefficients(sampler.inliers_, sampler.model_coefficients_,
                                                refined);
  TwoView result;
  sampler.sac_model_->selectWithinDistance(refined, sampler.threshold_, result.inliers);
  if (!refined.allFinite() || result.inliers.size() < std::max<std::size_t>(15, pairs.size() / 3))
    return std::nullopt;
  result.T_old_new.linear() = nearest_rotation(refined.leftCols<3>());
  const Eigen::Vector3d t = refined.col(3);
  if (!(t.norm() > 1e-9)) return std::nullopt;
  result.T_old_new.translation() = t.normalized();
  return result;
}

}  // namespace roadbook
