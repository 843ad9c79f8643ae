#include "drive/true_poses.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

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

std::optional<std::string> true_world(const Drive& drive) {
  std::ifstream in(drive.folder() / "truth" / "world.json");
  const auto world = nlohmann::json::parse(in, nullptr, false);
  if (!world.is_object()) return std::nullopt;
  const auto scenario = world.find("scenario");
  const auto size = world.find("size");
  const auto seed = world.find("seed");
  if (scenario == world.end() || !scenario->is_string() || size == world.end() ||
      !size->is_string() || seed == world.end() || !seed->is_number_integer())
    return std::nullopt;
  return scenario->get<std::string>() + ", size " + size->get<std::string>() + ", seed " +
         seed->dump();
}

}  // namespace roadbook
