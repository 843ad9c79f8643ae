#include "workflows/diagnosis/diagnosis_json.hpp"

#include <algorithm>
#include <cmath>

#include "base/format.hpp"
#include "diagnosis/inference/plausible_size.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

// Returns the number of decimal places that shows two digits of this error.
int decimal_places(double error) {
  if (!(error > 0.0) || !std::isfinite(error)) return 6;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 12);
}

ordered_json to_json(const HeldOutGain& gain) {
  return {{"per_sample", gain.per_sample},
          {"total", gain.total},
          {"interval95", {gain.low, gain.high}},
          {"interleaved_blocks", gain.interleaved}};
}

ordered_json to_json(const std::vector<FoundPlace>& places) {
  ordered_json all = ordered_json::array();
  for (const FoundPlace& p : places)
    all.push_back({{"x", p.middle.x()},
                   {"y", p.middle.y()},
                   {"z", p.middle.z()},
                   {"reach_m", p.reach_m},
                   {"landmarks", p.landmarks},
                   {"expected", p.expected},
                   {"found", p.found},
                   {"expected_sightings", p.expected_sightings},
                   {"sightings", p.sightings},
                   {"p", p.p}});
  return all;
}

ordered_json to_json(const std::vector<ChannelCheck>& before,
                     const std::vector<ChannelCheck>& after) {
  ordered_json checks = ordered_json::object();
  const auto add = [&](const char* when, const std::vector<ChannelCheck>& all) {
    for (const ChannelCheck& c : all)
      checks[c.stream][c.channel][when] = {{"rows", c.rows},
                                           {"mean_z", c.mean_z},
                                           {"scale", c.scale},
                                           {"whiteness_p", c.whiteness_p},
                                           {"kurtosis_excess", c.kurtosis_excess},
                                           {"tails_p", c.tails_p}};
  };
  add("before", before);
  add("after", after);
  return checks;
}

ordered_json to_json(const UnknownCause& u) {
  ordered_json object = {{"stream", u.stream},     {"hook", u.hook},   {"depends_on", u.depends_on},
                         {"unit", u.unit},         {"terms", u.terms}, {"p", u.p},
                         {"gain", to_json(u.gain)}};
  if (!u.inseparable.empty()) object["inseparable"] = u.inseparable;
  if (u.plot.curve.empty()) return object;
  ordered_json points = ordered_json::array();
  for (const auto& [x, y] : u.plot.curve) points.push_back({x, y});
  object["curve"] = {
      {"covariate", u.plot.covariate}, {"unit", u.plot.curve_unit}, {"points", points}};
  return object;
}

std::string to_line(const FoundPlace& p) {
  return std::to_string(p.landmarks) + " landmarks within " + fixed(p.reach_m, 1) +
         " m of x = " + fixed(p.middle.x(), 1) + ", y = " + fixed(p.middle.y(), 1) + ": " +
         std::to_string(p.found) + " found again, " + fixed(p.expected, 1) + " expected; " +
         std::to_string(p.sightings) + " sightings, " + fixed(p.expected_sightings, 0) +
         " expected";
}

}  // namespace

ordered_json to_json(const Diagnosis& d) {
  ordered_json object = {{"causes", ordered_json::array()},
                         {"unknown", ordered_json::array()},
                         {"not_observable", d.not_observable},
                         {"unexplained", d.unexplained},
                         {"notes", d.notes},
                         {"length_m", d.length_m},
                         {"samples", d.samples}};
  for (const FoundCause& c : d.causes) {
    object["causes"].push_back({{"effect", c.effect},
                                {"size", c.size},
                                {"unit", c.unit},
                                {"interval95", {c.low, c.high}},
                                {"p", c.p},
                                {"evidence", c.evidence},
                                {"gain", to_json(c.gain)},
                                {"inseparable", c.inseparable}});
    if (!c.separating.empty()) object["causes"].back()["separating_drive"] = c.separating;
    if (!c.note.empty()) object["causes"].back()["note"] = c.note;
    if (const std::string doubt = size_doubt(c); !doubt.empty())
      object["causes"].back()["doubt"] = doubt;
    if (!c.session.empty()) object["causes"].back()["session"] = c.session;
    if (!c.places.empty()) object["causes"].back()["places"] = to_json(c.places);
  }
  for (const UnknownCause& u : d.unknown) object["unknown"].push_back(to_json(u));
  object["checks"] = to_json(d.before, d.after);
  return object;
}

