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
  /// Logs go to standard error. `json`: the result is one object on standard output; `quiet`: no
  /// progress.
  Console(bool json, bool quiet);

  /// A line for the reader of a terminal; silent with `--json`, where the object is the result.
  void say(const std::string& line) const override;
  /// The result with `--json`; silent without. To be called once.
  void result(const nlohmann::ordered_json& object) const;
  /// Survivable damage, one line each.
  void warn(const std::vector<Problem>& problems) const override;
  void note(const std::string& line) const override;

  /// Shows progress (a bar on a terminal, else a line for every tenth) and returns false once the
  /// user has interrupted. Refers to this console.
  [[nodiscard]] Progress progress() override;

  [[nodiscard]] bool json() const { return json_; }

 private:
  bool show(std::string_view stage, std::size_t done, std::size_t total);

  bool json_ = false;
  bool quiet_ = false;
  bool terminal_ = false;
  std::string stage_;       ///< shown last
  std::size_t tenths_ = 0;  ///< of the stage, shown last
  int permille_ = -1;       ///< shown last, on a terminal
};

/// Prints an error on standard error, one line for every problem it carries.
void print_error(const Error& error);
void print_error(const std::string& line);

/// From now on SIGINT and SIGTERM ask running stages to stop; a second one ends the program.
void catch_interrupts();
[[nodiscard]] bool interrupted();

}  // namespace roadbook
