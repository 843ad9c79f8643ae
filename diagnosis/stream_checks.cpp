#include "diagnosis/stream_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.hpp"
#include "diagnosis/motion/grammar.hpp"

namespace roadbook {
namespace {

[[noreturn]] void refuse(const std::string& name,
                         const std::string& field,
                         const std::string& got,
                         const std::string& want) {
  Problem problem;
  problem.file = name;
  problem.field = field;
  problem.got = got;
  problem.want = want;
  throw BadInput(problem);
}

// What falls short of a bound must not be said to reach it.
std::string rounded_down(double value) {
  const std::string text = std::to_string(value);
  return text.substr(0, text.find('.') + 2);
}

std::string rounded(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

template <typename Sample, typename Good>
void require_finite(const std::vector<Sample>& samples,
                    const std::string& name,
                    const std::string& stream,
                    const Good& good) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!std::isfinite(samples[i].t_s) || !good(samples[i]))
      refuse(name, stream + " sample " + std::to_string(i + 1), "a value that is not finite",
             "finite values");
    if (i > 0 && samples[i].t_s <= samples[i - 1].t_s)
      refuse(name, stream + " sample " + std::to_string(i + 1), "a stamp that does not increase",
             "increasing stamps");
  }
}

void check_columns(const std::vector<LoggedColumn>& columns, const std::string& name) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const LoggedColumn& column = columns[c];
    const std::string field = "column " + column.name;
    const auto same = [&](const LoggedColumn& other) { return other.name == column.name; };
    if (is_grammar_covariate(column.name) ||
        std::any_of(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(c), same))
      refuse(name, field, "a name that is already in use", "another name");
    for (std::size_t i = 0; i < column.values.size(); ++i) {
      const std::string sample = field + " sample " + std::to_string(i + 1);
      if (!std::isfinite(column.values[i]) || !std::isfinite(column.t_s[i]))
        refuse(name, sample, "a value that is not finite", "finite values");
      if (i > 0 && column.t_s[i] <= column.t_s[i - 1])
        refuse(name, sample, "a stamp that does not increase", "increasing stamps");
    }
  }
}

void note_missing(const MotionStreams& s, std::vector<std::string>& notes) {
  if (s.wheels.empty()) notes.emplace_back("wheels not diagnosed: no stream");
  if (s.wheels.empty()) notes.emplace_back("lengths (scale of the map) not diagnosed: no wheels");
  if (s.steering.empty()) notes.emplace_back("steering not diagnosed: no stream");
  if (s.gyro.empty()) notes.emplace_back("gyro not diagnosed: no stream");
}

struct StreamGap {
  double from_s = 0.0;
  double to_s = 0.0;
  friend bool operator==(const StreamGap&, const StreamGap&) = default;
};

template <typename Sample>
std::vector<StreamGap> gaps_of(const std::vector<Sample>& samples, double max_gap_s) {
  std::vector<StreamGap> gaps;
  for (std::size_t i = 1; i < samples.size(); ++i)
    if (samples[i].t_s - samples[i - 1].t_s > max_gap_s)
      gaps.push_back({samples[i - 1].t_s, samples[i].t_s});
  return gaps;
}

void note_gaps(const std::vector<StreamGap>& gaps,
               const std::string& stream,
               std::vector<std::string>& notes) {
  if (gaps.empty()) return;
  double longest = 0.0;
  for (const StreamGap& g : gaps) longest = std::max(longest, g.to_s - g.from_s);
  const std::string text =
      gaps.size() == 1 ? "1 gap in " + stream + ", of "
                       : std::to_string(gaps.size()) + " gaps in " + stream + ", the longest ";
  notes.push_back(text + rounded(longest) + " s: bridged, not filled");
}

}  // namespace

void check_duration(double duration_s, const std::string& name, const DiagnosisOptions& options) {
  constexpr double kNoDrive = 0.1;  // [s]
  if (duration_s < options.min_duration_s)
    refuse(name, "duration", rounded_down(duration_s) + " s",
           "at least " + rounded(options.min_duration_s) + " s" +
               (duration_s < kNoDrive ? " (check the unit of the stamps)" : ""));
}

