#include "semantics/labels/classes_in_use.hpp"

#include <gtest/gtest.h>

namespace roadbook {
namespace {

std::vector<LabelClass> classes(const std::vector<std::string>& kinds) {
  return with_kinds({}, kinds);
}

Label label(const std::string& kind) {
  Label one;
  one.kind = kind;
  return one;
}

TEST(ClassesInUse, OnlyAClassThatIsTakenAwayFromLabelsOnTheGroundIsNamed) {
  std::map<std::int64_t, Label> labels{{1, label("pond")}, {2, label("not_bay")}};
  labels[3] = label("person");
  labels[3].shape = LabelShape::kUpright;
  labels[4] = label("lane");
  labels[4].state = LabelState::kDeleted;
  labels[5] = label("pond");
  EXPECT_EQ(kinds_in_use(labels), std::vector<std::string>{"pond"});
  const auto all = classes({"bay", "lane", "person", "pond"});
  EXPECT_EQ(class_in_use(labels, all, classes({"bay"})), "pond");
  EXPECT_EQ(class_in_use(labels, all, classes({"pond"})), std::nullopt);
  EXPECT_EQ(class_in_use(labels, classes({"bay"}), {}), std::nullopt) << "it was in no list";
}

}  // namespace
}  // namespace roadbook
