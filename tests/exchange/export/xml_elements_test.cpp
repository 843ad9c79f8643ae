#include "exchange/export/xml_elements.hpp"

#include <gtest/gtest.h>

namespace roadbook {
namespace {

TEST(XmlElements, KeepTextsThatNeedEscapes) {
  const std::string text = "a <b> & \"c\" 'd' \xC3\xA4";
  pugi::xml_document document;
  const auto root = append_element(document, "root", {{"name", text}});
  append_text(root, "note", text);
  pugi::xml_document again;
  ASSERT_TRUE(again.load_string(xml_text(document).c_str()));
  EXPECT_EQ(again.child("root").attribute("name").value(), text);
  EXPECT_EQ(again.child("root").child("note").text().get(), text);
}

TEST(XmlElements, LeaveOutCharactersThatXmlForbids) {
  EXPECT_EQ(xml_characters("a\x01"
                           "b\tc\nd\x1F"
                           "e"),
            "ab\tc\nde");
  EXPECT_EQ(xml_characters("a\xEF\xBF\xBE"
                           "b\xEF\xBF\xBD"
                           "c"),
            "ab\xEF\xBF\xBD"
            "c");
  EXPECT_EQ(xml_characters("\xC3\xA4"), "\xC3\xA4");
  EXPECT_EQ(xml_characters("\xE4no UTF-8"), "no UTF-8");
}

TEST(XmlElements, StandOnLinesInTheOrderOfTheirGroups) {
  pugi::xml_document document;
  const auto root = append_element(document, "root");
  const auto end_of_first = append_place(root);
  const auto end_of_second = append_place(root);
  insert_line(end_of_second, "c");
  append_element(append_line(insert_line(end_of_first, "a", {{"id", "1"}}), "inner"), "same");
  insert_line(end_of_first, "b");
  EXPECT_EQ(xml_text(document),
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<root>\n"
            "  <a id=\"1\">\n"
            "    <inner><same/></inner>\n"
            "  </a>\n"
            "  <b/>\n"
            "  <c/>\n"
            "</root>\n");
}

}  // namespace
}  // namespace roadbook
