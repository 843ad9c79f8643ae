#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "diagnosis/motion_fit.hpp"

namespace roadbook {

// What might be wrong: named effects, places where the wheels slip, and the grammar "hook depends
// on covariate" for what nobody listed.

enum class CandidateKind { kNamed, kPlace, kGrammar };

struct Candidate {
  CandidateKind kind = CandidateKind::kNamed;
  std::string name;                  ///< "wheels0.radius"; of the grammar "wheels0.scale ~ speed"
  std::string hook;                  ///< grammar: where it acts
  std::string covariate;             ///< grammar: on what it depends
  std::size_t effect = 0;            ///< named: index into `motion_effects`
  std::vector<std::size_t> columns;  ///< its columns among those of the library
  double tau = 1.0;                  ///< plausible size, standard deviation of the prior
  double penalty = 0.0;              ///< [nats] beside that for the number of candidates
  double place_x = 0.0, place_y = 0.0, place_radius = 0.0;  ///< of a place [m]
};

/// All candidates with their columns at a point, side by side, behind those of `front`.
struct Library {
  std::size_t front = 0;  ///< columns that stand before the candidates'
  std::vector<Candidate> candidates;
  Columns columns;
};

struct LibraryOptions {
  bool named = true;
  bool places = true;
  bool grammar = true;
  std::vector<std::string> without;  ///< names left out ("remove a cause from the catalogue")
};

/// Columns are built at the smoothed trajectory of the point. `front`: columns to put first.
[[nodiscard]] Library build_library(const Observations& obs,
                                    const MotionPoint& point,
                                    const LibraryOptions& options = {},
                                    Columns front = {});
/// The same for given candidates.
[[nodiscard]] Library build_library(const Observations& obs,
                                    const MotionPoint& point,
                                    std::vector<Candidate> candidates,
                                    Columns front = {});

/// Discs near a place, of several sizes: where exactly do the wheels slip?
[[nodiscard]] std::vector<Candidate> places_near(const Observations& obs,
                                                 const MotionPoint& point,
                                                 const Candidate& place);

/// Columns of some candidates at another point (order of `of`).
[[nodiscard]] Columns candidate_columns(const Observations& obs,
                                        const MotionPoint& point,
                                        const std::vector<Candidate>& of);

/// Whether the drive has the streams that candidate's effect shows in.
[[nodiscard]] bool has_streams(const Observations& obs, unsigned streams);

}  // namespace roadbook
