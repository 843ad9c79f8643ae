#include "drive/checks/stamp_spans.hpp"

#include <string>

namespace roadbook {
namespace {

std::string span_text(const StampSpan& span) {
  return std::to_string(span.first_ns) + " to " + std::to_string(span.last_ns) + " ns";
}

}  // namespace

void check_spans(const std::filesystem::path& sensors,
                 std::span<const std::int64_t> frames,
                 const StampSpan& wheels,
                 const StampSpan& truth,
                 ProblemList& problems) {
  if (frames.empty() || problems.has_errors()) return;
  const StampSpan images{frames.front(), frames.back()};
  const std::string table = (sensors / "wheels0" / "data.csv").string();
  const std::string want = "the time of the images, " + span_text(images);
  if (wheels.known() && !wheels.meets(images))
    problems.error(table, 0, "timestamp", span_text(wheels), want);
  else if (wheels.known() && !wheels.covers(images))
    problems.warning(table, 0, "timestamp", span_text(wheels), want);
  if (truth.known() && !truth.meets(images))
    problems.warning((sensors / "state_groundtruth_estimate0" / "data.csv").string(), 0,
                     "timestamp", span_text(truth), want);
}

}  // namespace roadbook
