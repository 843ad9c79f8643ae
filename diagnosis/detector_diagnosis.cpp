#include "diagnosis/detector_diagnosis.hpp"

#include <cstdio>
#include <memory>

#include "diagnosis/detector/foot_position_problem.hpp"
#include "diagnosis/detector/recall_problem.hpp"
#include "diagnosis/sessions_diagnosis.hpp"

namespace roadbook {
namespace {

std::string counted(const RecallProblem& recall) {
  char text[256];
  std::snprintf(text, sizeof text,
                "detector: of %zu images searched for a person who was detected before and after, "
                "%.1f %% have a detection; people who are never detected are not counted, so the "
                "recall itself is unknown",
                recall.rows(), 100.0 * recall.found_share());
  return text;
}

}  // namespace

Diagnosis diagnose_detector(const std::vector<DriveSightings>& drives,
                            const SearchOptions& search,
                            const LibraryOptions& library,
                            const EffectSizes& known) {
  const double falls = effect_size(known, "detector", "range");
  std::vector<std::unique_ptr<FootPositionProblem>> feet;
  std::vector<std::unique_ptr<RecallProblem>> recall;
  std::vector<SessionProblem> of_feet, of_recall;
  std::vector<std::string> notes;
  for (const DriveSightings& drive : drives) {
    const auto note = [&](const std::string& text) {
      notes.push_back(drive.name.empty() ? text : drive.name + ": " + text);
    };
    for (const std::string& text : drive.readings->notes) note(text);
    const std::vector<PersonTrack> tracks = person_tracks(*drive.readings);
    feet.push_back(std::make_unique<FootPositionProblem>(*drive.readings, tracks, library));
    recall.push_back(std::make_unique<RecallProblem>(*drive.readings, tracks, library, falls));
    if (feet.back()->usable())
      of_feet.push_back({drive.name, feet.back().get()});
    else
      note(feet.back()->message());
    if (recall.back()->usable()) of_recall.push_back({drive.name, recall.back().get()});
    note(recall.back()->usable() ? counted(*recall.back()) : recall.back()->message());
  }
  Diagnosis all = diagnose_together(of_feet, search);
  add_findings(diagnose_together(of_recall, search), all);
  all.notes.insert(all.notes.end(), notes.begin(), notes.end());
  return all;
}

}  // namespace roadbook
