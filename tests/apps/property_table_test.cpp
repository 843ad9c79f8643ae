#include "workflows/property_table.hpp"

#include <gtest/gtest.h>

#include "tests/apps/run_command.hpp"

namespace roadbook {
namespace {

MeasuredProperty property_in(const std::string& table) {
  MeasuredProperty property;
  property.name = property.column = "friction";
  property.unit = "-";
  property.table = table;
  property.sigma_column = "sigma";
  property.range = {0.0, 2.0};
  return property;
}

// Two sensors measure at the same time. The clock of the second sensor is 3 s late, and its
// `sensor.yaml` states this offset.
TEST(PropertyTable, StampsAreMovedByTheOffsetThatTheSensorStates) {
  const test::ScratchFolder folder;
  for (const char* sensor : {"friction0", "friction1"}) {
    std::filesystem::create_directories(folder.path() / sensor);
    test::write_text(
        folder.path() / sensor / "data.csv",
        "#timestamp [ns],friction [-],sigma [-]\n5000000000,0.8,0.1\n6000000000,0.7,0.1\n");
  }
  test::write_text(folder.path() / "friction1/sensor.yaml",
                   "sensor_type: friction\ntime_offset: -3\n");
  const auto readings = read_properties(
      folder.path(), {property_in("friction0/data.csv"), property_in("friction1/data.csv")});
  std::vector<std::pair<std::size_t, std::int64_t>> got;
  for (const PropertyReading& r : readings) got.emplace_back(r.property, r.t_ns);
  const std::vector<std::pair<std::size_t, std::int64_t>> want{
      {1, 2'000'000'000}, {1, 3'000'000'000}, {0, 5'000'000'000}, {0, 6'000'000'000}};
  EXPECT_EQ(got, want);
}

}  // namespace
}  // namespace roadbook