ordered_json advice_json(const Diagnosis& d, const std::optional<StatedVehicle>& stated) {
  const auto error = [](const std::optional<ReckoningError>& e) {
    return e ? ordered_json{{"over_s", e->over_s},
                            {"pieces", e->pieces},
                            {"position_m", e->position_m},
                            {"heading_rad", e->heading_rad}}
             : ordered_json();
  };
  ordered_json object = {{"faults", ordered_json::array()},
                         {"reckoning_before", error(d.reckoned_before)},
                         {"reckoning_after", error(d.reckoned_after)},
                         {"fine", checked_and_fine(d, stated)}};
  const std::vector<Advice> all = advice_of(d, stated);
  for (std::size_t i = 0; i < all.size(); ++i)
    object["faults"].push_back({{"effect", all[i].effect},
                                {"fault", all[i].fault},
                                {"size", all[i].size},
                                {"certainty", all[i].certainty},
                                {"action", all[i].action},
                                {"of_place", all[i].of_place},
                                {"reckoning_without", error(d.causes[i].reckoned_without)}});
  return object;
}

ordered_json comparison_json(const Diagnosis& d) {
  ordered_json all = ordered_json::array();
  for (const StreamComparison& c : d.simulated) {
    const auto simulated = [](const SampleDifference& s) {
      return ordered_json{{"mean", s.second.mean},
                          {"sigma", s.second.sigma},
                          {"distance", s.distance},
                          {"p", s.p},
                          {"quantiles", s.quantiles}};
    };
    all.push_back({{"stream", c.stream},
                   {"channel", c.channel},
                   {"unit", c.unit},
                   {"rows", c.rows},
                   {"mean", c.recorded.mean},
                   {"sigma", c.recorded.sigma},
                   {"stated", simulated(c.stated)},
                   {"extended", c.extended ? simulated(*c.extended) : ordered_json()}});
  }
  return all;
}

std::vector<std::string> comparison_lines(const Diagnosis& d) {
  std::vector<std::string> lines;
  for (const StreamComparison& c : d.simulated) {
    const int places = decimal_places(0.1 * std::max(c.recorded.sigma, c.stated.second.sigma));
    const auto moments = [&](double mean, double sigma) {
      return fixed(mean, places) + " +- " + fixed(sigma, places) + " " + c.unit;
    };
    lines.push_back("simulated again, " + c.stream + " " + c.channel + ": recorded " +
                    moments(c.recorded.mean, c.recorded.sigma) + "; as stated " +
                    moments(c.stated.second.mean, c.stated.second.sigma) + ", distance " +
                    fixed(c.stated.distance, 3) +
                    (c.extended ? "; with the effects found " +
                                      moments(c.extended->second.mean, c.extended->second.sigma) +
                                      ", distance " + fixed(c.extended->distance, 3)
                                : ""));
  }
  return lines;
}

std::vector<std::string> to_lines(const Diagnosis& d) {
  std::vector<std::string> lines;
  const auto say = [&](const std::string& line) { lines.push_back(line); };
  for (const FoundCause& c : d.causes) {
    const int places = decimal_places(0.5 * (c.high - c.low));
    say(c.effect + (c.session.empty() ? "" : " in " + c.session) + " = " + fixed(c.size, places) +
        (c.unit == "1" ? "" : " " + c.unit) + " (95 %: " + fixed(c.low, places) + " to " +
        fixed(c.high, places) + "), held-out gain " + fixed(c.gain.total, 1) + " nats" +
        (c.note.empty() ? "" : "; " + c.note));
    if (const std::string doubt = size_doubt(c); !doubt.empty()) say("  " + doubt);
    for (const std::string& other : c.inseparable)
      say("  not separable in this drive from " + other);
    if (!c.separating.empty()) say("  " + c.separating);
    for (const FoundPlace& p : c.places) say("  " + to_line(p));
  }
  for (const UnknownCause& u : d.unknown) {
    say("unknown: " + u.stream + "." + u.hook + " depends on " + u.depends_on + ", held-out gain " +
        fixed(u.gain.total, 1) + " nats");
    for (const std::string& other : u.inseparable)
      say("  not separable in this drive from " + other);
  }
  if (d.causes.empty() && d.unknown.empty()) say("nothing found");
  for (const std::string& u : d.unexplained) say("unexplained: " + u);
  for (const std::string& name : d.not_observable) say(name + " is not observable in this drive");
  for (const std::string& note : d.notes) say(note);
  return lines;
}

}  // namespace roadbook
