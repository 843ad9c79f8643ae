#include "diagnosis/motion/regularised_effects.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace roadbook {
namespace {

// A disc with its slip, and how far its centre and radius may be off.
void hold_places(const Observations& obs,
                 const MotionPoint& point,
                 const std::vector<Accepted>& places,
                 HeldEffects& s) {
  constexpr double kDiscMayBeOff = 1.0;  // [m]
  if (places.empty()) return;
  std::vector<Candidate> of;
  std::vector<std::size_t> all;
  for (const Accepted& a : places) {
    all.push_back(of.size());
    of.push_back(a.candidate);
  }
  s.library.columns.append(candidate_columns(obs, point, of));
  s.library.columns.append(moving_discs(obs, point, places, all));
  const Eigen::Index before = s.precision.size();
  s.precision.conservativeResize(static_cast<Eigen::Index>(s.library.columns.count()));
  s.precision.tail(s.precision.size() - before).setConstant(1.0 / (kDiscMayBeOff * kDiscMayBeOff));
  for (std::size_t k = 0; k < of.size(); ++k)
    s.precision[before + static_cast<Eigen::Index>(k)] = 1.0 / (of[k].tau * of[k].tau);
}

}  // namespace

HeldEffects saturated_library(const Observations& obs,
                              const MotionPoint& point,
                              const std::vector<Accepted>& places,
                              bool with_terms) {
  LibraryOptions options;
  options.places = false;
  options.grammar = with_terms;
  std::vector<Candidate> candidates = list_candidates(obs, point, options);
  // Leave out effects that change readings in the same way as a free effect: poses with
  // autocorrelated errors would use both. A bank is the sum of the scales of three streams.
  std::erase_if(candidates, [](const Candidate& c) {
    return c.name == kBank || c.covariate == "place" || c.covariate.ends_with("acceleration") ||
           c.covariate.ends_with("phase") || c.hook == "poses.scale" || c.hook == "steering0.time";
  });
  HeldEffects s{build_library(obs, point, std::move(candidates)), {}};
  s.precision.resize(static_cast<Eigen::Index>(s.library.columns.count()));
  for (const Candidate& c : s.library.candidates)
    for (const std::size_t column : c.columns)
      s.precision[static_cast<Eigen::Index>(column)] = 1.0 / (c.tau * c.tau);
  hold_places(obs, point, places, s);
  return s;
}

std::vector<double> saturated_weights(const Normal& normal,
                                      const HeldEffects& s,
                                      const Innovations& in) {
  Eigen::MatrixXd held = normal.F;
  held.diagonal() += s.precision;
  const Eigen::VectorXd size = held.ldlt().solve(normal.u);
  std::vector<double> weights(in.sides, 0.0);
  weights[0] = 1.0;
  for (Eigen::Index k = 0; k < size.size(); ++k)
    weights[1 + static_cast<std::size_t>(k)] = -size[k];
  return weights;
}

}  // namespace roadbook
