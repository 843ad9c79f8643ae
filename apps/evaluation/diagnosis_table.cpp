#include "apps/evaluation/diagnosis_table.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>

namespace roadbook {
namespace {

std::string names_text(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
  return text;
}

// Everything that the diagnosis names.
std::string all_names(const StudiedDrive& d) {
  std::vector<std::string> names;
  for (const FoundCause& c : d.found.causes) names.push_back(c.effect);
  for (const UnknownCause& u : d.found.unknown)
    names.push_back(u.stream + "." + u.hook + "~" + u.depends_on);
  return names_text(names);
}

// Formats a number as the stream does.
std::string streamed(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace

bool is_noise_effect(const std::string& effect) {
  constexpr std::string_view kStream = "STREAM";
  const auto effects = noise_effects();
  return effect == "friction0.spatial_bias" ||
         std::any_of(effects.begin(), effects.end(), [&](const EffectInfo& e) {
           return effect.ends_with(e.name.substr(kStream.size()));
         });
}

std::string drives_csv(const std::vector<StudiedDrive>& drives) {
  std::ostringstream csv;
  csv << "effect,size,second_effect,second_size,removed,size_over_sigma,weakest_over_sigma,"
         "oracle_gain,answer,inseparable,right,found_size,low,high,held_out_gain,flags,cpu_s,"
         "reference_s,reference_m,reference_rad,white_m,names\n";
  for (const StudiedDrive& d : drives) {
    const bool pair = !d.beside.empty();
    const bool right = d.effect.empty() ? !d.raises_alarm()
                       : pair           ? d.all_named()
                       : d.removed      ? !d.unflagged()
                                        : d.in_set();
    csv << d.effect << ',' << d.size << ',' << (pair ? d.beside.begin()->first : "") << ','
        << (pair ? d.beside.begin()->second : 0.0) << ',' << d.removed << ',' << d.oracle.strength
        << ',' << (d.oracle.weakest ? streamed(*d.oracle.weakest) : "") << ',' << d.oracle.gain
        << ',' << d.answer() << ','
        << (d.found.causes.empty() ? "" : names_text(d.found.causes.front().inseparable)) << ','
        << right << ',';
    if (const FoundCause* cause = d.finding(); cause != nullptr)
      csv << cause->size << ',' << cause->low << ',' << cause->high << ',' << cause->gain.total;
    else
      csv << ",,,";
    csv << ',' << d.found.unexplained.size() << ',' << d.seconds << ',' << d.reference.time_s << ','
        << d.reference.position_m << ',' << d.reference.heading_rad << ',' << d.reference.white_m
        << ',' << all_names(d) << '\n';
  }
  return csv.str();
}

double best_power(const StudiedDrive& drive) {
  constexpr double kTwoSided = 3.72;  // of 0.005 / 25
  const double z = drive.oracle.strength - kTwoSided;
  return drive.oracle.strength > 0.0 ? 0.5 * std::erfc(-z / std::sqrt(2.0)) : 1.0;
}

bool is_strong_pair(const StudiedDrive& drive) {
  constexpr double kStrong = 8.0;
  if (drive.oracle.weakest) return *drive.oracle.weakest >= kStrong;
  return is_noise_effect(drive.effect) &&
         std::all_of(drive.beside.begin(), drive.beside.end(),
                     [](const auto& one) { return is_noise_effect(one.first); });
}

}  // namespace roadbook
