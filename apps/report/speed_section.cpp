#include "apps/report/speed_section.hpp"

#include <algorithm>

#include "apps/report/chart.hpp"
#include "apps/report/html.hpp"
#include "apps/report/map_pair.hpp"
#include "base/format.hpp"

namespace roadbook {
namespace {

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
         "style=\"grid-template-columns:repeat(auto-fill,minmax(min(380px,100%),1fr))\">" +
         html + "</div>\n";
}

}  // namespace

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
