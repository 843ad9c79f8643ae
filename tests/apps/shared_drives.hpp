#pragma once

#include <filesystem>
#include <string>

#include "tests/apps/run_command.hpp"

namespace roadbook::test {

/// Gives a test its own copy of the drive of `roadbook simulate ARGUMENTS -o drive`.
///
/// Rendering takes most of the time of tests that need images, and many need the same drive. So the
/// command runs once for all tests of a build: its drive stays in the build folder, and each test
/// may change its copy. Another build of the program renders again. A test that needs a drive which
/// another process is rendering waits for it.
///
/// Returns what the command wrote and its status; where that is not 0, there is no drive. The
/// command runs with `--json -q`. Throws std::invalid_argument for arguments with other characters
/// than letters, digits, blanks and "-._".
CommandResult simulate_drive(const std::string& arguments, const std::filesystem::path& drive);

/// Runs a command of the documents in `folder`, with `options` added.
///
/// `roadbook simulate ARGUMENTS -o NAME` gives NAME in `folder` by simulate_drive: the tutorial's
/// first drive is the manual's.
CommandResult run_example(const std::string& command,
                          const std::string& options,
                          const std::filesystem::path& folder);

}  // namespace roadbook::test
