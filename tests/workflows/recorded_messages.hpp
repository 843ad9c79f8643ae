#pragma once

#include <set>
#include <string>
#include <vector>

#include "base/messages.hpp"

namespace roadbook::test {

/// Keeps all messages of a function. Asks the function to stop in the stage `stop_in`, if set.
class RecordedMessages final : public Messages {
 public:
  explicit RecordedMessages(std::string stop_in = {}) : stop_in_(std::move(stop_in)) {}

  void say(const std::string& line) const override { said.push_back(line); }
  void note(const std::string& line) const override { notes.push_back(line); }
  void warn(const std::vector<Problem>& problems) const override {
    warnings.insert(warnings.end(), problems.begin(), problems.end());
  }
  [[nodiscard]] Progress progress() override {
    return [this](std::string_view stage, std::size_t, std::size_t) {
      stages.emplace(stage);
      return stop_in_.empty() || stage != stop_in_;
    };
  }

  // `Messages` has constant functions, because most receivers print.
  mutable std::vector<std::string> said;
  mutable std::vector<std::string> notes;
  mutable std::vector<Problem> warnings;
  std::set<std::string> stages;

 private:
  std::string stop_in_;
};

}  // namespace roadbook::test
