#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "diagnosis/friction/friction_columns.hpp"

namespace roadbook {
namespace {

bool has_term_of(const std::vector<Candidate>& candidates, const std::string& covariate) {
  return std::any_of(candidates.begin(), candidates.end(),
                     [&](const Candidate& c) { return c.covariate == covariate; });
}

// Without a logged temperature all readings have the reference temperature, which explains nothing.
TEST(FrictionTerms, DependOnTemperatureOnlyWhereItIsLogged) {
  FrictionReadings readings;
  readings.samples.resize(3);
  const SurfaceClasses classes = surface_classes(readings.samples);
  for (const bool logged : {false, true}) {
    readings.has_temperature = logged;
    const auto terms = friction_grammar(readings, classes);
    EXPECT_EQ(has_term_of(terms, "temperature"), logged);
    EXPECT_TRUE(has_term_of(terms, "speed"));
  }
}

}  // namespace
}  // namespace roadbook
