#include "diagnosis/diagnose.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "diagnosis/grammar.hpp"
#include "diagnosis/motion_effects.hpp"
#include "diagnosis/noise_causes.hpp"

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

std::string rounded(double value) {
  std::string text = std::to_string(value);
  return text.substr(0, text.find('.') + 2);
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
      refuse(name, stream + " sample " + std::to_string(i + 1), "a stamp that does not ascend",
             "ascending stamps");
  }
}

void check_streams(const MotionStreams& s,
                   const std::string& name,
                   const DiagnosisOptions& options) {
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
  if (s.poses.size() < 2)
    refuse(name, "poses", "none", "reference poses: nothing can be said without them");
  if (s.wheels.empty() && s.gyro.empty() && s.steering.empty())
    refuse(name, "streams", "poses alone", "a second stream (wheels, steering or gyro)");
  const double duration = s.poses.back().t_s - s.poses.front().t_s;
  if (duration < options.min_duration_s)
    refuse(name, "duration", rounded(duration) + " s",
           "at least " + rounded(options.min_duration_s) + " s: nothing can be said of less");
}

double length_of(const Trajectory& t) {
  double length = 0.0;
  for (std::size_t j = 0; j + 1 < t.knots(); ++j)
    length += 0.5 * t.step_s() * std::abs(t.speed[j] + t.speed[j + 1]);
  return length;
}

void note_missing(const MotionStreams& s, Diagnosis& d) {
  if (s.wheels.empty()) d.notes.emplace_back("nothing can be said about wheels: no stream");
  if (s.steering.empty()) d.notes.emplace_back("nothing can be said about steering: no stream");
  if (s.gyro.empty()) d.notes.emplace_back("nothing can be said about the gyro: no stream");
}

template <typename Sample>
void note_gaps(const std::vector<Sample>& samples,
               const std::string& stream,
               double max_gap_s,
               Diagnosis& d) {
  std::size_t gaps = 0;
  double longest = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double gap = samples[i].t_s - samples[i - 1].t_s;
    if (gap <= max_gap_s) continue;
    ++gaps;
    longest = std::max(longest, gap);
  }
  if (gaps > 0)
    d.notes.push_back(std::to_string(gaps) + " gaps in " + stream + ", the longest " +
                      rounded(longest) + " s: bridged, not filled");
}

FoundCause found(const Verdict& v) {
  FoundCause cause;
  const Candidate& c = v.cause.candidate;
  cause.effect = c.name;
  cause.size = v.cause.size[0];
  cause.unit = declaration_of(c.name).unit;
  cause.low = cause.size - 1.96 * v.sigma;
  cause.high = cause.size + 1.96 * v.sigma;
  cause.p = v.p;
  cause.evidence = v.evidence;
  cause.gain = v.gain;
  cause.inseparable = v.inseparable;
  if (c.kind == CandidateKind::kPlace)
    cause.note = "within " + rounded(c.place_radius) + " m of x = " + rounded(c.place_x) +
                 " m, y = " + rounded(c.place_y) + " m";
  return cause;
}

// Of noise the gain is that of large samples: z^2 / 2 less what fitting one size costs, and it
// scatters by z.
FoundCause found(const NoiseCause& n) {
  FoundCause cause;
  cause.effect = n.effect;
  cause.unit = n.unit;
  cause.size = n.size;
  cause.low = n.size - 1.96 * n.sigma;
  cause.high = n.size + 1.96 * n.sigma;
  cause.p = n.p;
  cause.evidence = 0.5 * n.z * n.z;
  cause.gain.total = 0.5 * n.z * n.z - 1.0;
  cause.gain.low = cause.gain.total - 1.96 * std::abs(n.z);
  cause.gain.high = cause.gain.total + 1.96 * std::abs(n.z);
  cause.note = "noise: the gain is that of large samples";
  if (n.effect.ends_with("outliers")) cause.note += "; the share is a lower bound";
  return cause;
}

UnknownCause unknown(const Verdict& v) {
  UnknownCause cause;
  const Candidate& c = v.cause.candidate;
  const auto dot = c.hook.find('.');
  cause.stream = c.hook.substr(0, dot);
  cause.hook = c.hook.substr(dot + 1);
  cause.depends_on = c.covariate;
  cause.terms.assign(v.cause.size.begin(), v.cause.size.end());
  cause.unit = grammar_unit(c.hook);
  cause.p = v.p;
  cause.gain = v.gain;
  return cause;
}

std::vector<ChannelCheck> checks_of(const Observations& obs, const MotionModel& model) {
  Columns none;
  none.values.resize(1);
  return check_innovations(
      run_pass(obs, model.point, model.noise, none, {false, 0, &model.inflation}).innovations);
}

}  // namespace

Diagnosis diagnose(const MotionStreams& streams,
                   const std::string& name,
                   const DiagnosisOptions& options) {
  check_streams(streams, name, options);
  Diagnosis d;
  note_missing(streams, d);
  note_gaps(streams.poses, "poses", options.observation.max_gap_s, d);
  note_gaps(streams.wheels, "wheels0", options.observation.max_gap_s, d);
  note_gaps(streams.gyro, "imu0", options.observation.max_gap_s, d);
  Observations obs = observe(streams, options.observation);
  const Trajectory first = trajectory_of_poses(obs);
  d.length_m = length_of(first);
  if (d.length_m < options.min_length_m)
    refuse(name, "driven length", rounded(d.length_m) + " m",
           "at least " + rounded(options.min_length_m) +
               " m: nothing can be said about a car that stands");
  const MotionModel nominal = nominal_model(obs, options.known);
  d.before = checks_of(obs, nominal);
  const SearchResult result = search_causes(obs, nominal, options.search);
  d.after = checks_of(obs, result.model);
  d.not_observable = result.not_observable;
  d.extended = options.known;
  d.samples = obs.offsets().back();
  for (const Verdict& v : result.verdicts) {
    if (v.cause.candidate.kind == CandidateKind::kGrammar) {
      d.unknown.push_back(unknown(v));
      d.unknown.back().plot = evidence_of(obs, nominal, result.model, v.cause.candidate);
      continue;
    }
    d.causes.push_back(found(v));
    d.causes.back().plot = evidence_of(obs, nominal, result.model, v.cause.candidate);
    d.extended[d.causes.back().effect] += d.causes.back().size;
  }
  for (const NoiseCause& n : noise_causes(obs, result.model)) d.causes.push_back(found(n));
  for (const ChannelCheck& c : d.after)
    // Less than the least noise believed: nothing is left that wants a cause.
    if (c.whiteness_p < 1e-6 && c.scale > 0.8)
      d.unexplained.push_back("autocorrelation in " + c.stream + " (" + c.channel + ")");
  return d;
}

}  // namespace roadbook
