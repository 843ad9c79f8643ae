#include "apps/report/label_shift_section.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/report/html.hpp"
#include "apps/report/svg_plot.hpp"
#include "base/format.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostToLookAt = 60;

// Returns the factor for drawing shifts larger. The largest then has about the width of a parking
// space.
double enlargement_of(const std::vector<LabelShift>& shifts) {
  constexpr double kLongestM = 2.5;
  double factor = 1.0;
  for (const double next : {2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0})
    if (next * shift_quantile_m(shifts, 1.0) <= kLongestM) factor = next;
  return factor;
}

std::string look_at_table(const LabelReport& report) {
  const auto look = report.to_look_at();
  if (look.empty()) return "<p>None has moved farther than its covariance told.</p>";
  std::vector<HtmlRow> rows;
  for (std::size_t i = 0; i < std::min(look.size(), kMostToLookAt); ++i)
    rows.push_back({std::to_string(look[i].label.id), look[i].label.kind,
                    fixed(look[i].after.x(), 2) + ", " + fixed(look[i].after.y(), 2),
                    fixed(100.0 * look[i].metres(), 1), fixed(look[i].sigmas, 1),
                    look[i].label.who});
  std::string html = "<p>A person should look at " + std::to_string(look.size()) +
                     " labels: they moved by more than three standard deviations.</p>";
  return html + html_table({"label", "class", "now at [m]", "shift [cm]", "sigmas", "by"}, rows);
}

// Formats a value of a shift, or "-" if the value is unknown. A shift since a user last saw the
// label lacks some values.
std::string if_known(const std::optional<double>& value, double factor, int decimals) {
  return value ? fixed(factor * *value, decimals) : "-";
}

// Lists every label, the farthest first. The table is folded, because there may be thousands.
std::string shift_table(std::vector<LabelShift> shifts) {
  std::stable_sort(shifts.begin(), shifts.end(), [](const LabelShift& a, const LabelShift& b) {
    return a.metres() > b.metres();
  });
  std::vector<HtmlRow> rows;
  for (const LabelShift& shift : shifts) {
    const Eigen::Vector2d way = shift.after - shift.before;
    rows.push_back({std::to_string(shift.label.id), shift.label.kind, fixed(100.0 * way.x(), 1),
                    fixed(100.0 * way.y(), 1), if_known(shift.raised_m, 100.0, 1),
                    fixed(100.0 * shift.metres(), 1),
                    if_known(shift.turned_rad, 180.0 / std::numbers::pi, 2),
                    fixed(100.0 * shift.sigma_m, 1), fixed(shift.sigmas, 1)});
  }
  return "<details><summary>The shift of each label (" + std::to_string(rows.size()) +
         "), the farthest first</summary>" +
         html_table({"label", "class", "dx [cm]", "dy [cm]", "dz [cm]", "from above [cm]",
                     "turned [deg]", "sigma [cm]", "sigmas"},
                    rows) +
         "</details>\n";
}

ordered_json optional_json(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

}  // namespace

std::string shift_words(const LabelReport& report) {
  const auto& shifts = report.shifts.shifts;
  const std::string since = report.before.empty()
                                ? "since they were last drawn, accepted or changed"
                                : "since " + escaped(report.before);
  std::string html = "<p>" + std::to_string(shifts.size()) + " labels have moved " +
                     fixed(100.0 * mean_shift_m(shifts), 1) + " cm in the mean, " +
                     fixed(100.0 * shift_quantile_m(shifts, 0.5), 1) + " cm in the median, " +
                     fixed(100.0 * shift_quantile_m(shifts, 0.95), 1) + " cm at 95 %, " +
                     fixed(100.0 * shift_quantile_m(shifts, 1.0), 1) + " cm at most, " + since +
                     ".</p>";
  if (!report.shifts.without_anchor.empty())
    html += "<p>" + std::to_string(report.shifts.without_anchor.size()) +
            " labels hang on poses that one of the maps lacks.</p>";
  const LabelAgreement& a = report.agreement;
  if (!a.sightings.empty())
    html += "<p>" + std::to_string(a.sightings.size()) +
            " times a label was found in a further image, " + fixed(100.0 * a.median_m, 1) +
            " cm from its place in the median (" + fixed(a.median_sigmas, 1) +
            " standard deviations): " +
            (a.contradicts() ? "the poses are less sure than they say, something bends the map"
                             : "the poses bear it out") +
            ".</p>";
  return html;
}

