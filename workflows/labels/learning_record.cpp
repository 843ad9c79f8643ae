#include "workflows/labels/learning_record.hpp"

#include <nlohmann/json.hpp>

namespace roadbook {
namespace {

using Json = nlohmann::json;

Json learning_round_json(const LearningRound& r) {
  return {{"number", r.number},
          {"kind", r.kind},
          {"begin_ns", r.begin_ns},
          {"seconds", r.seconds},
          {"positives", r.positives},
          {"negatives", r.negatives},
          {"found", r.found},
          {"fresh", r.fresh},
          {"gone", r.gone},
          {"event", r.event},
          {"basis", r.basis},
          {"classifier", r.classifier},
          {"window", {r.window_length_m, r.window_width_m}}};
}

LearningRound learning_round_of(const Json& json) {
  LearningRound r;
  json.at("number").get_to(r.number);
  json.at("kind").get_to(r.kind);
  json.at("begin_ns").get_to(r.begin_ns);
  json.at("seconds").get_to(r.seconds);
  json.at("positives").get_to(r.positives);
  json.at("negatives").get_to(r.negatives);
  json.at("found").get_to(r.found);
  json.at("fresh").get_to(r.fresh);
  json.at("gone").get_to(r.gone);
  if (!json.contains("event")) return r;
  json.at("event").get_to(r.event);
  json.at("basis").get_to(r.basis);
  json.at("classifier").get_to(r.classifier);
  json.at("window").at(0).get_to(r.window_length_m);
  json.at("window").at(1).get_to(r.window_width_m);
  return r;
}

Json hypothesis_to_json(const Hypothesis& h) {
  return {h.box.centre.x(), h.box.centre.y(),         h.box.heading,        h.box.length_m,
          h.box.width_m,    h.prediction.probability, h.prediction.variance};
}

Hypothesis hypothesis_from_json(const Json& json) {
  Hypothesis h;
  h.box.centre = {json.at(0).get<double>(), json.at(1).get<double>()};
  h.box.heading = json.at(2);
  h.box.length_m = json.at(3);
  h.box.width_m = json.at(4);
  h.prediction.probability = json.at(5);
  h.prediction.variance = json.at(6);
  return h;
}

}  // namespace

Json record_to_json(const LearningRecord& record) {
  Json json = {{"rounds", Json::array()},
               {"hypotheses", Json::array()},
               {"questions", record.questions},
               {"shift", record.shift}};
  for (const LearningRound& round : record.rounds)
    json["rounds"].push_back(learning_round_json(round));
  for (const Hypothesis& h : record.hypotheses) json["hypotheses"].push_back(hypothesis_to_json(h));
  return json;
}

PlainTable record_table(const std::string& picture, const LearningRecord& record) {
  return {kLearningTable,
          {{"picture", FieldType::kText}, {"record", FieldType::kText}},
          {{picture, record_to_json(record).dump()}}};
}

StoredLearning read_stored_learning(const MapLayers& layers) {
  StoredLearning stored;
  if (!layers.has(kLearningTable)) return stored;
  for (const auto& row : layers.read_table(kLearningTable).rows) {
    const auto* const picture = row.empty() ? nullptr : std::get_if<std::string>(&row.front());
    const auto* const record = row.empty() ? nullptr : std::get_if<std::string>(&row.back());
    if (picture != nullptr) stored.picture = *picture;
    if (record != nullptr) stored.record = *record;
  }
  return stored;
}

LearningRecord record_from_text(const std::string& text) {
  LearningRecord record;
  try {
    const Json json = Json::parse(text);
    for (const Json& round : json.at("rounds")) record.rounds.push_back(learning_round_of(round));
    for (const Json& h : json.at("hypotheses"))
      record.hypotheses.push_back(hypothesis_from_json(h));
    for (const Json& question : json.at("questions")) {
      const auto index = question.get<std::size_t>();
      if (index >= record.hypotheses.size()) return {};
      record.questions.push_back(index);
    }
    if (json.contains("shift")) json.at("shift").get_to(record.shift);  // older records lack it
  } catch (const Json::exception&) {
    return {};
  }
  return record;
}

LearningRecord record_on(const std::string& picture,
                         const std::string& learnt_on,
                         const std::string& text) {
  LearningRecord record = record_from_text(text);
  if (learnt_on == picture) return record;
  record.hypotheses.clear();
  record.questions.clear();
  return record;
}

}  // namespace roadbook
