#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "speedmap/property_map/slice.hpp"

namespace roadbook {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* kFormat = "roadbook-property-slice";

// Fields of an object, each missing or wrong one an error with its name.
class Reader {
 public:
  Reader(const json& object, const std::string& file) : object_(object), file_(file) {}

  [[noreturn]] void fail(const std::string& field,
                         const std::string& got,
                         const std::string& want) const {
    throw BadInput(Problem{Severity::kError, file_, 0, field, got, want});
  }
  [[nodiscard]] const json& at(const std::string& field) const {
    const auto found = object_.find(field);
    if (found == object_.end()) fail(field, "nothing", "a value");
    return *found;
  }
  [[nodiscard]] double number(const std::string& field) const {
    const json& value = at(field);
    if (!value.is_number()) fail(field, value.dump(), "a number");
    return value.get<double>();
  }
  [[nodiscard]] std::string text(const std::string& field) const {
    const json& value = at(field);
    if (!value.is_string()) fail(field, value.dump(), "a text");
    return value.get<std::string>();
  }

 private:
  const json& object_;
  const std::string& file_;
};

void read_knots(const Reader& reader, PropertySlice& slice) {
  const json& classes = reader.at("classes");
  if (!classes.is_array()) reader.fail("classes", classes.dump(), "a list of names");
  for (const json& name : classes) {
    if (!name.is_string()) reader.fail("classes", name.dump(), "names");
    slice.classes.push_back(name);
  }
  const json& knots = reader.at("knots");
  if (!knots.is_array()) reader.fail("knots", "no list", "a list");
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const std::string field = "knots[" + std::to_string(i) + "]";
    const json& row = knots[i];
    if (!row.is_array() || row.size() != 5 + slice.classes.size())
      reader.fail(field, row.dump().substr(0, 40), "s, e, mean, variance, evidence, class shares");
    for (const json& x : row)
      if (!x.is_number()) reader.fail(field, x.dump().substr(0, 40), "numbers");
    slice.knots.push_back({row[0], row[1], row[2], row[3], row[4]});
    for (std::size_t c = 5; c < row.size(); ++c) slice.shares.push_back(row[c]);
  }
}

}  // namespace

std::string slice_json(const PropertySlice& slice) {
  slice.check("");
  ordered_json object{
      {"format", kFormat},
      {"version", PropertySlice::kVersion},
      {"property", slice.property},
      {"unit", slice.unit},
      {"map", slice.source.map},
      {"date_ns", slice.source.date_ns},
      {"s_begin_m", slice.s_begin_m},
      {"s_end_m", slice.s_end_m},
      {"e_positive", "left"},
      {"kernel", "sparse: theta = 2 pi (1 - d), (theta (2 + cos theta) - 3 sin theta) / (6 pi)"},
      {"width_s_m", slice.width.s_m},
      {"width_e_m", slice.width.e_m},
      {"period_m", slice.period_m ? ordered_json(*slice.period_m) : ordered_json(nullptr)},
      {"coverage", slice.coverage()},
      {"digest", slice.digest()},
      {"classes", slice.classes},
      {"columns", {"s_m", "e_m", "mean", "variance", "evidence", "class shares"}}};
  std::string text = object.dump(1);
  text.erase(text.size() - 2);  // the closing brace: knots follow, one a line
  text += ",\n \"knots\": [";
  const std::size_t K = slice.classes.size();
  for (std::size_t i = 0; i < slice.knots.size(); ++i) {
    const SliceKnot& knot = slice.knots[i];
    json row{knot.s_m, knot.e_m, knot.mean, knot.variance, knot.evidence};
    for (std::size_t c = 0; c < K; ++c) row.push_back(slice.shares[i * K + c]);
    text += (i > 0 ? ",\n  " : "\n  ") + row.dump();
  }
  return text + "\n ]\n}\n";
}

PropertySlice parse_slice(const std::string& text, const std::string& file) {
  const json object = json::parse(text, nullptr, false);
  const Reader reader(object, file);
  if (object.is_discarded() || !object.is_object()) reader.fail("", "no JSON object", "a slice");
  if (reader.text("format") != kFormat) reader.fail("format", reader.text("format"), kFormat);
  const double version = reader.number("version");
  if (version != PropertySlice::kVersion)
    reader.fail("version", reader.at("version").dump(), std::to_string(PropertySlice::kVersion));
  PropertySlice slice;
  slice.property = reader.text("property");
  slice.unit = reader.text("unit");
  slice.source.map = reader.text("map");
  const json& date = reader.at("date_ns");
  if (!date.is_number_integer()) reader.fail("date_ns", date.dump(), "nanoseconds");
  slice.source.date_ns = date;
  slice.s_begin_m = reader.number("s_begin_m");
  slice.s_end_m = reader.number("s_end_m");
  if (reader.text("e_positive") != "left")
    reader.fail("e_positive", reader.text("e_positive"), "left");
  slice.width = {reader.number("width_s_m"), reader.number("width_e_m")};
  if (!reader.at("period_m").is_null()) slice.period_m = reader.number("period_m");
  read_knots(reader, slice);
  slice.check(file);
  if (slice.digest() != reader.text("digest"))
    reader.fail("digest", reader.text("digest"), slice.digest());
  return slice;
}

}  // namespace roadbook