std::string not_compared_line(const LabelReport& report) {
  const auto list = [](const std::vector<std::string>& names, const std::string& why) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text.empty() ? text : text + " (" + why + ")";
  };
  const std::string now = list(report.shifts.only_after, "not in " + report.before);
  const std::string earlier = list(report.shifts.only_before, "in " + report.before + " alone");
  if (now.empty() && earlier.empty()) return "";
  return "labels on these drives are not compared: " + now +
         (now.empty() || earlier.empty() ? "" : "; ") + earlier;
}

// Draws the earlier places below the current places, and the movement of their middles.
std::string shift_picture(const LabelReport& report) {
  std::vector<Eigen::Vector2d> all;
  for (const auto& ring : report.outlines) all.insert(all.end(), ring.begin(), ring.end());
  for (const auto& ring : report.outlines_before) all.insert(all.end(), ring.begin(), ring.end());
  PlanPlot plot(PlanBounds::around(all));
  for (const auto& ring : report.outlines_before) plot.polyline(ring, "rejected");
  for (const auto& ring : report.outlines) plot.polyline(ring, "curve");
  const double factor = enlargement_of(report.shifts.shifts);
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> arrows;
  for (const LabelShift& shift : report.shifts.shifts)
    arrows.emplace_back(shift.before, shift.before + factor * (shift.after - shift.before));
  plot.segments(arrows, "lane s1");
  std::vector<Eigen::Vector2d> look;
  for (const LabelShift& shift : report.to_look_at()) look.push_back(shift.after);
  plot.dots(look, 3.0, "joint");
  const std::string was =
      report.outlines_before.empty() ? "" : ", red where they were in " + escaped(report.before);
  return html_figure(plot.svg("labels and their shifts"),
                     "Labels where they are now" + was +
                         ". Orange: the way their middles have gone" +
                         (factor > 1.0 ? ", " + fixed(factor, 0) + " times as long" : "") +
                         ". Dots: labels a person should look at.");
}

std::string shift_tables(const LabelReport& report) {
  return look_at_table(report) + shift_table(report.shifts.shifts);
}

ordered_json shifts_json(const LabelReport& report) {
  const auto& shifts = report.shifts.shifts;
  ordered_json json = {{"since", report.before.empty() ? "last seen" : report.before},
                       {"labels", shifts.size()},
                       {"mean_m", mean_shift_m(shifts)},
                       {"median_m", shift_quantile_m(shifts, 0.5)},
                       {"p95_m", shift_quantile_m(shifts, 0.95)},
                       {"largest_m", shift_quantile_m(shifts, 1.0)},
                       {"without_pose", report.shifts.without_anchor.size()},
                       {"drives_not_in_before", report.shifts.only_after},
                       {"drives_in_before_alone", report.shifts.only_before},
                       {"each", ordered_json::array()}};
  for (const LabelShift& shift : shifts)
    json["each"].push_back({{"label", shift.label.id},
                            {"class", shift.label.kind},
                            {"dx_m", shift.after.x() - shift.before.x()},
                            {"dy_m", shift.after.y() - shift.before.y()},
                            {"dz_m", optional_json(shift.raised_m)},
                            {"distance_m", shift.metres()},
                            {"turn_rad", optional_json(shift.turned_rad)},
                            {"sigma_m", shift.sigma_m},
                            {"sigmas", shift.sigmas}});
  return json;
}

}  // namespace roadbook
