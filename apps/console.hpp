#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/messages.hpp"
#include "base/progress.hpp"

namespace roadbook {

// The output of the program: results on standard output, all other messages on standard error.

class Console final : public Messages {
 public:
  /// Logs go to standard error. `json`: the result is one object on standard output. `quiet`: no
  /// progress.
  Console(bool json, bool quiet);

  /// Prints a line for a user at a terminal. Prints nothing with `--json`, because the object is
  /// the result.
  void say(const std::string& line) const override;
  /// Prints the result with `--json`, otherwise nothing. Call it once.
  void result(const nlohmann::ordered_json& object) const;
  /// Prints warnings about problems that do not end the program, one line each.
  void warn(const std::vector<Problem>& problems) const override;
  void note(const std::string& line) const override;

  /// Shows progress (a bar on a terminal, otherwise a line for every tenth). Returns false after
  /// the user has interrupted. The result refers to this console.
  [[nodiscard]] Progress progress() override;

  [[nodiscard]] bool json() const { return json_; }

 private:
  bool show(std::string_view stage, std::size_t done, std::size_t total);

  bool json_ = false;
  bool quiet_ = false;
  bool terminal_ = false;
  std::string stage_;       ///< shown last
  std::size_t tenths_ = 0;  ///< of the stage, last displayed
  int permille_ = -1;       ///< last displayed, on a terminal
};

/// Prints an error on standard error, one line for each of its problems.
void print_error(const Error& error);
void print_error(const std::string& line);

/// After this call, SIGINT and SIGTERM ask running stages to stop. A second signal ends the
/// program.
void catch_interrupts();
[[nodiscard]] bool interrupted();

}  // namespace roadbook
