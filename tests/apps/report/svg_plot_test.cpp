#include "apps/report/svg_plot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "apps/report/html.hpp"

namespace roadbook {
namespace {

TEST(SvgPlot, TicksAreRoundAndInside) {
  EXPECT_EQ(round_ticks(0.0, 10.0, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(round_ticks(-0.33, 0.71, 5), (std::vector<double>{0.0, 0.5}));
  for (const double tick : round_ticks(-123.4, 567.8, 8)) {
    EXPECT_GE(tick, -123.4);
    EXPECT_LE(tick, 567.8);
    EXPECT_EQ(std::fmod(tick, 100.0), 0.0);  // (567.8 + 123.4) / 8 is 86.4: the next step is 100
  }
  EXPECT_TRUE(round_ticks(1.0, 1.0, 5).empty());
}

// Returns the corners of a polyline in pixels.
std::vector<Eigen::Vector2d> drawn(const std::string& svg, const std::string& css_class) {
  std::smatch path;
  const std::regex find("<path class=\"" + css_class + "\" d=\"([^\"]*)\"");
  EXPECT_TRUE(std::regex_search(svg, path, find)) << svg;
  const std::string data = path[1];
  std::vector<Eigen::Vector2d> points;
  const std::regex number("[ML]([-0-9.]+) ([-0-9.]+)");
  for (auto it = std::sregex_iterator(data.begin(), data.end(), number);
       it != std::sregex_iterator(); ++it)
    points.emplace_back(std::stod((*it)[1]), std::stod((*it)[2]));
  return points;
}

TEST(SvgPlot, AMetreIsAsLongUpwardsAsSideways) {
  for (const auto& [width, height] : {std::pair{100.0, 10.0}, std::pair{10.0, 100.0}}) {
    PlanPlot plot({{0.0, 0.0}, {width, height}});
    plot.polyline({{0.0, 0.0}, {5.0, 0.0}, {5.0, 5.0}}, "corner");
    const auto px = drawn(plot.svg("t"), "corner");
    ASSERT_EQ(px.size(), 3U);
    // Pixels have one decimal, so each difference is accurate to 0.1.
    EXPECT_NEAR((px[1] - px[0]).norm(), (px[2] - px[1]).norm(), 0.2);
    EXPECT_GT(px[1].x(), px[0].x());  // x to the right
    EXPECT_LT(px[2].y(), px[1].y());  // y up
  }
}

TEST(SvgPlot, ALineWithoutPointsIsNotDrawn) {
  PlanPlot plot({{0.0, 0.0}, {1.0, 1.0}});
  plot.polyline({}, "nothing");
  plot.segments({}, "nothing");
  EXPECT_EQ(plot.svg("t").find("nothing"), std::string::npos);
}

TEST(SvgPlot, ForeignTextCannotLeaveItsPlace) {
  EXPECT_EQ(escaped("<b a=\"x\">&"), "&lt;b a=&quot;x&quot;&gt;&amp;");
  PlanPlot plot({{0.0, 0.0}, {1.0, 1.0}});
  plot.label({0.0, 0.0}, "</svg><script>", "note");
  EXPECT_EQ(plot.svg("</title><script>").find("<script>"), std::string::npos);
}

TEST(SvgPlot, AHistogramCountsEveryValueInsideOnce) {
  const std::string svg = histogram_svg({0.1, 0.1, 0.6, 5.0}, 0.0, 1.0, 2, "x", "n");
  std::vector<double> heights;
  const std::regex bar("<rect class=\"bar\"[^>]*height=\"([0-9.]+)\"");
  for (auto it = std::sregex_iterator(svg.begin(), svg.end(), bar); it != std::sregex_iterator();
       ++it)
    heights.push_back(std::stod((*it)[1]));
  ASSERT_EQ(heights.size(), 2U);
  EXPECT_NEAR(heights[0], 2.0 * heights[1], 0.2);
}

}  // namespace
}  // namespace roadbook
