#include "drive/true_poses.hpp"

#include "base/error.hpp"
#include "drive/tables.hpp"

namespace roadbook {

std::vector<TimedPose> true_poses(const Drive& drive) {
  const auto file = drive.folder() / "truth" / "poses" / "data.csv";
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return drive.truth();
  std::vector<TimedPose> poses;
  ProblemList problems;
  static_cast<void>(
      read_truth_table(file, problems, [&](const TimedPose& pose) { poses.push_back(pose); }));
  if (problems.has_errors()) throw BadInput(problems.problems());
  return poses;
}

}  // namespace roadbook
