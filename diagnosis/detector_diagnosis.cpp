#include "diagnosis/detector_diagnosis.hpp"

#include <cstdio>

#include "diagnosis/foot_problem.hpp"
#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/recall_problem.hpp"

namespace roadbook {

Diagnosis diagnose_detector(const SightingReadings& readings,
                            const SearchOptions& search,
                            const LibraryOptions& library) {
  Diagnosis all;
  all.notes = readings.notes;
  const std::vector<PersonTrack> tracks = person_tracks(readings);
  const FootProblem feet(readings, tracks, library);
  if (feet.usable())
    add_findings(diagnose(feet, search), all);
  else
    all.notes.push_back(feet.message());
  const RecallProblem recall(readings, tracks, library);
  if (recall.usable()) {
    add_findings(diagnose(recall, search), all);
    char text[200];
    std::snprintf(text, sizeof text,
                  "detector: of %zu looks at people who were found before and after, %.1f %% found "
                  "them; whom it never finds leaves no trace, so that recall itself is not known",
                  recall.rows(), 100.0 * recall.found_share());
    all.notes.emplace_back(text);
  } else {
    all.notes.push_back(recall.message());
  }
  return all;
}

}  // namespace roadbook
