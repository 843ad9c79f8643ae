#include "drive/problem_list.hpp"

namespace roadbook {

void ProblemList::add(Problem problem) {
  const std::scoped_lock lock(mutex_);
  if (problem.severity == Severity::kError) ++errors_;
  if (++count_[{problem.file, problem.severity}] <= kMaxPerFile)
    kept_.push_back(std::move(problem));
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

bool ProblemList::has_errors() const { return error_count() > 0; }

std::size_t ProblemList::error_count() const {
  const std::scoped_lock lock(mutex_);
  return errors_;
}

std::vector<Problem> ProblemList::problems() const {
  const std::scoped_lock lock(mutex_);
  std::vector<Problem> all = kept_;
  for (const auto& [key, count] : count_) {
    if (count <= kMaxPerFile) continue;
    all.push_back(
        {key.second, key.first, 0, "and " + std::to_string(count - kMaxPerFile) + " more", "", ""});
  }
  return all;
}

}  // namespace roadbook
