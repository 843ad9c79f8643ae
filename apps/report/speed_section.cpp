#include "apps/report/speed_section.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "apps/report/chart.hpp"
#include "apps/report/html.hpp"
#include "apps/report/map_pair.hpp"
#include "apps/report/pictures.hpp"
#include "base/format.hpp"
#include "exchange/layers/path_layers.hpp"
#include "exchange/layers/speed_layers.hpp"

namespace roadbook {
namespace {

std::optional<GroundPicture> colour_picture(const MapLayers& layers, const std::string& name) {
  if (!layers.has(name)) return std::nullopt;
  const RasterInfo info = layers.raster_info(name);
  cv::Mat pixels = layers.read_raster(name, {0, 0, info.width, info.height});
  std::vector<cv::Mat> bands;
  cv::split(pixels, bands);
  std::swap(bands[0], bands[2]);  // files store red first, OpenCV blue
  cv::merge(bands, pixels);
  std::vector<unsigned char> bytes;
  cv::imencode(".png", pixels, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9});
  GroundPicture picture;
  picture.data_uri = data_uri("image/png", bytes);
  picture.place.low = {info.corner.x(), info.corner.y() - info.resolution_m * info.height};
  picture.place.high = {info.corner.x() + info.resolution_m * info.width, info.corner.y()};
  return picture;
}

// Draws the profile of a lane with its limits.
std::string profile_figure(const LaneProfile& profile, double max_speed) {
  const auto series = [&](const char* name, double LaneSpeed::*field, bool dashed) {
    ChartSeries one{name, {}, {}, dashed};
    for (const LaneSpeed& place : profile.places)
      one.points.emplace_back(place.s_m, std::min(place.*field, 1.1 * max_speed));
    return one;
  };
  return html_figure(chart_svg({"Lane " + std::to_string(profile.lane), "along the lane [m]",
                                "speed [m/s]", 0.0, 1.1 * max_speed, 420, 250},
                               {series("profile", &LaneSpeed::speed, false),
                                series("allowed by people", &LaneSpeed::pedestrian, true),
                                series("allowed by the bend", &LaneSpeed::bend, true),
                                series("allowed by grip", &LaneSpeed::grip, true)}),
                     "");
}

// Draws only the longest lanes, because a page has no room for hundreds.
std::string profile_figures(const SpeedReport& report) {
  constexpr std::size_t kMost = 6;
  std::vector<LaneProfile> longest = report.profiles;
  std::stable_sort(longest.begin(), longest.end(), [](const auto& a, const auto& b) {
    return a.places.back().s_m > b.places.back().s_m;
  });
  if (longest.size() > kMost) longest.resize(kMost);
  std::string html;
  for (const LaneProfile& profile : longest) html += profile_figure(profile, report.max_speed);
  if (html.empty()) return html;
  return "<h3>Speed profiles" +
         (report.profiles.size() > kMost ? " of the " + std::to_string(kMost) + " longest of " +
                                               std::to_string(report.profiles.size()) + " lanes"
                                         : std::string()) +
         "</h3><div class=\"pair\" "
         "style=\"grid-template-columns:repeat(auto-fill,minmax(380px,1fr))\">" +
         html + "</div>\n";
}

}  // namespace

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

std::string speed_figures(const SpeedReport& report,
                          const std::vector<std::vector<Eigen::Vector2d>>& lanes) {
  std::vector<MapPanel> panels;
  std::string caption;
  if (report.speed) {
    panels.push_back({"Speed map: recommended speed", "m/s", report.max_speed, report.min_speed,
                      &*report.speed});
    caption += "Speed: the lower of what people and grip allow. " +
               std::to_string(report.sessions.size()) + " visits, newest " +
               escaped(report.date_utc) + "; " + fixed(100.0 * report.coverage, 0) +
               " % of the places seen. ";
  }
  if (report.friction) {
    panels.push_back({"Friction map: mean friction", "", 1.0, 0.2, &*report.friction});
    caption += "Friction: newest " + escaped(report.friction_date_utc) + ".";
  }
  std::string html = html_figure(map_pair_svg(panels, lanes), caption);
  if (report.stale)
    html +=
        "<p><b>The speed map was made on other paths than the map has now: run "
        "<code>roadbook speeds</code> again.</b></p>\n";
  html += profile_figures(report);
  if (!report.ages.empty())
    html += html_table({"item", "layer", "date", "weight left", ""}, report.ages);
  return html;
}

}  // namespace roadbook
