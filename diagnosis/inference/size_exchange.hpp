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
  /// `tau`: plausible size of each.
  SizeExchange(std::size_t drives, const Eigen::VectorXd& tau);

  /// What the others say of the sizes `own` of drive d; their own causes are free. `first`: as long
  /// as not all have spoken, sizes are held by ten times what is plausible, for one drive alone may
  /// not show them.
  [[nodiscard]] SizePrior others(std::size_t d,
                                 const std::vector<Eigen::Index>& own,
                                 bool first) const;
  /// Drive d was fitted beside `prior`: sizes x with that information of its own data.
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
