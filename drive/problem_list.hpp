#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"

namespace roadbook {

/// Gathers problems from any thread. Keeps only the first few of each file and severity and counts
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

  [[nodiscard]] bool has_errors() const;
  [[nodiscard]] std::size_t error_count() const;
  /// All kept problems in the order they were added, then one "and N more" for each file cut short.
  [[nodiscard]] std::vector<Problem> problems() const;

 private:
  mutable std::mutex mutex_;
  std::vector<Problem> kept_;
  std::map<std::pair<std::string, Severity>, std::size_t> count_;
  std::size_t errors_ = 0;
};

}  // namespace roadbook
