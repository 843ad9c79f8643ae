#include "vo/wheels/wheel_report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

namespace roadbook {
namespace {

std::string fixed(double value, int digits) {
  std::ostringstream text;
  text.precision(digits);
  text << std::fixed << value;
  return text.str();
}

std::string span_text(std::int64_t begin_ns, std::int64_t end_ns, std::int64_t origin_ns) {
  const auto seconds = [&](std::int64_t t) {
    return fixed(std::max(0.0, static_cast<double>(t - origin_ns) * 1e-9), 1);
  };
  return "from " + seconds(begin_ns) + " to " + seconds(end_ns) + " s";
}

std::string sized(double value, int digits, const std::string& unit) {
  return fixed(std::abs(value), digits) + " " + unit + (value < 0.0 ? " less" : " more");
}

std::string of_spans(const WheelComparison& c, std::int64_t origin_ns) {
  constexpr std::size_t kNamed = 3;
  std::string text;
  for (std::size_t i = 0; i < c.doubts.size() && i < kNamed; ++i) {
    const WheelDoubt& doubt = c.doubts[i];
    text += (i > 0 ? "; " : "") + span_text(doubt.span.first, doubt.span.second, origin_ns) + " " +
            sized(doubt.turn_rad * 180.0 / std::numbers::pi, 1, "degrees") + " turn and " +
            sized(doubt.way_m, 2, "m") + " way";
  }
  text += " than the cameras see";
  if (c.doubts.size() > kNamed)
    text += "; and " + std::to_string(c.doubts.size() - kNamed) + " more such times";
  return text;
}

std::string of_all(const WheelComparison& c) {
  std::string text;
  if (c.turn_factor) text += "turns " + fixed(*c.turn_factor, 2);
  if (c.way_factor) text += (text.empty() ? "ways " : " and ways ") + fixed(*c.way_factor, 2);
  if (text.empty()) return "other motions than the cameras see";
  return text + " times what the cameras see";
}

}  // namespace

SensorDoubt describe_doubts(const WheelComparison& comparison,
                            const VoResult& sight,
                            std::int64_t origin_ns,
                            bool all) {
  SensorDoubt result;
  result.sensor = "wheels0";
  result.t_begin_ns = sight.keyframes.front().t_ns;
  result.t_end_ns = sight.keyframes.back().t_ns;
  const bool few = !comparison.doubts.empty() && comparison.doubts.size() <= 3 &&
                   comparison.doubted_rad < 0.9 * comparison.compared_rad;
  if (!comparison.doubts.empty() && (few || !all)) {
    result.t_begin_ns = comparison.doubts.front().span.first;
    result.t_end_ns = comparison.doubts.back().span.second;
    result.got = of_spans(comparison, origin_ns);
  } else {
    result.got =
        of_all(comparison) + " " + span_text(result.t_begin_ns, result.t_end_ns, origin_ns);
  }
  result.want = std::string("what the cameras see within 4 sigma; mapped without the wheels") +
                (all ? "" : " there");
  return result;
}

SensorDoubt describe_correction(const WheelCorrection& correction,
                                const WheelComparison& comparison,
                                const VoResult& sight,
                                std::int64_t origin_ns) {
  SensorDoubt result;
  result.sensor = "wheels0";
  result.t_begin_ns = sight.keyframes.front().t_ns;
  result.t_end_ns = sight.keyframes.back().t_ns;
  result.got = of_all(comparison) + " " + span_text(result.t_begin_ns, result.t_end_ns, origin_ns) +
               ", as with " + correction.text();
  result.want = "what the cameras see within 4 sigma; mapped with the wheels corrected for that";
  return result;
}

SensorDoubt describe_unknown(const std::vector<TimeSpan>& spans, std::int64_t origin_ns) {
  constexpr std::size_t kNamed = 3;
  SensorDoubt result;
  result.t_begin_ns = spans.front().first;
  result.t_end_ns = spans.back().second;
  result.got = "corners that agree with no motion ";
  for (std::size_t i = 0; i < spans.size() && i < kNamed; ++i)
    result.got += (i > 0 ? "; " : "") + span_text(spans[i].first, spans[i].second, origin_ns);
  if (spans.size() > kNamed)
    result.got += "; and " + std::to_string(spans.size() - kNamed) + " more such times";
  result.want =
      "corners that agree with wheels0 or with each other (wrong wheels, or a wrong calibration of "
      "cameras?); the wheels stay in use";
  return result;
}

SensorDoubt describe_unjudged(double known) {
  SensorDoubt result;
  result.got =
      "a motion by wheels0 that the corners or the ground contradict; the cameras alone know " +
      fixed(100.0 * known, 0) + " % of the motion, too little to judge";
  result.want = "wheels0 and cameras that agree; the wheels stay in use";
  return result;
}

}  // namespace roadbook
