#include "apps/report/speed_section.hpp"

#include <opencv2/imgcodecs.hpp>

#include "apps/format.hpp"
#include "apps/report/chart.hpp"
#include "apps/report/pictures.hpp"
#include "exchange/speed_layers.hpp"

namespace roadbook {
namespace {

std::optional<GroundPicture> colour_picture(const MapLayers& layers, const std::string& name) {
  if (!layers.has(name)) return std::nullopt;
  const RasterInfo info = layers.raster_info(name);
  cv::Mat pixels = layers.read_raster(name, {0, 0, info.width, info.height});
  std::vector<cv::Mat> bands;
  cv::split(pixels, bands);
  std::swap(bands[0], bands[2]);  // files hold red first, OpenCV blue
  cv::merge(bands, pixels);
  std::vector<unsigned char> bytes;
  cv::imencode(".png", pixels, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9});
  GroundPicture picture;
  picture.data_uri = data_uri("image/png", bytes);
  picture.place.low = {info.corner.x(), info.corner.y() - info.resolution_m * info.height};
  picture.place.high = {info.corner.x() + info.resolution_m * info.width, info.corner.y()};
  return picture;
}

std::string legend(const std::string& dark, const std::string& yellow) {
  std::string svg = "<svg viewBox=\"0 0 420 14\" role=\"img\"><title>" + escaped(dark) + " to " +
                    escaped(yellow) + "</title>";
  for (int i = 0; i < 32; ++i)
    svg += "<rect x=\"" + fixed(110.0 + 6.0 * i, 0) + "\" width=\"6.5\" height=\"12\" fill=\"" +
           ramp_colour(i, 0.0, 31.0) + "\"/>";
  return svg + "<text x=\"104\" y=\"11\" text-anchor=\"end\">" + escaped(dark) +
         "</text><text x=\"308\" y=\"11\">" + escaped(yellow) + "</text></svg>";
}

std::string panel(const GroundPicture& picture,
                  const std::vector<std::vector<Eigen::Vector2d>>& lanes,
                  const std::string& title,
                  const std::string& key,
                  const std::string& caption) {
  PlanPlot plot(picture.place, 440.0, 420.0);
  plot.image(picture.data_uri, picture.place);
  for (const auto& lane : lanes) plot.polyline(lane, "edge");
  return "<figure>" + plot.svg(title) + key + "<figcaption>" + caption + "</figcaption></figure>\n";
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
  std::string html = "<div class=\"pair\">";
  if (report.speed)
    html += panel(*report.speed, lanes, "speed map",
                  legend(fixed(report.max_speed, 1) + " m/s", fixed(report.min_speed, 1) + " m/s"),
                  "Recommended speed: the lower of what people and grip allow. " +
                      std::to_string(report.sessions.size()) + " visits, newest " +
                      escaped(report.date_utc) + "; " + fixed(100.0 * report.coverage, 0) +
                      " % of the places seen.");
  if (report.friction)
    html +=
        panel(*report.friction, lanes, "friction map", legend("friction 1.0", "0.2"),
              "Friction of the ground, mean; newest " + escaped(report.friction_date_utc) + ".");
  return html + "</div>\n";
}

}  // namespace roadbook
