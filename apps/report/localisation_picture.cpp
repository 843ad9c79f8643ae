#include "apps/report/localisation_picture.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "apps/report/chart.hpp"
#include "apps/report/html.hpp"
#include "base/format.hpp"

namespace roadbook {
namespace {

constexpr int kWidth = 760;  // [px]
constexpr int kMargin = 20;  // [px] around the plan
constexpr int kMostHeight = 520;

struct StatusMark {
  LocalisationStatus status;
  const char* colour;
  double radius;
};
// Of Okabe and Ito, as in the charts.
constexpr std::array<StatusMark, 3> kStatusMarks{
    {{LocalisationStatus::kLocalised, "#0072b2", 2.0},
     {LocalisationStatus::kRelocalised, "#009e73", 3.0},
     {LocalisationStatus::kPredicted, "#d55e00", 3.0}}};

std::string circle(const Eigen::Vector2d& p, double radius, const char* colour) {
  return "<circle cx=\"" + fixed(p.x(), 1) + "\" cy=\"" + fixed(p.y(), 1) + "\" r=\"" +
         fixed(radius, 1) + "\" fill=\"" + colour + "\"/>\n";
}

std::string words(double x, double y, const std::string& text) {
  return "<text x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\">" + escaped(text) + "</text>\n";
}

struct Panel {
  std::string svg;
  int height_px = 0;
};

Panel plan(const LocaliseResult& result) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300);
  Eigen::Vector2d high = -low;
  const auto widen = [&](const Eigen::Vector2d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  };
  for (const Eigen::Vector2d& p : result.map_places) widen(p);
  for (const TimedFrame& frame : result.frames)
    if (frame.pose.status != LocalisationStatus::kLost)
      widen(frame.pose.T_map_vehicle.translation().head<2>());
  const Eigen::Vector2d size = (high - low).cwiseMax(1.0);
  const double scale =
      std::min((kWidth - 2.0 * kMargin) / size.x(), (kMostHeight - 2.0 * kMargin) / size.y());
  const double height = size.y() * scale + 2.0 * kMargin;
  const auto to_px = [&](const Eigen::Vector2d& p) {
    return Eigen::Vector2d(kMargin + (p.x() - low.x()) * scale,
                           height - kMargin - (p.y() - low.y()) * scale);
  };
  Panel panel;
  for (const Eigen::Vector2d& p : result.map_places) panel.svg += circle(to_px(p), 3.5, "#cccccc");
  for (const StatusMark& kind : kStatusMarks)
    for (const TimedFrame& frame : result.frames)
      if (frame.pose.status == kind.status)
        panel.svg += circle(to_px(frame.pose.T_map_vehicle.translation().head<2>()), kind.radius,
                            kind.colour);
  double x = kMargin;
  const double y = height + 12.0;
  const auto key = [&](const char* colour, const std::string& text) {
    panel.svg += circle({x, y - 4.0}, 4.0, colour) + words(x + 9.0, y, text);
    x += 30.0 + 7.0 * static_cast<double>(text.size());
  };
  key("#cccccc", "pose of the map");
  for (const StatusMark& kind : kStatusMarks) key(kind.colour, std::string(name_of(kind.status)));
  const double metres = std::pow(10.0, std::floor(std::log10(0.4 * size.maxCoeff())));
  const double end = kWidth - kMargin;
  panel.svg += "<line x1=\"" + fixed(end - metres * scale, 1) + "\" x2=\"" + fixed(end, 1) +
               "\" y1=\"" + fixed(y - 4.0, 1) + "\" y2=\"" + fixed(y - 4.0, 1) +
               "\" stroke=\"#222\" stroke-width=\"2\"/>" +
               words(end - metres * scale - 44.0, y, fixed(metres, 0) + " m");
  panel.height_px = static_cast<int>(height) + 28;
  return panel;
}

// A chart within the picture: its own element, moved down.
std::string moved_down(const std::string& svg, int y_px) {
  return "<g transform=\"translate(0 " + std::to_string(y_px) + ")\">" + svg + "</g>\n";
}

}  // namespace

std::string localisation_picture(const LocaliseResult& result) {
  ChartSeries sigma{"standard deviation against the landmarks around", {}, {}, false};
  ChartSeries error{"true error in the map", {}, {}, true};
  ChartSeries inliers{"landmarks that agree", {}, {}, false};
  double way_m = 0.0;
  const LocalisedFrame* before = nullptr;
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    const LocalisedFrame& pose = result.frames[i].pose;
    if (pose.status == LocalisationStatus::kLost) continue;
    if (before != nullptr)
      way_m += (pose.T_map_vehicle.translation() - before->T_map_vehicle.translation()).norm();
    before = &pose;
    const double variance = std::max(pose.local_covariance(0, 0), pose.local_covariance(1, 1));
    if (std::isfinite(variance)) sigma.points.emplace_back(way_m, 100.0 * std::sqrt(variance));
    if (i < result.off_m.size() && std::isfinite(result.off_m[i]))
      error.points.emplace_back(way_m, 100.0 * result.off_m[i]);
    inliers.points.emplace_back(way_m, pose.inliers);
  }
  const Panel above = plan(result);
  ChartAxes axes;
  axes.width_px = kWidth;
  axes.height_px = 240;
  axes.x_name = "driven [m]";
  axes.y_name = "[cm]";
  axes.title = "Place: standard deviation and error";
  std::vector<ChartSeries> places{sigma};
  if (!error.points.empty()) places.push_back(error);
  const int place_px = axes.height_px + 16 * static_cast<int>(places.size()) + 12;
  std::string body = above.svg + moved_down(chart_svg(axes, places), above.height_px);
  axes.y_name = "landmarks";
  axes.title = "Landmarks of the map that the frame agrees with";
  body += moved_down(chart_svg(axes, {inliers}), above.height_px + place_px);
  const std::string width = std::to_string(kWidth);
  const std::string height = std::to_string(above.height_px + place_px + axes.height_px + 28);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
         "\" viewBox=\"0 0 " + width + " " + height +
         "\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\" role=\"img\">\n"
         "<title>A drive localised in a map</title>\n"
         "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" +
         body + "</svg>\n";
}

}  // namespace roadbook
