#include <memory>
#include <nlohmann/json.hpp>

#include "apps/drive_option.hpp"
#include "apps/label_server/http/token_file.hpp"
#include "apps/label_server/serve_labels.hpp"
#include "apps/verb.hpp"
#include "semantics/labels/label_store.hpp"
#include "workflows/labels/label_look_again.hpp"
#include "workflows/labels/label_oracle_run.hpp"
#include "workflows/labels/label_replay_run.hpp"

namespace roadbook {
namespace {

struct LabelCommand {
  LabelServerRequest server;
  std::filesystem::path token_file;
  std::filesystem::path oracle;
  std::string questions = "telling";
  std::string negatives = "random";
  std::uint64_t seed = 1;
  int port = 8765;
  bool look_again = false;
  bool replay = false;
};

nlohmann::ordered_json play(const LabelCommand& command, const Messages& messages, int threads) {
  return run_oracle(
      {command.server.map, command.oracle, question_policy(command.questions),
       negative_policy(command.negatives), command.server.classifier, command.seed, threads},
      messages);
}

ExitStatus run_label(const LabelCommand& command, Console& console, const CommonOptions& common) {
  const LabelServerRequest& place = command.server;
  if (!command.oracle.empty() || command.look_again) {
    console.result(command.oracle.empty() ? run_look_again(place.map, place.drives, console)
                                          : play(command, console, common.threads));
    return ExitStatus::kDone;
  }
  if (command.replay) {
    const auto result = run_replay(place.map, place.drives, common.threads, console);
    console.result(result);
    return result.at("same").get<bool>() ? ExitStatus::kDone : ExitStatus::kRefused;
  }
  HttpServerOptions server_options;
  server_options.port = command.port;
  if (!command.token_file.empty()) server_options.token = kept_token(command.token_file);
  HttpServer server(server_options);  // first, so that a port in use is reported at once
  const std::size_t changes = serve_labels(place, server, console);
  const std::size_t labels = read_labels(place.map).size();
  console.say(std::to_string(labels) + " labels, " + std::to_string(changes) + " changes");
  console.result({{"labels", labels}, {"changes", changes}});
  return ExitStatus::kDone;
}

void add_page_options(Options& options, LabelCommand& command) {
  options
      .add("--map,-m", &command.server.map,
           "map file, with an overhead image for labels on the ground")
      .required = true;
  add_drive_option(options, &command.server.drives);
  options.add("--port", &command.port, "port on this machine; 0: any free port").range = {0, 65535};
  options.add("--who", &command.server.who, "name of the user; default: of the system's user");
  options.add("--token-file", &command.token_file, "file that keeps the address over restarts");
}

void add_learning_options(Options& options, LabelCommand& command) {
  options.add("--oracle", &command.oracle,
              "simulated drive of the map whose truth answers, without a page");
  options.add("--look-again", &command.look_again,
              "search labels in other sessions, store anchors");
  options.add("--replay", &command.replay, "train the rounds of the page again and compare");
  options.add("--questions", &command.questions, "oracle: telling, uncertain or random");
  options.add("--classifier", &command.server.classifier,
              "another map, whose labels the detector uses");
  options.add("--negatives", &command.negatives, "oracle: negative examples: random or rejected");
  options.add("--seed", &command.seed, "oracle: seed of random numbers");
  options
      .add("--idle-s", &command.server.idle_s,
           "end when no page was open for this time [s]; 0: never")
      .range = {0.0, 1e6};
}

}  // namespace

Verb label_verb() {
  auto command = std::make_shared<LabelCommand>();
  return {"label", "serves the labelling page of a map on this machine",
          [command](Options& options) {
            add_page_options(options, *command);
            add_learning_options(options, *command);
          },
          [command](Console& console, const CommonOptions& common) {
            return run_label(*command, console, common);
          }};
}

}  // namespace roadbook
