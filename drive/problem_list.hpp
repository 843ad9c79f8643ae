#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/error.hpp"

namespace roadbook {

/// A clock that goes back within a table: rows whose stamps are not later than those before.
struct ClockStep {
  std::string file;
  std::int64_t line = 0;       ///< of the first such row
  std::int64_t last_line = 0;  ///< of the last one
  std::int64_t before_ns = 0;  ///< the stamp above the first such row
  std::int64_t after_ns = 0;   ///< its own
  std::size_t rows = 0;
};

/// Gathers problems from any thread. Findings of one kind in the lines of one file (the same field
/// and want, but for numbers) become one from the fourth on: the first one with the number of the
/// others and the last line. Keeps only the first few kinds of each file and severity and counts
/// the rest, so that a table with a fault in every row still gives a readable list.
class ProblemList {
 public:
  static constexpr std::size_t kMaxPerFile = 20;

  void add(Problem problem);
  void error(
      std::string file, std::int64_t line, std::string field, std::string got, std::string want);
  void warning(
      std::string file, std::int64_t line, std::string field, std::string got, std::string want);
  void add_all(const std::vector<Problem>& problems);
  /// Adds an error. Steps of several streams at one time become one error: they share a clock.
  void add_step(ClockStep step);

  [[nodiscard]] bool has_errors() const;
  [[nodiscard]] std::size_t error_count() const;
  /// All kept problems in the order they were added, then one "and N more" for each file cut short.
  [[nodiscard]] std::vector<Problem> problems() const;

 private:
  using Kind = std::tuple<std::string, Severity, std::string, std::string>;
  struct Group {
    std::size_t count = 0;
    std::int64_t last_line = 0;
  };
  struct Kept {
    Problem problem;
    Group* group = nullptr;          ///< the kind of the problem; null: stands alone
    std::size_t index = 0;           ///< within the group
    std::vector<ClockStep> steps{};  ///< of one time; then the problem is empty
  };
  mutable std::mutex mutex_;
  std::vector<Kept> kept_;
  std::map<Kind, Group> groups_;
  std::map<std::pair<std::string, Severity>, std::size_t> count_;
  std::size_t errors_ = 0;
};

}  // namespace roadbook
