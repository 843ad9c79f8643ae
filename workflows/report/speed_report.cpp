#include "workflows/report/speed_report.hpp"

#include "base/format.hpp"
#include "exchange/layers/path_layers.hpp"
#include "exchange/layers/speed_layers.hpp"

namespace roadbook {

std::optional<SpeedReport> collect_speeds(const MapLayers& layers) {
  SpeedReport report;
  report.speed = colour_picture(layers, "speed_colours");
  report.friction = colour_picture(layers, "friction_colours");
  if (!report.speed && !report.friction) return std::nullopt;
  if (const auto speeds = read_speed_layers(layers)) {
    report.min_speed = speeds->options.min_speed;
    report.max_speed = speeds->options.max_speed;
    report.coverage = speeds->coverage();
    report.date_utc = utc_text(speeds->date_ns);
    report.sessions = speeds->sessions;
    report.profiles = speeds->profiles;
    report.stale = layers.has("lane_paths") && !speeds_fit(layers, read_path_layers(layers));
    for (const auto& row : layers.read_table("layer_ages").rows)
      report.ages.push_back({std::get<std::string>(row[0]), std::get<std::string>(row[1]),
                             std::get<std::string>(row[2]), fixed(std::get<double>(row[4]), 2),
                             std::get<std::int64_t>(row[5]) != 0 ? "stale" : "fresh"});
  }
  if (report.friction) {
    const PlainTable table = layers.read_table("friction_settings");
    for (std::size_t i = 0; i < table.fields.size(); ++i)
      if (table.fields[i].name == "date_ns" && !table.rows.empty())
        report.friction_date_utc = utc_text(std::get<std::int64_t>(table.rows.front()[i]));
  }
  return report;
}

}  // namespace roadbook
