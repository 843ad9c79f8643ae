#pragma once

#include <functional>
#include <vector>

#include "base/progress.hpp"
#include "speedmap/presence/visit_evidence.hpp"
#include "workflows/people/people_detect.hpp"

namespace roadbook {

struct PeopleVisit {
  int visit = 0;
  PeopleScore score;  ///< detections with the examples of earlier visits, in range and in sight
  /// Of learning, after the detection; none in the last visit where no held-out visit follows.
  std::vector<PersonRound> rounds;
  std::vector<VisitFrame> frames;  ///< detections, world frame
  double find_s = 0.0;             ///< processor time per instant
  PeopleScore held_out;            ///< in the held-out visit, including this visit's examples
};

/// The detector of people over the revisits of `zurich` [metric-semantic maps, section
/// VI-B: "as we see more pedestrians, the classifier becomes increasingly good at detecting them"].
struct PeopleStudyOptions {
  bool small = false;  ///< the small place, 640 x 480
  int visits = 6;
  double step_s = 1.0;          ///< between two instants
  double max_duration_s = 1e9;  ///< of each visit
  int held_out_looks = 40;      ///< at most; the held-out visit has other people
  PeopleDetectOptions detect;
  std::uint64_t seed = 1;
  std::function<void(const PeopleVisit&)> after_visit;

  PeopleStudyOptions() { detect.batch = 8; }  // rounds cost the cube of the number of examples
};

/// Runs the study visit by visit and calls `options.after_visit` after each visit. For each visit,
/// it detects people with the earlier examples, then learns from the visit. Then it detects people
/// in the held-out visit, which is always the same: the first revisit, on a day with other people.
[[nodiscard]] std::vector<PeopleVisit> study_people(const PeopleStudyOptions& options,
                                                    const Progress& progress = {});

}  // namespace roadbook
