#include "apps/summaries/curate_summary.hpp"

#include <nlohmann/json.hpp>

#include "base/format.hpp"

namespace roadbook {

void print_curation(const Console& console, const CurateSummary& summary, bool dry_run) {
  const Curation& curation = summary.curation;
  const auto megabytes = [](std::uintmax_t bytes) {
    return fixed(static_cast<double>(bytes) * 1e-6, 1) + " MB";
  };
  console.say("landmarks: " + std::to_string(summary.landmarks_before) + " -> " +
              std::to_string(curation.kept));
  console.say("observations: " + std::to_string(summary.observations_before) + " -> " +
              std::to_string(summary.observations));
  console.say(std::to_string(curation.full_places) + " of " + std::to_string(curation.places) +
              " places keep " + std::to_string(curation.per_place) +
              " landmarks or more, the others all that they have");
  if (dry_run)
    console.say("dry run: the map is as it was");
  else
    console.say("file: " + megabytes(summary.bytes_before) + " -> " + megabytes(summary.bytes));
  console.result({{"landmarks_before", summary.landmarks_before},
                  {"landmarks", curation.kept},
                  {"observations_before", summary.observations_before},
                  {"observations", summary.observations},
                  {"places", curation.places},
                  {"full_places", curation.full_places},
                  {"per_place", curation.per_place},
                  {"bytes_before", summary.bytes_before},
                  {"bytes", summary.bytes},
                  {"dry_run", dry_run},
                  {"digest", summary.digest}});
}

}  // namespace roadbook
