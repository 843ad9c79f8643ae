#pragma once

#include <vector>

#include "diagnosis/inference/candidate.hpp"
#include "diagnosis/inference/cause_problem.hpp"
#include "diagnosis/motion/motion_fit.hpp"

namespace roadbook {

// What may be wrong about a drive's streams, as columns.

/// Candidates with their columns at a point, side by side, behind those of `front`.
struct Library {
  std::size_t front = 0;  ///< columns that stand before the candidates'
  std::vector<Candidate> candidates;
  Columns columns;
};

[[nodiscard]] bool left_out(const LibraryOptions& options, std::string_view name);

/// All that the drive's streams may show, without columns.
[[nodiscard]] std::vector<Candidate> list_candidates(const Observations& obs,
                                                     const MotionPoint& point,
                                                     const LibraryOptions& options = {});

/// Columns are built at the smoothed trajectory of the point. `front`: columns to put first.
[[nodiscard]] Library build_library(const Observations& obs,
                                    const MotionPoint& point,
                                    std::vector<Candidate> candidates,
                                    Columns front = {});

/// Columns of some candidates at another point (order of `of`).
[[nodiscard]] Columns candidate_columns(const Observations& obs,
                                        const MotionPoint& point,
                                        const std::vector<Candidate>& of);

/// How the rows of these accepted places (indices) change as their discs move and grow: two
/// columns each (`disc_columns`).
[[nodiscard]] Columns moving_discs(const Observations& obs,
                                   const MotionPoint& point,
                                   const std::vector<Accepted>& accepted,
                                   const std::vector<std::size_t>& places);

/// Whether the drive has the streams that candidate's effect shows in.
[[nodiscard]] bool has_streams(const Observations& obs, unsigned streams);

}  // namespace roadbook
