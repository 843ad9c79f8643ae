#include "apps/label_server/people_record.hpp"

#include <nlohmann/json.hpp>

namespace roadbook {
namespace {

using Json = nlohmann::json;

Json people_round_json(const PeopleRound& r) {
  return {r.number, r.begin_ns, r.seconds, r.persons, r.nobody, r.images, r.found};
}

PeopleRound people_round_of(const Json& json) {
  PeopleRound r;
  json.at(0).get_to(r.number);
  json.at(1).get_to(r.begin_ns);
  json.at(2).get_to(r.seconds);
  json.at(3).get_to(r.persons);
  json.at(4).get_to(r.nobody);
  json.at(5).get_to(r.images);
  json.at(6).get_to(r.found);
  return r;
}

Json image_to_json(const SearchedImage& searched) {
  Json hypotheses = Json::array();
  for (const PersonHypothesis& h : searched.hypotheses)
    hypotheses.push_back({h.box.azimuth, h.box.foot_slope, h.box.size, h.prediction.probability,
                          h.prediction.variance});
  const LabelAnchor& image = searched.image;
  return {image.session, image.t_ns, image.camera, hypotheses};
}

SearchedImage image_from_json(const Json& json) {
  SearchedImage searched;
  json.at(0).get_to(searched.image.session);
  json.at(1).get_to(searched.image.t_ns);
  json.at(2).get_to(searched.image.camera);
  for (const Json& numbers : json.at(3)) {
    PersonHypothesis h;
    h.box = {searched.image.camera, numbers.at(0), numbers.at(1), numbers.at(2)};
    numbers.at(3).get_to(h.prediction.probability);
    numbers.at(4).get_to(h.prediction.variance);
    searched.hypotheses.push_back(h);
  }
  return searched;
}

}  // namespace

Json people_record_to_json(const PeopleRecord& record) {
  Json json = {{"rounds", Json::array()}, {"images", Json::array()}, {"next", record.next}};
  for (const PeopleRound& round : record.rounds) json["rounds"].push_back(people_round_json(round));
  for (const SearchedImage& image : record.images) json["images"].push_back(image_to_json(image));
  return json;
}

PlainTable people_record_table(const PeopleRecord& record) {
  return {kPeopleLearningTable,
          {{"record", FieldType::kText}},
          {{people_record_to_json(record).dump()}}};
}

PeopleRecord people_record_from_text(const std::string& text) {
  PeopleRecord record;
  try {
    const Json json = Json::parse(text);
    for (const Json& round : json.at("rounds")) record.rounds.push_back(people_round_of(round));
    for (const Json& image : json.at("images")) record.images.push_back(image_from_json(image));
    json.at("next").get_to(record.next);
  } catch (const Json::exception&) {
    return {};
  }
  return record;
}

}  // namespace roadbook
