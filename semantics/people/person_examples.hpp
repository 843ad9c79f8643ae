#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <set>
#include <string>
#include <vector>

#include "semantics/detector/search_prior.hpp"
#include "semantics/people/person_window.hpp"

namespace roadbook {

/// Windows that somebody has judged, as features: what was learnt in one session serves in the
/// next.
struct PersonExamples {
  std::vector<Eigen::VectorXf> features;  ///< of PersonWindow::feature_size()
  std::vector<std::int8_t> labels;        ///< 1: a person, -1: none
  std::vector<SearchAnswer> answers;      ///< of searches, about images that were new to them
  std::set<std::string> instants;         ///< by name: all was said about what they show
  [[nodiscard]] std::size_t size() const { return labels.size(); }
  [[nodiscard]] std::size_t positives() const;
};

/// Adds what a window shows (PersonWindow::patch). A person's mirror image is a person too.
void add_example(const PersonWindow& window,
                 const cv::Mat& crop,
                 bool person,
                 PersonExamples& examples);

/// `a`, then what of `b` it does not hold: what is taught twice counts once.
[[nodiscard]] PersonExamples joined(PersonExamples a, const PersonExamples& b);

}  // namespace roadbook
