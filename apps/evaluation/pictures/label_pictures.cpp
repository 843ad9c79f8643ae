#include "apps/evaluation/pictures/label_pictures.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "apps/report/chart.hpp"
#include "base/error.hpp"
#include "base/format.hpp"
#include "base/whole_file.hpp"
#include "workflows/labels/oracle_json.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

void outline(const AnnotatedCarPark& lot,
             const OrientedBox& box,
             const cv::Scalar& colour,
             cv::Mat& canvas) {
  std::vector<cv::Point> corners;
  for (const Eigen::Vector2d& corner : box.corners()) {
    const Eigen::Vector2d p = lot.image.pixel_of(corner);
    corners.emplace_back(static_cast<int>(std::lround(p.x())),
                         static_cast<int>(std::lround(p.y())));
  }
  cv::polylines(canvas, corners, true, colour, 2, cv::LINE_AA);
}

cv::Mat picture_of(const AnnotatedCarPark& lot,
                   const std::vector<OrientedBox>& found,
                   double overlap) {
  cv::Mat canvas;
  cv::cvtColor(lot.image.grey, canvas, cv::COLOR_GRAY2BGR);
  canvas.setTo(cv::Scalar(60, 60, 60), lot.image.seen == 0);
  const auto match = match_boxes(found, lot.spaces, overlap);
  std::vector<bool> hit(lot.spaces.size(), false);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (match[i] >= 0) hit[static_cast<std::size_t>(match[i])] = true;
    outline(lot, found[i], match[i] >= 0 ? cv::Scalar(60, 200, 60) : cv::Scalar(255, 120, 0),
            canvas);
  }
  for (std::size_t t = 0; t < hit.size(); ++t)
    if (!hit[t]) outline(lot, lot.spaces[t], {0, 0, 255}, canvas);
  return canvas;
}

ChartSeries f1_by_round(const std::string& name, const std::vector<BoxScore>& rounds, bool dashed) {
  std::vector<double> values;
  for (const BoxScore& score : rounds) values.push_back(score.f1);
  ChartSeries series = series_by_number(name, values, dashed);
  for (Eigen::Vector2d& point : series.points) point.x() += 1.0;
  return series;
}

ordered_json scores_json(const std::vector<BoxScore>& rounds) {
  ordered_json list = ordered_json::array();
  for (const BoxScore& score : rounds)
    list.push_back({{"precision", score.precision}, {"recall", score.recall}, {"f1", score.f1}});
  return list;
}

OracleOptions picture_options(const EvaluateCommand& command) {
  OracleOptions options;
  options.seed = options.learner.seed = command.seed;
  options.learner.search.num_threads = command.threads;
  if (command.quick) options.rounds = 3;
  return options;
}

/// A lot with the examples of another lot and a few answers, compared with the same lot alone.
struct FewAnswers {
  OracleResult after;
  OracleResult alone;
};

FewAnswers play_few_answers(const AnnotatedCarPark& lot,
                            const BoxExamples& taught,
                            const OracleOptions& options) {
  FewAnswers few;
  few.alone = play_oracle(lot.image, lot.spaces, options);
  OracleOptions after = options;
  after.start = taught;
  after.first_boxes = 0;
  after.rounds = 3;
  few.after = play_oracle(lot.image, lot.spaces, after);
  return few;
}

void say_few_answers(const std::string& name, const FewAnswers& few, Console& console) {
  std::string line = "  with answers in " + name + ": F1";
  for (const OracleRound& r : few.after.rounds)
    line += " " + fixed(r.f1, 2) + " (" + std::to_string(r.drawn) + " drawn, " +
            std::to_string(r.clicks) + " clicks)";
  line += "; alone";
  for (const OracleRound& r : few.alone.rounds)
    line += " " + fixed(r.f1, 2) + " (" + std::to_string(r.drawn) + ", " +
            std::to_string(r.clicks) + ")";
  console.say(line);
}

}  // namespace

std::vector<LotTransfer> play_transfer(const std::vector<AnnotatedCarPark>& lots,
                                       std::size_t learnt,
                                       const std::vector<std::size_t>& judged,
                                       const OracleOptions& options,
                                       OracleResult& own,
                                       BoxExamples* taught) {
  std::vector<LotTransfer> transfers;
  std::vector<BoxLearner> searchers;
  for (const std::size_t j : judged) {
    transfers.push_back({learnt, j, {}, {}});
    searchers.emplace_back(lots[j].image, options.learner);
  }
  OracleOptions playing = options;
  playing.after_round = [&](const BoxLearner& learner) {
    if (taught != nullptr) *taught = learner.examples();
    for (std::size_t i = 0; i < judged.size(); ++i) {
      searchers[i].start_from(learner.examples());
      (void)searchers[i].learn();
      transfers[i].found = searchers[i].found();
      transfers[i].rounds.push_back(
          score_boxes(transfers[i].found, lots[judged[i]].spaces, options.same_overlap));
    }
  };
  own = play_oracle(lots[learnt].image, lots[learnt].spaces, playing);
  return transfers;
}

