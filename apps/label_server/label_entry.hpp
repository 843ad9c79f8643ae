#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/label_server/label_answers.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

/// A label in the form that pages receive.
struct LabelEntry {
  Label label;
  std::int64_t said_ns = 0;  ///< time of the first answer about the class
  std::string wire;          ///< JSON; made at each change, not for each reader

  /// Takes the next version of the label.
  void take(const Label& now) {
    if (label.version == 0 || !says_the_same(label, now)) said_ns = now.t_ns;
    label = now;
  }

  /// Appends the answer that the label gives about objects of class `kind`, if there is an answer.
  void add_answer(const std::string& kind, std::vector<LabelAnswer>& to) const {
    if (auto answer = answer_of(label, kind)) {
      answer->t_ns = said_ns;
      to.push_back(*answer);
    }
  }
};

}  // namespace roadbook
