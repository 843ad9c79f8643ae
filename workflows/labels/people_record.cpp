#include "workflows/labels/people_record.hpp"

#include <nlohmann/json.hpp>

namespace roadbook {
namespace {

using Json = nlohmann::json;

Json people_round_json(const PeopleRound& r) {
  return {r.number, r.begin_ns, r.seconds, r.persons, r.nobody,    r.images,
          r.found,  r.again,    r.event,   r.basis,   r.classifier};
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
  if (json.size() == 7) return r;  // written by a program version with one search per round
  json.at(7).get_to(r.again);
  json.at(8).get_to(r.event);
  json.at(9).get_to(r.basis);
  json.at(10).get_to(r.classifier);
  return r;
}

Json named_image_json(const LabelAnchor& image, Json content) {
  return {image.session, image.t_ns, image.camera, std::move(content)};
}

LabelAnchor named_image_of(const Json& json) {
  LabelAnchor image;
  json.at(0).get_to(image.session);
  json.at(1).get_to(image.t_ns);
  json.at(2).get_to(image.camera);
  return image;
}

Json image_to_json(const SearchedImage& searched) {
  Json hypotheses = Json::array();
  for (const PersonHypothesis& h : searched.hypotheses)
    hypotheses.push_back({h.box.azimuth, h.box.foot_slope, h.box.size, h.prediction.probability,
                          h.prediction.variance});
  return named_image_json(searched.image, std::move(hypotheses));
}

SearchedImage image_from_json(const Json& json) {
  SearchedImage searched{named_image_of(json), {}};
  for (const Json& numbers : json.at(3)) {
    PersonHypothesis h;
    h.box = {searched.image.camera, numbers.at(0), numbers.at(1), numbers.at(2)};
    numbers.at(3).get_to(h.prediction.probability);
    numbers.at(4).get_to(h.prediction.variance);
    searched.hypotheses.push_back(h);
  }
  return searched;
}

Json look_json(const SecondLook& look) {
  Json boxes = Json::array();
  for (const FalseAlarm& alarm : look.alarms)
    boxes.push_back({alarm.box.azimuth, alarm.box.foot_slope, alarm.box.size});
  return named_image_json(look.image, std::move(boxes));
}

SecondLook look_of(const Json& json) {
  SecondLook look{named_image_of(json), {}};
  for (const Json& numbers : json.at(3))
    look.alarms.push_back(
        {{look.image.camera, numbers.at(0), numbers.at(1), numbers.at(2)}, std::string()});
  return look;
}

// Reads the pictures from the rows after the record's row.
bool take_pictures(const PlainTable& table, std::vector<SecondLook>& looks) {
  std::size_t row = 1;
  for (SecondLook& look : looks)
    for (FalseAlarm& alarm : look.alarms) {
      if (row >= table.rows.size()) return false;
      const auto* const png = std::get_if<Bytes>(&table.rows[row++].back());
      if (png == nullptr) return false;
      alarm.picture.assign(png->begin(), png->end());
    }
  return true;
}

}  // namespace

Json people_record_to_json(const PeopleRecord& record) {
  Json json = {{"rounds", Json::array()},
               {"images", Json::array()},
               {"next", record.next},
               {"looks", Json::array()}};
  for (const PeopleRound& round : record.rounds) json["rounds"].push_back(people_round_json(round));
  for (const SearchedImage& image : record.images) json["images"].push_back(image_to_json(image));
  for (const SecondLook& look : record.looks) json["looks"].push_back(look_json(look));
  return json;
}

PlainTable people_record_table(const PeopleRecord& record) {
  PlainTable table{kPeopleLearningTable,
                   {{"record", FieldType::kText}, {"picture", FieldType::kBytes}},
                   {{people_record_to_json(record).dump(), FieldValue()}}};
  for (const SecondLook& look : record.looks)
    for (const FalseAlarm& alarm : look.alarms)
      table.rows.push_back({FieldValue(), Bytes(alarm.picture.begin(), alarm.picture.end())});
  return table;
}

PeopleRecord people_record_from_table(const PlainTable& table) {
  PeopleRecord record;
  const auto* const text = table.rows.empty() || table.rows.front().empty()
                               ? nullptr
                               : std::get_if<std::string>(&table.rows.front().front());
  if (text == nullptr) return record;
  try {
    const Json json = Json::parse(*text);
    for (const Json& round : json.at("rounds")) record.rounds.push_back(people_round_of(round));
    for (const Json& image : json.at("images")) record.images.push_back(image_from_json(image));
    json.at("next").get_to(record.next);
    if (json.contains("looks"))
      for (const Json& look : json.at("looks")) record.looks.push_back(look_of(look));
  } catch (const Json::exception&) {
    return {};
  }
  if (!take_pictures(table, record.looks)) record.looks.clear();
  return record;
}

PeopleRecord read_people_record(const MapLayers& layers) {
  if (!layers.has(kPeopleLearningTable)) return {};
  return people_record_from_table(layers.read_table(kPeopleLearningTable));
}

}  // namespace roadbook
