#include <array>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "apps/evaluate.hpp"
#include "apps/evaluation/speed_evolution.hpp"
#include "apps/report/chart.hpp"
#include "base/colour_ramp.hpp"
#include "base/format.hpp"
#include "base/whole_file.hpp"
#include "speedmap/experiments/wet_patch_study.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

constexpr int kCellPx = 5;  // a cell

cv::Scalar bgr(double part) {
  const auto rgb = colour_ramp(part);
  return {double(rgb[2]), double(rgb[1]), double(rgb[0])};
}

const std::array<cv::Scalar, kPlaceClasses>& class_colours() {
  static const std::array<cv::Scalar, kPlaceClasses> colours{
      {{150, 220, 240}, {225, 225, 225}, {200, 200, 200}, {245, 245, 245}}};
  return colours;
}

// Draws one map as in figure 10. Left: the labels with the people seen so far. Right: presence as
// colour, from dark (full speed) to yellow (least speed).
void draw_map(const SpeedEvolution& result, std::size_t map, cv::Mat left, cv::Mat right) {
  const PresenceGrid& grid = result.grid;
  const auto at = [&](const Eigen::Vector2d& p) {
    const Eigen::Vector2d px = (p - grid.low()) / grid.options().cell_m * kCellPx;
    return cv::Point(static_cast<int>(px.x()),
                     grid.rows() * kCellPx - 1 - static_cast<int>(px.y()));
  };
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const cv::Point corner = at(grid.centres()[i]) - cv::Point(kCellPx / 2, kCellPx / 2);
    const cv::Rect cell(corner, cv::Size(kCellPx, kCellPx));
    cv::rectangle(left, cell, class_colours()[static_cast<std::size_t>(grid.place_class(i))],
                  cv::FILLED);
    cv::rectangle(right, cell, bgr(result.presence[map][i]), cv::FILLED);
  }
  for (std::size_t visit = 0; visit <= map; ++visit)
    for (const Eigen::Vector2d& p : result.people[visit])
      cv::circle(left, at(p), 2, {40, 40, 220}, cv::FILLED, cv::LINE_AA);
}

void put_text(cv::Mat picture, const std::string& text, const cv::Point& at) {
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.42, {40, 40, 40}, 1, cv::LINE_AA);
}

// Draws the legend: labels below the left column, presence and speed below the right column.
void draw_legend(cv::Mat picture, int left_px, int right_px, int top) {
  int x = left_px + 4;
  for (std::size_t i = 0; i < kPlaceClasses; ++i) {
    const cv::Rect box(x, top, 14, 12);
    cv::rectangle(picture, box, class_colours()[i], cv::FILLED);
    cv::rectangle(picture, box, {150, 150, 150});
    const std::string name = to_text(static_cast<PlaceClass>(i));
    put_text(picture, name, {x + 19, top + 11});
    x += 30 + 8 * static_cast<int>(name.size());
  }
  cv::circle(picture, {left_px + 11, top + 25}, 2, {40, 40, 220}, cv::FILLED, cv::LINE_AA);
  put_text(picture, "somebody seen", {left_px + 23, top + 29});
  constexpr int kBar = 200;
  for (int i = 0; i < kBar; ++i)
    cv::line(picture, {right_px + 4 + i, top}, {right_px + 4 + i, top + 11},
             bgr(static_cast<double>(i) / kBar));
  put_text(picture, "presence 0: full speed", {right_px + 4, top + 29});
  put_text(picture, "1: least speed", {right_px + 4 + kBar - 20, top + 29});
}

cv::Mat evolution_picture(const SpeedEvolution& result) {
  const int width = result.grid.columns() * kCellPx;
  const int height = result.grid.rows() * kCellPx;
  const std::vector<std::size_t> shown = {0, 3, 6};
  cv::Mat picture((height + 26) * static_cast<int>(shown.size()) + 40, 2 * width + 12, CV_8UC3,
                  cv::Scalar(255, 255, 255));
  int top = 20;
  for (const std::size_t map : shown) {
    const std::string title = map == 0 ? "initial drive" : "with revisit " + std::to_string(map);
    cv::putText(picture, title, {4, top - 6}, cv::FONT_HERSHEY_SIMPLEX, 0.45, {40, 40, 40}, 1,
                cv::LINE_AA);
    draw_map(result, map, picture(cv::Rect(0, top, width, height)),
             picture(cv::Rect(width + 12, top, width, height)));
    top += height + 26;
  }
  draw_legend(picture, 0, width + 12, top - 12);
  return picture;
}

