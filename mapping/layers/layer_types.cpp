#include "mapping/layers/layer_types.hpp"

#include <array>
#include <chrono>
#include <cstdio>

namespace roadbook {

const std::string& map_crs_wkt() {
  // A GeoTIFF does not store the names of datum and axes; GDAL reads it back with the names below.
  // Programs refuse to combine layers with different definitions, so all layers use these names.
  static const std::string wkt =
      R"(ENGCRS["roadbook local frame",EDATUM[""],CS[Cartesian,2],)"
      R"(AXIS["easting",east],AXIS["northing",north],LENGTHUNIT["metre",1,ID["EPSG",9001]]])";
  return wkt;
}

std::string utc_text(std::int64_t t_ns) {
  using namespace std::chrono;
  const sys_time<nanoseconds> time{nanoseconds{t_ns}};
  const auto day = floor<days>(time);
  const year_month_day date{day};
  const hh_mm_ss clock{floor<milliseconds>(time - day)};
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02u-%02uT%02d:%02d:%02d.%03dZ",
                static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                static_cast<unsigned>(date.day()), static_cast<int>(clock.hours().count()),
                static_cast<int>(clock.minutes().count()),
                static_cast<int>(clock.seconds().count()),
                static_cast<int>(clock.subseconds().count()));
  return text.data();
}

std::optional<std::size_t> VectorLayer::field(const std::string& field_name) const {
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (fields[i].name == field_name) return i;
  return std::nullopt;
}

}  // namespace roadbook
