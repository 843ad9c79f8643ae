#include "diagnosis/inference/diagnosis_result.hpp"

#include <algorithm>

#include "diagnosis/inference/candidate.hpp"

namespace roadbook {
namespace {

template <typename T>
void append(const std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

void add_new(const std::vector<std::string>& from, std::vector<std::string>& to) {
  for (const std::string& name : from)
    if (!holds(to, name)) to.push_back(name);
}

// What one of them shows is observable.
void add_not_observable(const Diagnosis& more, Diagnosis& all) {
  std::vector<std::string> names = more.not_observable;
  std::erase_if(names, [&](const std::string& name) { return shows(all, name); });
  std::erase_if(all.not_observable, [&](const std::string& name) { return shows(more, name); });
  add_new(names, all.not_observable);
}

}  // namespace

void sort_causes(std::vector<FoundCause>& causes) {
  std::stable_sort(causes.begin(), causes.end(), [](const FoundCause& a, const FoundCause& b) {
    return a.noise != b.noise ? b.noise : a.evidence > b.evidence;
  });
}

bool shows(const Diagnosis& d, const std::string& effect) {
  return holds(d.looked_for, effect) && !holds(d.not_observable, effect);
}

void add_lists(const Diagnosis& more, Diagnosis& all) {
  append(more.unknown, all.unknown);
  append(more.unexplained, all.unexplained);
  append(more.notes, all.notes);
  append(more.before, all.before);
  append(more.after, all.after);
}

void add_findings(const Diagnosis& more, Diagnosis& all) {
  all.causes.insert(all.causes.end(), more.causes.begin(), more.causes.end());
  add_lists(more, all);
  add_not_observable(more, all);
  add_new(more.looked_for, all.looked_for);
  for (const auto& [effect, size] : more.extended) all.extended[effect] = size;
  all.samples += more.samples;
  all.fit_gain += more.fit_gain;
  sort_causes(all.causes);
}

}  // namespace roadbook
