#include <memory>
#include <nlohmann/json.hpp>

#include "apps/effect_model.hpp"
#include "apps/format.hpp"
#include "apps/report/diagnosis_page.hpp"
#include "apps/verb.hpp"
#include "apps/write_file.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/drive_streams.hpp"
#include "diagnosis/map_diagnosis.hpp"
#include "diagnosis/plain_log.hpp"
#include "diagnosis/reading_diagnosis.hpp"
#include "drive/drive.hpp"
#include "mapping/map_file.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;

struct DiagnoseCommand {
  std::filesystem::path drive;
  std::filesystem::path map;
  std::filesystem::path output;
  std::filesystem::path write_model;
  std::filesystem::path model;
  std::vector<std::string> without;
  bool list_effects = false;
};

Json to_json(const HeldOutGain& gain) {
  return {{"per_sample", gain.per_sample},
          {"total", gain.total},
          {"interval95", {gain.low, gain.high}},
          {"interleaved_blocks", gain.interleaved}};
}

Json to_json(const std::vector<ChannelCheck>& before, const std::vector<ChannelCheck>& after) {
  Json checks = Json::object();
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

Json to_json(const Diagnosis& d) {
  Json object = {{"causes", Json::array()},
                 {"unknown", Json::array()},
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
  }
  for (const UnknownCause& u : d.unknown)
    object["unknown"].push_back({{"stream", u.stream},
                                 {"hook", u.hook},
                                 {"depends_on", u.depends_on},
                                 {"unit", u.unit},
                                 {"terms", u.terms},
                                 {"p", u.p},
                                 {"gain", to_json(u.gain)}});
  object["checks"] = to_json(d.before, d.after);
  return object;
}

void list_effects(Console& console) {
  Json effects = Json::array();
  for (const EffectInfo& e : all_effects()) {
    console.say(std::string(e.name) + " [" + std::string(e.unit) +
                "]: " + std::string(e.description));
    effects.push_back({{"effect", e.name},
                       {"unit", e.unit},
                       {"plausible", e.plausible},
                       {"covariate", e.covariate},
                       {"description", e.description}});
  }
  console.result({{"effects", effects}});
}

void say(const Diagnosis& d, Console& console) {
  for (const FoundCause& c : d.causes) {
    console.say(c.effect + " = " + Json(c.size).dump() + " " + c.unit +
                " (95 %: " + Json(c.low).dump() + " to " + Json(c.high).dump() + "), gain " +
                fixed(c.gain.total, 1) + " nats held out" + (c.note.empty() ? "" : "; " + c.note));
    for (const std::string& other : c.inseparable)
      console.say("  this drive cannot tell it from " + other);
    if (!c.separating.empty()) console.say("  " + c.separating);
  }
  for (const UnknownCause& u : d.unknown)
    console.say("unknown: " + u.stream + "." + u.hook + " depends on " + u.depends_on + ", gain " +
                fixed(u.gain.total, 1) + " nats held out");
  if (d.causes.empty() && d.unknown.empty()) console.say("nothing found");
  for (const std::string& u : d.unexplained) console.say("unexplained: " + u);
  for (const std::string& name : d.not_observable)
    console.say(name + " is not observable in this drive");
  for (const std::string& note : d.notes) console.say(note);
}

struct Streams {
  PlainLog log;
  DriveReadings readings;
};

// Of a drive's folder or of a plain log's description.
Streams streams_of(const std::filesystem::path& place, Console& console) {
  if (std::filesystem::is_regular_file(place)) {
    Streams streams{read_plain_log(place), {}};
    streams.readings = streams.log.readings;
    return streams;
  }
  const Drive drive = Drive::open(place);
  console.warn(drive.warnings());
  Streams streams{{drive.name(), motion_streams(drive), {}, {}, {}}, {}};
  streams.readings = drive_readings(drive, streams.log.streams.poses);
  return streams;
}

// What moves, if anything is recorded of it, and what the other sensors read on the way.
Diagnosis diagnose_all(const Streams& streams,
                       const std::string& name,
                       const DiagnosisOptions& options) {
  const MotionStreams& s = streams.log.streams;
  const bool moves = !s.wheels.empty() || !s.steering.empty() || !s.gyro.empty();
  if (!moves && !streams.readings.empty() && s.poses.size() > 1)
    return diagnose_readings(streams.readings, options.search, options.library);
  Diagnosis all = diagnose(s, name, options);
  add_findings(diagnose_readings(streams.readings, options.search, options.library), all);
  return all;
}

Diagnosis of_streams(const DiagnoseCommand& command,
                     DiagnosisOptions options,
                     Console& console,
                     std::string& name) {
  const Streams streams = streams_of(command.drive, console);
  const PlainLog& log = streams.log;
  name = log.name;
  auto& without = options.library.without;
  without.insert(without.end(), log.without.begin(), log.without.end());
  Diagnosis diagnosis = diagnose_all(streams, command.drive.string(), options);
  diagnosis.notes.insert(diagnosis.notes.begin(), log.notes.begin(), log.notes.end());
  return diagnosis;
}

Diagnosis of_map(const DiagnoseCommand& command,
                 const DiagnosisOptions& options,
                 Console& console,
                 std::string& name) {
  const Drive drive = Drive::open(command.drive);
  console.warn(drive.warnings());
  name = drive.name();
  const Map map = load_map(command.map);
  return diagnose_through_map(map, session_of(map, drive, command.map), drive, options);
}

ExitStatus run(const DiagnoseCommand& command, Console& console) {
  if (command.list_effects) {
    list_effects(console);
    return ExitStatus::kDone;
  }
  if (command.drive.empty())
    throw InvalidOption("DRIVE", "nothing", "the folder of a drive or the YAML of a plain log");
  DiagnosisOptions options;
  if (!command.model.empty()) options.known = read_effect_model(command.model);
  options.library.without = command.without;
  options.search.progress = console.progress();
  std::string name;
  const Diagnosis diagnosis = command.map.empty() ? of_streams(command, options, console, name)
                                                  : of_map(command, options, console, name);
  if (!command.write_model.empty())
    write_file(command.write_model, effect_model_text(diagnosis.extended));
  if (!command.output.empty()) write_file(command.output, diagnosis_page(diagnosis, name));
  say(diagnosis, console);
  console.result(to_json(diagnosis));
  return ExitStatus::kDone;
}

}  // namespace

Verb diagnose_verb() {
  auto command = std::make_shared<DiagnoseCommand>();
  return {
      "diagnose", "says what the simulation gets wrong in a recorded drive",
      [command](Options& options) {
        options.add("DRIVE", &command->drive, "folder of the drive, or YAML of a plain log");
        options.add("--map,-m", &command->map, "map of the drive: its views are looked at as well");
        options.add("--output,-o", &command->output, "HTML report to write");
        options.add("--model", &command->model, "YAML file of effects that are known already");
        options.add("--write-model", &command->write_model, "keeps the extended model");
        options.add("--without", &command->without, "effect left out of the catalogue");
        options.add("--list-effects", &command->list_effects, "names, units and sizes; no drive");
      },
      [command](Console& console, const CommonOptions&) { return run(*command, console); }};
}

}  // namespace roadbook
