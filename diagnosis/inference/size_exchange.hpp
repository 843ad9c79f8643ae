#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/inference/cause_problem.hpp"

namespace roadbook {

/// Combines the estimates of one list of causes from several drives. Each drive contributes the
/// sizes that it can show. Information and weighted sizes add. A drive that is fitted with the
/// information of the other drives as a prior ends at the sizes that fit all drives together.
class SizeExchange {
 public:
  /// `tau`: plausible size of each effect, in its unit.
  SizeExchange(std::size_t drives, const Eigen::VectorXd& tau);

  /// Prior on the sizes with indices `own` from all drives but `d`; sizes that drive d lacks are
  /// marginalised. `first`: in the first round, when some drives have not contributed yet, adds a
  /// weak prior of ten times the plausible size, because one drive alone may not show all effects.
  [[nodiscard]] SizePrior others(std::size_t d,
                                 const std::vector<Eigen::Index>& own,
                                 bool first) const;
  /// Stores the result of a fit of drive `d` with `prior`: sizes `x` of the effects `own`, and the
  /// information of the drive's own data about them.
  void hear(std::size_t d,
            const std::vector<Eigen::Index>& own,
            const Eigen::MatrixXd& information,
            const Eigen::VectorXd& x,
            const SizePrior& prior);

  [[nodiscard]] Eigen::MatrixXd information() const;
  /// Sizes that fit the data of all drives together.
  [[nodiscard]] Eigen::VectorXd sizes() const;

 private:
  Eigen::VectorXd loose_;
  std::vector<Eigen::MatrixXd> information_;
  std::vector<Eigen::VectorXd> weighted_;
};

}  // namespace roadbook
