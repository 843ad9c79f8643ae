#include "workflows/labels/label_oracle_run.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/format.hpp"
#include "drive/drive.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/detector/label_oracle.hpp"
#include "workflows/labels/label_examples.hpp"
#include "workflows/labels/label_place.hpp"
#include "workflows/labels/oracle_json.hpp"
#include "workflows/people/truth_scene.hpp"

namespace roadbook {
namespace {

// Returns the session of a drive, by the digest of the drive.
int session_of_drive(const Map& map, const Drive& drive) {
  const std::string digest = drive.digest();
  for (std::size_t s = 0; s < map.sessions.size(); ++s)
    if (map.sessions[s].drive_digest == digest) return static_cast<int>(s);
  throw BadInput(Problem{Severity::kError, drive.folder().string(), 0, "drive",
                         "a drive that is not in the map",
                         "a drive from which the map was made, unchanged"});
}

// Converts an outline of four corners to a box along its longer sides.
OrientedBox box_of_outline(const Outline& outline) {
  const Eigen::Vector2d first = outline[1] - outline[0];
  const Eigen::Vector2d second = outline[2] - outline[1];
  const Eigen::Vector2d along = first.norm() >= second.norm() ? first : second;
  const Eigen::Vector2d across = first.norm() >= second.norm() ? second : first;
  OrientedBox box;
  box.centre = 0.25 * (outline[0] + outline[1] + outline[2] + outline[3]);
  box.heading = std::atan2(along.y(), along.x());
  box.length_m = along.norm();
  box.width_m = across.norm();
  return box;
}

OracleOptions oracle_run_options(const OracleRequest& request) {
  OracleOptions options;
  options.seed = options.learner.seed = request.seed;
  options.learner.search.num_threads = request.num_threads;
  options.learner.questions = request.questions;
  options.learner.negatives = request.negatives;
  if (!request.classifier.empty()) {
    options.start = examples_of_map(request.classifier, options.learner)["parking_space"];
    if (options.start.empty())
      throw BadInput(Problem{Severity::kError, request.classifier.string(), 0, "--classifier",
                             "labels of other classes", "parking_space"});
    options.first_boxes = 0;
  }
  return options;
}

}  // namespace

nlohmann::ordered_json run_oracle(const OracleRequest& request, const Messages& messages) {
  const LabelPlace place = read_label_place(request.map);
  if (!place.has_picture()) throw BadInput(no_overhead_image(request.map));
  // Check the options before reading the drive, because reading may take minutes.
  const OracleOptions options = oracle_run_options(request);
  const Map map = load_map(request.map);
  const Drive drive = Drive::open(request.drive);
  const TruthScene scene = read_truth_scene(map, session_of_drive(map, drive), request.drive, 10.0);
  std::vector<OrientedBox> truth;
  for (const Outline& outline : scene.spaces)
    if (outline.size() >= 4) truth.push_back(box_of_outline(outline));
  if (truth.empty())
    throw BadInput(Problem{Severity::kError, request.drive.string(), 0, "truth",
                           "no parking spaces", "at least one"});
  const OracleResult result = play_oracle(place.image, truth, options);
  int number = 0;
  for (const OracleRound& r : result.rounds)
    messages.say("round " + std::to_string(++number) + ": " + std::to_string(r.drawn) + " drawn, " +
                 std::to_string(r.put_right) + " corrected, " + std::to_string(r.clicks) +
                 " clicks, " + std::to_string(r.found) + " found, precision " +
                 fixed(r.precision, 3) + ", recall " + fixed(r.recall, 3) + ", " +
                 fixed(r.seconds, 1) + " s, classifier " + r.classifier);
  return {{"spaces", truth.size()},
          {"rounds", oracle_rounds_json(result.rounds)},
          {"area_under_curve", result.area_under_curve()}};
}

QuestionPolicy question_policy(const std::string& name) {
  if (name == "telling") return QuestionPolicy::kTelling;
  if (name == "uncertain") return QuestionPolicy::kUncertain;
  if (name == "random") return QuestionPolicy::kRandom;
  throw InvalidOption("--questions", name, "telling, uncertain or random");
}

NegativePolicy negative_policy(const std::string& name) {
  if (name == "random") return NegativePolicy::kRandom;
  if (name == "rejected") return NegativePolicy::kRejected;
  throw InvalidOption("--negatives", name, "random or rejected");
}

}  // namespace roadbook