void check_streams(const MotionStreams& s,
                   const std::string& name,
                   const DiagnosisOptions& options) {
  const auto require_length = [&](const char* field, double value) {
    if (!std::isfinite(value) || value <= 0.0)
      refuse(name, field, std::to_string(value), "a length above 0");
  };
  if (!s.wheels.empty()) {
    require_length("wheels0.wheel_radius_left", s.wheel_model.radius_left_m);
    require_length("wheels0.wheel_radius_right", s.wheel_model.radius_right_m);
    require_length("wheels0.track_width", s.wheel_model.track_width_m);
  }
  if (!s.steering.empty()) require_length("wheels0.wheelbase", s.wheel_model.wheelbase_m);
  require_finite(s.poses, name, "poses", [](const PoseSample& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.heading);
  });
  require_finite(s.wheels, name, "wheels0", [](const WheelSample& w) {
    return std::isfinite(w.left_rad) && std::isfinite(w.right_rad);
  });
  require_finite(s.steering, name, "steering",
                 [](const SteeringSample& x) { return std::isfinite(x.angle_rad); });
  require_finite(s.gyro, name, "imu0",
                 [](const GyroSample& g) { return std::isfinite(g.rate_rad_s); });
  check_columns(s.columns, name);
  if (s.poses.size() < 2)
    refuse(name, "poses", "none", "reference poses (needed for every diagnosis)");
  if (s.wheels.empty() && s.gyro.empty() && s.steering.empty())
    refuse(name, "streams", "poses alone", "a second stream (wheels, steering or gyro)");
  check_duration(s.poses.back().t_s - s.poses.front().t_s, name, options);
}

void check_length(double length_m, const std::string& name, const DiagnosisOptions& options) {
  if (length_m < options.min_length_m)
    refuse(name, "driven length", rounded_down(length_m) + " m",
           "at least " + rounded(options.min_length_m) + " m (a drive, not a standing car)");
}

std::vector<std::string> contradictions(const WheelModel& a,
                                        const std::string& whose_a,
                                        const WheelModel& b,
                                        const std::string& whose_b) {
  constexpr double kDiffer = 0.01;
  std::vector<std::string> lines;
  const auto compare = [&](const char* what, double in_a, double in_b) {
    if (std::abs(in_a - in_b) <= kDiffer * std::abs(in_b)) return;
    char text[200];
    std::snprintf(text, sizeof text, "contradictory calibration: %s is %.4g m %s and %.4g m %s",
                  what, in_a, whose_a.c_str(), in_b, whose_b.c_str());
    lines.emplace_back(text);
  };
  compare("radius of the left wheel", a.radius_left_m, b.radius_left_m);
  compare("radius of the right wheel", a.radius_right_m, b.radius_right_m);
  compare("track width", a.track_width_m, b.track_width_m);
  compare("wheelbase", a.wheelbase_m, b.wheelbase_m);
  return lines;
}

std::vector<std::string> stream_notes(const MotionStreams& streams,
                                      const DiagnosisOptions& options) {
  std::vector<std::string> notes;
  note_missing(streams, notes);
  const double most = options.observation.max_gap_s;
  note_gaps(gaps_of(streams.poses, most), "poses", notes);
  const std::vector<StreamGap> wheels = gaps_of(streams.wheels, most);
  note_gaps(wheels, "wheels0", notes);
  // Rows that hold wheels and steering are missing once.
  std::vector<StreamGap> steering = gaps_of(streams.steering, most);
  std::erase_if(steering, [&](const StreamGap& g) {
    return std::find(wheels.begin(), wheels.end(), g) != wheels.end();
  });
  note_gaps(steering, "steering0", notes);
  note_gaps(gaps_of(streams.gyro, most), "imu0", notes);
  static_cast<void>(column_covariates(streams.columns, streams.poses.front().t_s,
                                      streams.poses.back().t_s, &notes));
  return notes;
}

}  // namespace roadbook
