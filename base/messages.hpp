#pragma once

#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/progress.hpp"

namespace roadbook {

/// Receives the messages of a long function. The command prints them; a program that calls the
/// libraries may collect them, or pass NoMessages.
class Messages {
 public:
  Messages() = default;
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;
  virtual ~Messages() = default;

  /// Reports that a part is done, in one line.
  virtual void say(const std::string& line) const = 0;
  /// Tells the user something to know, in one line, such as rows that were left out.
  virtual void note(const std::string& line) const = 0;
  /// Reports faults of the input that the function could work around, one line each.
  virtual void warn(const std::vector<Problem>& problems) const = 0;
  /// Shows the progress of stages; returns false once the user has interrupted.
  [[nodiscard]] virtual Progress progress() = 0;
};

/// Drops everything.
class NoMessages final : public Messages {
 public:
  void say(const std::string&) const override {}
  void note(const std::string&) const override {}
  void warn(const std::vector<Problem>&) const override {}
  [[nodiscard]] Progress progress() override { return {}; }
};

}  // namespace roadbook
