#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "tests/apps/run_command.hpp"

namespace roadbook::test {

/// The built `roadbook` in a process of its own, which a test can hold at any moment. The
/// destructor kills a process that has not been waited for.
class RunningProgram {
 public:
  /// Starts `roadbook ARGUMENTS` in `folder`; the arguments hold no spaces.
  RunningProgram(const std::string& arguments, const std::filesystem::path& folder);
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  /// False where the process has ended.
  [[nodiscard]] bool is_running();
  void hold() const;
  void go_on() const;
  void kill_now() const;
  /// Waits for the end. Call it once.
  CommandResult wait();

 private:
  ScratchFolder outputs_;
  pid_t pid_ = -1;
  int status_ = 0;
  bool has_ended_ = false;
};

}  // namespace roadbook::test
