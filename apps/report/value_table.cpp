#include "apps/report/value_table.hpp"

#include "apps/report/html.hpp"
#include "apps/summaries/value_summary.hpp"

namespace roadbook {

std::string value_table(const Map& map, const std::vector<SessionValue>& values) {
  if (values.empty()) return "";
  std::vector<HtmlRow> rows;
  for (const SessionValue& value : values)
    rows.push_back({map.sessions[static_cast<std::size_t>(value.session)].name,
                    change_mm_text(value.poses), change_mm_text(value.points),
                    change_mm_text(value.landmarks),
                    value.pieces_more > 0 ? std::to_string(value.pieces_more) : "-"});
  return "<h3>What each session is worth to the others</h3>" +
         html_table({"session", "sigma of poses [mm]", "of labels [mm]", "of landmarks [mm]",
                     "pieces more without it"},
                    rows) +
         "<p>Standard deviations of positions of the other sessions, without the session and with "
         "it. All errors count as independent, so compare them with each other alone.</p>";
}

}  // namespace roadbook
