#include "apps/evaluation/evaluate_spm_picture.hpp"

#include <cmath>
#include <functional>

#include "apps/report/chart.hpp"
#include "base/format.hpp"
#include "speedmap/experiments/spm_run.hpp"

namespace roadbook {
namespace {

constexpr double kDriven = 200.0;  ///< [m]
constexpr double kFrom = 130.0;
constexpr double kTo = 330.0;
constexpr double kMetrePx = 4.5;  ///< a metre
constexpr double kStep = 1.0;

struct Strip {
  std::string title;
  double low, high;
  std::function<double(const PathPlace&)> value;
};

// Rows of equal colour are drawn as one bar, which reduces the file size to a tenth.
std::string strip_svg(const Strip& strip, double top_px, double half_width_m) {
  std::string svg =
      "<text x=\"8\" y=\"" + fixed(top_px - 5.0, 1) + "\">" + strip.title + "</text>\n";
  for (double e = half_width_m - 0.5 * kStep; e > -half_width_m; e -= kStep) {
    double begin = kFrom;
    std::string colour;
    for (double s = kFrom; s <= kTo; s += kStep) {
      // The strip has 20 colour steps, because the eye distinguishes no more.
      const double part =
          (strip.value({s + 0.5 * kStep, e}) - strip.low) / (strip.high - strip.low);
      const std::string now =
          s < kTo ? ramp_colour(std::round(20.0 * part) / 20.0, 0.0, 1.0) : std::string();
      if (now == colour) continue;
      if (!colour.empty())
        svg += "<path fill=\"" + colour + "\" d=\"M" + fixed(8.0 + kMetrePx * (begin - kFrom), 1) +
               " " + fixed(top_px + kMetrePx * (half_width_m - e - 0.5 * kStep), 1) + "h" +
               fixed(kMetrePx * (s - begin) + 0.2, 1) + "v" + fixed(kMetrePx * kStep + 0.2, 1) +
               "h-" + fixed(kMetrePx * (s - begin) + 0.2, 1) + "z\"/>\n";
      begin = s;
      colour = now;
    }
  }
  return svg;
}

std::string line_svg(const std::vector<PathPlace>& places,
                     double top_px,
                     double half_width_m,
                     const char* style) {
  std::string svg = "<polyline fill=\"none\" " + std::string(style) + " points=\"";
  for (const PathPlace& v : places)
    if (v.s_m >= kFrom && v.s_m <= kTo)
      svg += fixed(8.0 + kMetrePx * (v.s_m - kFrom), 1) + "," +
             fixed(top_px + kMetrePx * (half_width_m - v.e_m), 1) + " ";
  return svg + "\"/>\n";
}

std::string text_svg(double x, double y, const char* anchor, const std::string& words) {
  return "<text x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\" text-anchor=\"" + anchor +
         "\">" + words + "</text>\n";
}

// Draws the distance along the road below the last strip.
std::string axis_svg(double top_px) {
  std::string svg;
  for (double s = std::ceil(kFrom / 20.0) * 20.0; s <= kTo; s += 20.0)
    svg += "<path stroke=\"#999\" d=\"M" + fixed(8.0 + kMetrePx * (s - kFrom), 1) + " " +
           fixed(top_px, 1) + "v4\"/>" +
           text_svg(8.0 + kMetrePx * (s - kFrom), top_px + 16.0, "middle", fixed(s, 0));
  return svg + text_svg(8.0 + 0.5 * kMetrePx * (kTo - kFrom), top_px + 31.0, "middle",
                        "along the road [m]");
}

std::string legend_svg(double top_px) {
  std::string svg;
  for (int i = 0; i < 32; ++i)
    svg += "<rect x=\"" + fixed(8.0 + 6.0 * i, 1) + "\" y=\"" + fixed(top_px, 1) +
           "\" width=\"6.2\" height=\"10\" fill=\"" + ramp_colour(i, 0.0, 31.0) + "\"/>";
  return svg + text_svg(206.0, top_px + 9.0, "start",
                        "friction 1.0 (grips) to 0.4 (slips); deviation 0 to 0.3. White line: "
                        "driven; dashed: the horizon to be predicted");
}

}  // namespace

std::string spm_picture(const SpmExperimentOptions& options) {
  const SpmTruth truth = spm_truth(options, 0);
  const SpmRecord record = spm_record(options, spm_road(options), truth, 0, kDriven);
  PropertyMapper mapper(PropertyMap(truth.map.knots(), spm_prior(options, truth, 0)));
  play(record, SpmMethod{}, kDriven, mapper);
  const auto mean_of = [](const PropertyMap& map) {
    return [&map](const PathPlace& v) { return map.moments(0, v)->mean; };
  };
  const std::vector<Strip> strips = {
      {"true friction", 1.0, 0.4, mean_of(truth.map)},
      {"believed after 200 m of driving (camera sees 90 m ahead)", 1.0, 0.4, mean_of(mapper.map())},
      {"standard deviation of the next measurement", 0.0, 0.3,
       [&](const PathPlace& v) { return std::sqrt(mapper.map().moments(0, v)->variance); }}};
  std::vector<PathPlace> driven;
  for (double s = kFrom; s <= kDriven; s += 1.0) driven.push_back({s, spm_weave(options, s)});
  const double height = 2.0 * options.half_width_m * kMetrePx + 26.0;
  std::string svg;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    const double top = 22.0 + height * static_cast<double>(i);
    svg += strip_svg(strips[i], top, options.half_width_m);
    svg += line_svg(driven, top, options.half_width_m, "stroke=\"#fff\" stroke-width=\"2\"");
    svg += line_svg(spm_horizon(probe_horizon(options), kDriven), top, options.half_width_m,
                    "stroke=\"#fff\" stroke-dasharray=\"4 3\"");
  }
  const double bottom = 22.0 + height * static_cast<double>(strips.size()) - 12.0;
  const std::string size = "width=\"" + fixed(16.0 + kMetrePx * (kTo - kFrom), 0) + "\" height=\"" +
                           fixed(bottom + 60.0, 0) + "\"";
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" " + size +
         " font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\" role=\"img\">\n"
         "<title>Friction map of a stretch of road: truth and belief</title>\n"
         "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" +
         svg + axis_svg(bottom) + legend_svg(bottom + 42.0) + "</svg>\n";
}

}  // namespace roadbook
