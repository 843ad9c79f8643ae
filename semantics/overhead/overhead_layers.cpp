#include "semantics/overhead/overhead_layers.hpp"

#include <algorithm>
#include <limits>
#include <string>

namespace roadbook {
namespace {

PlainTable frame_table(const OverheadSummary& made) {
  PlainTable table{"overhead_frames",
                   {{"frame", FieldType::kInteger},
                    {"session", FieldType::kInteger},
                    {"keyframe", FieldType::kInteger},
                    {"t_ns", FieldType::kInteger},
                    {"date_utc", FieldType::kText}},
                   {}};
  std::int64_t number = 0;
  for (const OverheadFrame& frame : made.frame_list)
    table.rows.push_back({number++, std::int64_t{frame.session}, std::int64_t{frame.keyframe},
                          frame.t_ns, utc_text(frame.t_ns)});
  return table;
}

PlainTable block_table(const OverheadSummary& made) {
  PlainTable table{"overhead_blocks",
                   {{"block_column", FieldType::kInteger},
                    {"block_row", FieldType::kInteger},
                    {"frames", FieldType::kText}},
                   {}};
  for (const OverheadBlock& block : made.blocks)
    table.rows.push_back({std::int64_t{block.column}, std::int64_t{block.row}, block.frames});
  return table;
}

// One row for each session that gave frames. Values of the whole image are repeated in each row.
PlainTable source_table(const Map& map, const OverheadSummary& made) {
  PlainTable table{"overhead_sources",
                   {{"session", FieldType::kInteger},
                    {"session_name", FieldType::kText},
                    {"frames", FieldType::kInteger},
                    {"date_utc_first", FieldType::kText},
                    {"date_utc", FieldType::kText},
                    {"sigma_grey", FieldType::kReal},
                    {"covered_m2", FieldType::kReal},
                    {"coverage", FieldType::kReal},
                    {"resolution_m", FieldType::kReal}},
                   {}};
  for (std::size_t session = 0; session < map.sessions.size(); ++session) {
    std::int64_t count = 0;
    std::int64_t first = std::numeric_limits<std::int64_t>::max();
    std::int64_t last = std::numeric_limits<std::int64_t>::min();
    for (const OverheadFrame& frame : made.frame_list) {
      if (frame.session != static_cast<int>(session)) continue;
      ++count;
      first = std::min(first, frame.t_ns);
      last = std::max(last, frame.t_ns);
    }
    if (count == 0) continue;
    table.rows.push_back({static_cast<std::int64_t>(session), map.sessions[session].name, count,
                          utc_text(first), utc_text(last), made.sigma_grey, made.covered_m2,
                          made.coverage, made.resolution_m});
  }
  return table;
}

}  // namespace

void store_overhead(const Map& map, const OverheadSummary& made, MapUpdate* update) {
  update->write_raster("overhead", made.image,
                       {.description = "ground seen from above, grey; 0: not seen"});
  update->write_raster("overhead_count", made.count,
                       {.description = "images averaged in overhead; 0: not seen"});
  update->write_raster("overhead_variance", made.variance,
                       {.description = "variance of the grey values in overhead; -1: not seen"});
  update->write_table(source_table(map, made));
  update->write_table(frame_table(made));
  update->write_table(block_table(made));
  update->note("overhead", std::to_string(made.views) + " keyframes, " +
                               std::to_string(made.images_used) + " images");
}

}  // namespace roadbook
