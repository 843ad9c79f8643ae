#include "drive/check.hpp"

#include "drive/loader.hpp"

namespace roadbook {

DriveReport check_drive(const std::filesystem::path& folder, const DriveOptions& options) {
  ProblemList problems;
  DriveContent content = load_drive(folder, options, problems);
  DriveReport report;
  report.problems = problems.problems();
  report.streams = std::move(content.streams);
  report.frames = content.frames.stamps_ns.size();
  report.cameras = content.rig.cameras.size();
  report.has_wheels = content.wheels.has_value();
  report.usable = !problems.has_errors();
  return report;
}

}  // namespace roadbook
