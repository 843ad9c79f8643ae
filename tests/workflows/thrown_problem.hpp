#pragma once

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace roadbook::test {

/// Runs `work`, which must throw BadInput or InvalidOption, and returns its first problem.
template <typename Work>
Problem thrown_problem(const Work& work) {
  try {
    work();
  } catch (const BadInput& fault) {
    return fault.problems().front();
  } catch (const InvalidOption& fault) {
    return fault.problem();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

}  // namespace roadbook::test