namespace {

// Prints, draws and returns the result on other lots after learning on one lot.
ordered_json elsewhere_json(const std::vector<AnnotatedCarPark>& lots,
                            const std::vector<LotTransfer>& transfers,
                            const EvaluateCommand& command,
                            double same_overlap,
                            std::vector<ChartSeries>& series,
                            Console& console) {
  ordered_json elsewhere = ordered_json::array();
  for (const LotTransfer& t : transfers) {
    const BoxScore& score = t.rounds.back();
    console.say("  what it taught finds in " + lots[t.judged].name + ": precision " +
                fixed(score.precision, 2) + ", recall " + fixed(score.recall, 2));
    elsewhere.push_back({{"lot", lots[t.judged].name}, {"rounds", scores_json(t.rounds)}});
    if (&t == &transfers.front()) {
      series.push_back(
          f1_by_round(lots[t.learnt].name + " -> " + lots[t.judged].name, t.rounds, true));
      cv::imwrite((command.out / ("found_" + std::to_string(t.judged + 1) + ".png")).string(),
                  picture_of(lots[t.judged], t.found, same_overlap));
    }
  }
  return elsewhere;
}

// Learns one lot in rounds and evaluates the learnt detector on the next lots.
ordered_json play_lot(const std::vector<AnnotatedCarPark>& lots,
                      std::size_t l,
                      const EvaluateCommand& command,
                      std::vector<ChartSeries>& series,
                      Console& console) {
  const OracleOptions options = picture_options(command);
  std::vector<std::size_t> others;
  for (std::size_t j = 1; j < lots.size(); ++j) others.push_back((l + j) % lots.size());
  others.resize(std::min<std::size_t>(others.size(), command.quick ? 1 : 2));
  OracleResult own;
  BoxExamples taught;
  const auto transfers = play_transfer(lots, l, others, options, own, &taught);
  const OracleRound& last = own.rounds.back();
  console.say(lots[l].name + ": " + std::to_string(lots[l].spaces.size()) + " marked, " +
              std::to_string(last.drawn) + " drawn, " + std::to_string(last.put_right) +
              " put right, " + std::to_string(last.clicks) + " clicks; precision " +
              fixed(last.precision, 2) + ", recall " + fixed(last.recall, 2));
  series.push_back(f1_by_round(lots[l].name, {own.rounds.begin(), own.rounds.end()}, false));
  const ordered_json elsewhere =
      elsewhere_json(lots, transfers, command, options.same_overlap, series, console);
  ordered_json entry{{"lot", lots[l].name},
                     {"marked", lots[l].spaces.size()},
                     {"rounds", oracle_rounds_json(own.rounds)},
                     {"elsewhere", elsewhere}};
  if (!command.quick && !transfers.empty()) {
    const AnnotatedCarPark& other = lots[transfers.back().judged];
    const FewAnswers few = play_few_answers(other, taught, options);
    say_few_answers(other.name, few, console);
    entry["few_answers"] = {{"lot", other.name},
                            {"after", oracle_rounds_json(few.after.rounds)},
                            {"alone", oracle_rounds_json(few.alone.rounds)}};
  }
  return entry;
}

}  // namespace

void evaluate_label_pictures(Console& console, const EvaluateCommand& command) {
  const std::vector<AnnotatedCarPark> lots = read_annotated_car_parks(command.data, command.quick);
  std::vector<ChartSeries> series;
  ordered_json list = ordered_json::array();
  const std::size_t most = command.repeats > 0 ? static_cast<std::size_t>(command.repeats)
                                               : (command.quick ? 1 : lots.size());
  const std::size_t learners = std::min(most, lots.size());
  for (std::size_t l = 0; l < learners; ++l)
    list.push_back(play_lot(lots, l, command, series, console));
  write_whole_file(
      command.out / "pictures.svg",
      chart_svg({"Real pictures: on the car park itself, and on another", "round", "F1", 0.0, 1.0},
                series));
  const ordered_json json{{"experiment", "labels"}, {"seed", command.seed}, {"lots", list}};
  write_whole_file(command.out / "result.json", json.dump(2) + "\n");
  console.result(json);
}

}  // namespace roadbook
