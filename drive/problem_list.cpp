#include "drive/problem_list.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

namespace roadbook {
namespace {

constexpr std::size_t kListed = 3;  // findings of one kind with a line each

// The text with each run of digits as one '#'.
std::string without_numbers(const std::string& text) {
  std::string kind;
  for (const char c : text) {
    const bool digit = c >= '0' && c <= '9';
    if (!digit)
      kind += c;
    else if (kind.empty() || kind.back() != '#')
      kind += '#';
  }
  return kind;
}

double step_s(const ClockStep& step) {
  return 1e-9 * static_cast<double>(step.before_ns - step.after_ns);
}

// Streams of one clock are stamped at other moments, each with the interval of its own rows.
bool same_step(const ClockStep& a, const ClockStep& b) {
  constexpr double kApart_s = 1.0;
  return std::abs(1e-9 * static_cast<double>(a.before_ns - b.before_ns)) <= kApart_s &&
         std::abs(step_s(a) - step_s(b)) <= 0.2 * std::max(step_s(a), step_s(b)) + 0.1;
}

Problem told(const std::vector<ClockStep>& steps) {
  const ClockStep& first = steps.front();
  std::ostringstream got;
  got.precision(4);
  got << "a clock that goes back by " << step_s(first) << " s (" << first.rows << " rows, to line "
      << first.last_line << ")";
  for (std::size_t i = 1; i < steps.size(); ++i)
    got << (i == 1 ? "; so do " : ", ")
        << std::filesystem::path(steps[i].file).parent_path().filename().string();
  return {Severity::kError, first.file,
          first.line,       "timestamp",
          got.str(),        "more than " + std::to_string(first.before_ns) + " of the row before"};
}

}  // namespace

void ProblemList::add(Problem problem) {
  const std::scoped_lock lock(mutex_);
  if (problem.severity == Severity::kError) ++errors_;
  Group* group = nullptr;
  if (problem.line > 0) {
    group = &groups_[{problem.file, problem.severity, without_numbers(problem.field),
                      without_numbers(problem.want)}];
    group->last_line = std::max(group->last_line, problem.line);
    if (group->count++ >= kListed) return;
  }
  if (++count_[{problem.file, problem.severity}] <= kMaxPerFile)
    kept_.push_back({std::move(problem), group, group == nullptr ? 0 : group->count - 1});
}

void ProblemList::error(
    std::string file, std::int64_t line, std::string field, std::string got, std::string want) {
  add({Severity::kError, std::move(file), line, std::move(field), std::move(got), std::move(want)});
}

void ProblemList::warning(
    std::string file, std::int64_t line, std::string field, std::string got, std::string want) {
  add({Severity::kWarning, std::move(file), line, std::move(field), std::move(got),
       std::move(want)});
}

void ProblemList::add_all(const std::vector<Problem>& problems) {
  for (const auto& problem : problems) add(problem);
}

void ProblemList::add_step(ClockStep step) {
  const std::scoped_lock lock(mutex_);
  ++errors_;
  const auto same = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) {
    return !kept.steps.empty() && kept.steps.front().file != step.file &&
           same_step(kept.steps.front(), step);
  });
  if (same != kept_.end())
    same->steps.push_back(std::move(step));
  else if (++count_[{step.file, Severity::kError}] <= kMaxPerFile)
    kept_.push_back({{}, nullptr, 0, {std::move(step)}});
}

bool ProblemList::has_errors() const { return error_count() > 0; }

std::size_t ProblemList::error_count() const {
  const std::scoped_lock lock(mutex_);
  return errors_;
}

std::vector<Problem> ProblemList::problems() const {
  const std::scoped_lock lock(mutex_);
  std::vector<Problem> all;
  for (const Kept& kept : kept_) {
    const bool many = kept.group != nullptr && kept.group->count > kListed;
    if (many && kept.index > 0) continue;
    all.push_back(kept.steps.empty() ? kept.problem : told(kept.steps));
    if (many)
      all.back().got += ", and the like in " + std::to_string(kept.group->count - 1) +
                        " more lines up to " + std::to_string(kept.group->last_line);
  }
  for (const auto& [key, count] : count_) {
    if (count <= kMaxPerFile) continue;
    all.push_back(
        {key.second, key.first, 0, "and " + std::to_string(count - kMaxPerFile) + " more", "", ""});
  }
  return all;
}

}  // namespace roadbook
