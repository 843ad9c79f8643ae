#include "diagnosis/diagnose_together.hpp"

#include <algorithm>

namespace roadbook {
namespace {

// Of a name and its variants of single drives, the name alone.
void drop_variants(const std::vector<SessionProblem>& drives, std::vector<std::string>& names) {
  std::erase_if(names, [&](const std::string& name) {
    return std::any_of(drives.begin(), drives.end(),
                       [&](const SessionProblem& d) { return name.ends_with(" in " + d.name); });
  });
}

}  // namespace

Diagnosis diagnose_together(const std::vector<SessionProblem>& drives,
                            const SearchOptions& options) {
  if (drives.empty()) return {};
  if (drives.size() == 1) return diagnose(*drives.front().problem, options);
  Diagnosis d = diagnose(SessionsProblem(drives), options);
  drop_variants(drives, d.looked_for);
  drop_variants(drives, d.not_observable);
  return d;
}

}  // namespace roadbook
