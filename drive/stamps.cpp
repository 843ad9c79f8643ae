#include "drive/stamps.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

namespace roadbook {
namespace {

// Intervals longer than this many medians are gaps (drive.hpp).
constexpr double kGapFactor = 2.5;
// A stamp in the next smaller or larger unit is off by 1000; honest rates by far less than this.
constexpr double kUnitFactor = 30.0;
// Beyond this the stated rate is worth a warning.
constexpr double kRateFactor = 1.5;

std::string hertz(double rate_hz) {
  std::ostringstream text;
  text << rate_hz << " Hz";
  return text.str();
}

}  // namespace

StampCheck::StampCheck(std::string file, ProblemList& problems)
    : file_(std::move(file)), problems_(problems) {}

bool StampCheck::add(std::int64_t t_ns, std::int64_t line) {
  if (!stamps_.empty() && t_ns == stamps_.back()) {
    problems_.error(file_, line, "timestamp", std::to_string(t_ns) + " again",
                    "more than " + std::to_string(stamps_.back()) + " of line " +
                        std::to_string(lines_.back()));
    return false;
  }
  if (!stamps_.empty() && t_ns < stamps_.back()) {
    if (step_.rows == 0) step_ = {file_, line, line, stamps_.back(), t_ns, 0};
    ++step_.rows;
    step_.last_line = line;
    return false;
  }
  close_step();
  stamps_.push_back(t_ns);
  lines_.push_back(line);
  return true;
}

void StampCheck::close_step() {
  if (step_.rows == 1)
    problems_.error(file_, step_.line, "timestamp", std::to_string(step_.after_ns) + " (goes back)",
                    "more than " + std::to_string(step_.before_ns) + " of line " +
                        std::to_string(lines_.back()));
  else if (step_.rows > 1)
    problems_.add_step(step_);
  step_.rows = 0;
}

StreamSummary StampCheck::finish(const std::string& stream, const StampLimits& limits) {
  close_step();
  StreamSummary summary;
  summary.name = stream;
  summary.rows = stamps_.size();
  if (stamps_.size() < 2) return summary;
  std::vector<std::int64_t> intervals;
  for (std::size_t i = 1; i < stamps_.size(); ++i) intervals.push_back(stamps_[i] - stamps_[i - 1]);
  auto sorted = intervals;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const auto median_ns = static_cast<double>(*middle);
  summary.rate_hz = 1e9 / median_ns;

  const double stated = limits.declared_rate_hz;
  const bool absurd = summary.rate_hz > limits.max_rate_hz || summary.rate_hz < limits.min_rate_hz;
  const double off =
      stated > 0.0 ? std::max(summary.rate_hz / stated, stated / summary.rate_hz) : 1.0;
  if (absurd || off > kUnitFactor) {
    const std::string unit = summary.rate_hz > limits.max_rate_hz || summary.rate_hz > stated
                                 ? "stamps in nanoseconds (these look like a larger unit)"
                                 : "stamps in nanoseconds (these look like a smaller unit)";
    problems_.error(file_, lines_.front(), "timestamp", "a rate of " + hertz(summary.rate_hz),
                    unit);
    return summary;
  }
  if (off > kRateFactor)
    problems_.warning(file_, lines_.front(), "timestamp", "a rate of " + hertz(summary.rate_hz),
                      hertz(stated) + " as rate_hz states");
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    if (static_cast<double>(intervals[i]) <= kGapFactor * median_ns) continue;
    ++summary.gaps;
    std::ostringstream got;
    got << "a gap of " << static_cast<double>(intervals[i]) * 1e-9 << " s";
    problems_.warning(file_, lines_[i + 1], "timestamp", got.str(),
                      "about " + std::to_string(std::int64_t(median_ns / 1e3)) + " us");
  }
  return summary;
}

StreamSummary summary_in_any_order(const std::string& stream, std::vector<std::int64_t> stamps) {
  StreamSummary summary;
  summary.name = stream;
  summary.rows = stamps.size();
  std::sort(stamps.begin(), stamps.end());
  stamps.erase(std::unique(stamps.begin(), stamps.end()), stamps.end());
  std::vector<std::int64_t> intervals;
  for (std::size_t i = 1; i < stamps.size(); ++i) intervals.push_back(stamps[i] - stamps[i - 1]);
  if (intervals.empty()) return summary;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  summary.rate_hz = 1e9 / static_cast<double>(*middle);
  return summary;
}

}  // namespace roadbook
