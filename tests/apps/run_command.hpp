#pragma once

#include <filesystem>
#include <string>

namespace roadbook::test {

/// The exit status and the output of a command.
struct CommandResult {
  int status = -1;  ///< exit status; 128 + signal where it was killed by one
  std::string out;
  std::string err;
};

/// Runs a shell command in `folder` with the built `roadbook` first on the path.
CommandResult run_command(const std::string& command, const std::filesystem::path& folder);

/// A new folder that the destructor removes.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

[[nodiscard]] std::string read_text(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace roadbook::test
