#include "tests/support/map_file_document.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "semantics/labels/label_sightings.hpp"
#include "workflows/labels/label_examples.hpp"
#include "workflows/labels/learning_record.hpp"
#include "workflows/labels/people_record.hpp"

namespace roadbook {
namespace {

// The tables that the label server writes. tests/apps/manual_test.cpp compares all others with maps
// that the commands of the manual make.
TEST(MapFileDocument, HasTheColumnsOfTheTablesOfTheLabelServer) {
  const auto document = test::read_map_file_document();
  for (const PlainTable& table : {record_table({}, {}), people_record_table({}), examples_table({}),
                                  label_sightings_table({})}) {
    std::vector<std::string> names;
    std::transform(table.fields.begin(), table.fields.end(), std::back_inserter(names),
                   [](const Field& field) { return field.name; });
    ASSERT_TRUE(document.columns.contains(table.name)) << table.name;
    EXPECT_EQ(document.columns.at(table.name), names) << table.name;
  }
}

}  // namespace
}  // namespace roadbook
