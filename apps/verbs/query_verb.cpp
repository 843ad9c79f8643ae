#include <memory>

#include "apps/now_option.hpp"
#include "apps/summaries/query_summary.hpp"
#include "apps/verb.hpp"
#include "base/text.hpp"

namespace roadbook {
namespace {

struct QueryCommand {
  std::filesystem::path map;
  std::string at;
  std::string lane;
  std::optional<double> s_m;
  double e_m = 0.0;
  std::string now;
};

std::vector<LanePlace> places_asked(const QueryCommand& command, const LaneStrips& strips) {
  std::vector<LanePlace> places;
  if (!command.at.empty()) {
    if (!command.lane.empty() || command.s_m)
      throw InvalidOption("--at", "--lane and --s as well", "one of both");
    const auto fields = split(command.at);
    const auto x = parse_double(fields[0]);
    const auto y = fields.size() == 2 ? parse_double(fields[1]) : std::nullopt;
    if (!x || !y) throw InvalidOption("--at", command.at, "X,Y in metres, map frame");
    for (const LaneStrips::Strip& strip : strips.strips())
      if (const PathProjection at = strip.frame.project({*x, *y}); at.inside())
        places.push_back({&strip, at.s_m, at.e_m});
    if (places.empty()) throw InvalidOption("--at", command.at, "a place in the tube of a lane");
    return places;
  }
  if (command.lane.empty() || !command.s_m)
    throw InvalidOption("--lane and --s", "not both", "both, or --at");
  for (const LaneStrips::Strip& strip : strips.strips())
    if (std::to_string(strip.lane) == command.lane)
      places.push_back({&strip, *command.s_m, command.e_m});
  if (places.empty()) throw InvalidOption("--lane", command.lane, "the id of a lane with a path");
  return places;
}

}  // namespace

Verb query_verb() {
  auto command = std::make_shared<QueryCommand>();
  return {
      "query",
      "prints speed, presence, friction, ground, occupancy and labels at a place of a lane",
      [command](Options& options) {
        options.add("--map,-m", &command->map, "map file, after `speeds`").required = true;
        options.add("--at", &command->at,
                    "X,Y [m, map frame]; answered for each lane whose tube holds it");
        options.add("--lane", &command->lane, "id of a lane");
        options.add("--s", &command->s_m, "path coordinate s [m]");
        options.add("--e", &command->e_m, "path coordinate e, positive to the left [m]").range = {
            -1e3, 1e3};
        options.add("--now", &command->now,
                    "time for which ages count (UTC); without: that of `speeds`, or of the newest "
                    "item of a layer if that is later");
      },
      [command](Console& console, const CommonOptions&) {
        const LaneQueries known(command->map, {true, now_option(command->now)});
        print_answers(console, known, places_asked(*command, known.strips()));
        return ExitStatus::kDone;
      }};
}

}  // namespace roadbook
