#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <set>
#include <string>
#include <vector>

#include "semantics/detector/search_prior.hpp"
#include "semantics/people/person_window.hpp"

namespace roadbook {

/// Training examples of people and non-people, as features. They stay valid in other sessions.
struct PersonExamples {
  std::vector<Eigen::VectorXf> features;  ///< each of PersonWindow::feature_size()
  std::vector<std::int8_t> labels;        ///< 1: a person, -1: not a person
  std::vector<SearchAnswer> answers;      ///< answers to hypotheses in images new to the detector
  std::set<std::string> instants;         ///< names of instants that are completely labelled
  [[nodiscard]] std::size_t size() const { return labels.size(); }
  [[nodiscard]] std::size_t positives() const;
};

/// Adds a window (PersonWindow::patch) as an example; for a person, also its mirror image.
void add_example(const PersonWindow& window,
                 const cv::Mat& crop,
                 bool person,
                 PersonExamples& examples);

/// `a`, followed by those examples and answers of `b` that `a` lacks.
[[nodiscard]] PersonExamples joined(PersonExamples a, const PersonExamples& b);

}  // namespace roadbook