std::string danger_chart(const SpeedEvolution& seen, const SpeedEvolution& literal) {
  return chart_svg(
      {"Presence of people where the crossings meet the lanes, by map", "revisits in the map",
       "presence", 0.0, 1.0},
      {series_by_number("right crossing (solid: weights and evidence of absence)", seen.right,
                        false),
       series_by_number("left crossing", seen.left, false),
       series_by_number("lanes elsewhere", seen.lanes, false),
       series_by_number(
           "right crossing, dashed: the formulas as printed (all weights 1, detections alone)",
           literal.right, true),
       series_by_number("left crossing, as printed", literal.left, true)});
}

ordered_json evolution_json(const SpeedEvolution& result) {
  std::vector<std::size_t> people;
  for (const auto& visit : result.people) people.push_back(visit.size());
  return {{"places", result.grid.size()},
          {"sightings", people},
          {"right", result.right},
          {"left", result.left},
          {"lanes", result.lanes}};
}

ordered_json wet_json(const WetPatchResult& result, double quantile) {
  return {{"quantile", quantile},
          {"cases", result.cases},
          {"above_grip", static_cast<double>(result.above_grip) / result.cases},
          {"beyond_circle", static_cast<double>(result.beyond_circle) / result.cases},
          {"mean_speed_mps", result.mean_speed},
          {"mean_speed_were_friction_known_mps", result.mean_speed_known}};
}

void run_evolution(Console& console, const EvaluateCommand& command) {
  PresenceOptions presence;
  const SpeedEvolution seen = zurich_evolution(presence, {}, command.seed);
  presence.literal = true;
  const SpeedEvolution literal = zurich_evolution(presence, {}, command.seed);
  std::vector<unsigned char> png;
  cv::imencode(".png", evolution_picture(seen), png);
  write_whole_file(command.out / "figure10.png", std::string(png.begin(), png.end()));
  write_whole_file(command.out / "danger.svg", danger_chart(seen, literal));
  for (std::size_t i = 0; i < seen.right.size(); ++i)
    console.say("map " + std::to_string(i) + ": right " + fixed(seen.right[i], 3) + ", left " +
                fixed(seen.left[i], 3) + ", lanes " + fixed(seen.lanes[i], 3));

  ordered_json wet = ordered_json::array();
  WetPatchOptions options;
  options.seed = command.seed;
  options.cases = command.repeats > 0 ? command.repeats : 400;
  for (const double quantile : command.quick ? std::vector{0.05} : std::vector{0.05, 0.2, 0.5}) {
    options.quantile = quantile;
    const WetPatchResult result = wet_patch_study(options);
    wet.push_back(wet_json(result, quantile));
    console.say("wet patch, quantile " + fixed(quantile, 2) + ": too fast in " +
                std::to_string(result.above_grip) + " of " + std::to_string(result.cases) +
                " cases, mean speed " + fixed(result.mean_speed, 1) +
                " m/s (friction known: " + fixed(result.mean_speed_known, 1) + ")");
  }
  const double calm = false_calm(0.4, 0.3, 0.1, 6, 20000, command.seed);
  console.say("false calm after six visits at presence 0.4: " + fixed(100.0 * calm, 1) + " %");
  const ordered_json json{{"experiment", "speeds"},
                          {"seed", command.seed},
                          {"evolution", evolution_json(seen)},
                          {"evolution_as_printed", evolution_json(literal)},
                          {"wet_patch", wet},
                          {"false_calm", calm}};
  write_whole_file(command.out / "result.json", json.dump(2) + "\n");
  console.result(json);
}

}  // namespace

Experiment speeds_experiment() {
  return {"speeds",
          "evolution of the speed map over seven maps, wet patches (metric-semantic maps, "
          "section V-C)",
          run_evolution};
}

}  // namespace roadbook
