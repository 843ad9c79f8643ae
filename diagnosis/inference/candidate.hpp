#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace roadbook {

// Candidates of the search: catalogued effects, places where one acts, and generic effects
// "injection point depends on covariate" for causes outside of the catalogue.

enum class CandidateKind { kNamed, kPlace, kGrammar };

struct Candidate {
  CandidateKind kind = CandidateKind::kNamed;
  std::string name;                  ///< "wheels0.radius"; of the grammar "wheels0.scale ~ speed"
  std::string hook;                  ///< grammar: where it acts
  std::string covariate;             ///< grammar: the quantity on which the effect depends
  bool logged = false;               ///< grammar: the covariate is a column of the log
  std::string unit;                  ///< of its size
  std::string named_mean;            ///< grammar: the name of a constant at the hook; empty: none
  bool has_mean = true;              ///< grammar: the function of the covariate has a mean
  std::size_t effect = 0;            ///< the problem's own number of it
  std::vector<std::size_t> columns;  ///< its columns, counted after the innovations' residual
  double tau = 1.0;                  ///< plausible size, standard deviation of the prior
  /// Sizes beyond are physically impossible: what needs one is not what happened.
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  /// A change of the readings with a smaller statistic is not separable from errors outside of the
  /// noise model.
  double least_statistic = 0.0;
  double penalty = 0.0;  ///< [nats] added to the penalty for the number of candidates
  double place_x = 0.0, place_y = 0.0, place_radius = 0.0;  ///< of a place [m]
  /// Of the way through it, where it lies on one; of a line that of its normal [rad].
  double place_heading = 0.0;
  bool at_known = false;  ///< of a place: where the one lies that the model knows
  std::string session{};  ///< drive of the effect, if there are several; empty: all drives
};

/// The name of the effect without the name of its drive.
[[nodiscard]] std::string shared_name(const Candidate& candidate);
/// The candidate as one of `session` alone: "wheels0.radius in tuesday".
[[nodiscard]] Candidate of_session(Candidate candidate, const std::string& session);

/// The candidate with this name; nullptr if no candidate has the name.
[[nodiscard]] const Candidate* named(const std::vector<Candidate>& all, const std::string& name);

/// Whether `names` has that name.
[[nodiscard]] bool holds(const std::vector<std::string>& names, std::string_view name);

/// "within 3.0 m of x = 12.0 m, y = -4.5 m".
[[nodiscard]] std::string place_text(const Candidate& place);

/// Causes of one place or time, which other places and times cannot predict.
[[nodiscard]] bool is_local(const Candidate& candidate);

[[nodiscard]] inline bool is_possible(const Candidate& candidate, double size) {
  return size >= candidate.lowest && size <= candidate.highest;
}

/// Penalty of a term of the grammar [nats]. With many terms, a term can fit the noise.
inline constexpr double kGrammarPenalty = 2.0;

/// Which candidates a problem lists.
struct LibraryOptions {
  bool named = true;
  bool places = true;
  bool grammar = true;
  std::vector<std::string> without;  ///< names left out ("remove a cause from the catalogue")
  /// Impossible sizes are no candidates; where they are, what contradicts itself can be said.
  bool bounds = true;
};

}  // namespace roadbook
