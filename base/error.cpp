#include "base/error.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace roadbook {
namespace {

std::string first_line(const std::vector<Problem>& problems) {
  const auto error = std::find_if(problems.begin(), problems.end(),
                                  [](const Problem& p) { return p.severity == Severity::kError; });
  if (error != problems.end()) return to_line(*error);
  return problems.empty() ? "error: bad input" : to_line(problems.front());
}

}  // namespace

std::string to_line(const Problem& problem) {
  std::string text = problem.severity == Severity::kError ? "error" : "warning";
  if (!problem.file.empty()) {
    text += ": " + problem.file;
    if (problem.line > 0) text += ":" + std::to_string(problem.line);
  }
  if (!problem.field.empty()) text += ": " + problem.field;
  if (!problem.got.empty()) text += ": got " + problem.got;
  if (!problem.want.empty()) text += (problem.got.empty() ? ": want " : ", want ") + problem.want;
  return text;
}

BadInput::BadInput(Problem problem) : BadInput(std::vector<Problem>{std::move(problem)}) {}

BadInput::BadInput(std::vector<Problem> problems)
    : Error(ExitStatus::kBadInput, first_line(problems)), problems_(std::move(problems)) {}

InvalidOption::InvalidOption(const std::string& field,
                             const std::string& got,
                             const std::string& want)
    : Error(ExitStatus::kUsage, "error: " + field + ": got " + got + ", want " + want) {
  problem_.field = field;
  problem_.got = got;
  problem_.want = want;
}

void assertion_failed(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "roadbook: internal error: %s (%s:%d)\n", condition, file, line);
  std::abort();
}

}  // namespace roadbook
