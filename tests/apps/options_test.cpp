#include "apps/options.hpp"

#include <gtest/gtest.h>

#include "apps/command_line.hpp"
#include "base/error.hpp"
#include "tests/apps/run_command.hpp"

namespace roadbook {
namespace {

struct Values {
  bool flag = false;
  int count = 7;
  double scale = 1.0;
  std::string mode = "slow";
  std::vector<std::string> names;
  std::filesystem::path file;
};

Options options_for(Values& values) {
  Options options;
  options.add("FILE", &values.file, "a file");
  options.add("--flag", &values.flag, "on");
  options.add("--count,-c", &values.count, "how many").range = {0, 10};
  options.add("--image-scale", &values.scale, "size");
  options.add("--mode", &values.mode, "how").choices = {"slow", "fast"};
  options.add("--name", &values.names, "several");
  return options;
}

TEST(Options, KeepTheirDefaultsWhereNothingIsGiven) {
  Values values;
  Options options = options_for(values);
  EXPECT_TRUE(parse_command_line("verb", "does", {}, options));
  EXPECT_EQ(values.count, 7);
  EXPECT_EQ(values.mode, "slow");
  EXPECT_FALSE(options.given("--count"));
}

TEST(Options, TakeWordsInAnyOrderAndForm) {
  Values values;
  Options options = options_for(values);
  EXPECT_TRUE(parse_command_line(
      "verb", "does",
      {"-c", "3", "a.txt", "--flag", "--image-scale=0.25", "--name", "x", "--name", "y"}, options));
  EXPECT_EQ(values.count, 3);
  EXPECT_EQ(values.file, "a.txt");
  EXPECT_TRUE(values.flag);
  EXPECT_EQ(values.scale, 0.25);
  EXPECT_EQ(values.names, (std::vector<std::string>{"x", "y"}));
}

TEST(Options, TakeNegativeNumbers) {
  Values values;
  Options options = options_for(values);
  EXPECT_TRUE(parse_command_line("verb", "does", {"--image-scale", "-0.5"}, options));
  EXPECT_EQ(values.scale, -0.5);
}

TEST(Options, RefuseWhatIsOutOfRangeByName) {
  Values values;
  Options options = options_for(values);
  try {
    parse_command_line("verb", "does", {"--count", "11"}, options);
    FAIL() << "11 was taken";
  } catch (const InvalidOption& fault) {
    EXPECT_STREQ(fault.what(), "error: --count: got '11', want a whole number from 0 to 10");
    EXPECT_EQ(fault.status(), ExitStatus::kUsage);
  }
}

TEST(Options, TheFileFillsWhatTheCommandLineLeftOut) {
  const test::ScratchFolder folder;
  test::write_text(folder.path() / "o.yaml",
                   "count: 5\nimage_scale: 0.5\nmode: fast\nflag: true\nname: [p, q]\n");
  Values values;
  Options options = options_for(values);
  parse_command_line("verb", "does", {"--count", "1"}, options);
  options.read_yaml(folder.path() / "o.yaml");
  EXPECT_EQ(values.count, 1);
  EXPECT_EQ(values.scale, 0.5);
  EXPECT_EQ(values.mode, "fast");
  EXPECT_TRUE(values.flag);
  EXPECT_EQ(values.names, (std::vector<std::string>{"p", "q"}));
}

TEST(Options, TheFileReportsAllItsFaultsWithTheirLines) {
  const test::ScratchFolder folder;
  test::write_text(folder.path() / "o.yaml", "count: 99\nmode: fats\ncuont: 1\n");
  Values values;
  Options options = options_for(values);
  try {
    options.read_yaml(folder.path() / "o.yaml");
    FAIL() << "the file was taken";
  } catch (const BadInput& fault) {
    ASSERT_EQ(fault.problems().size(), 3U);
    EXPECT_EQ(fault.problems()[0].line, 1);
    EXPECT_EQ(fault.problems()[0].field, "count");
    EXPECT_EQ(fault.problems()[1].line, 2);
    EXPECT_NE(fault.problems()[1].want.find("did you mean fast?"), std::string::npos);
    EXPECT_EQ(fault.problems()[2].field, "cuont");
  }
}

TEST(Options, RequiredOnesMayComeFromTheFile) {
  const test::ScratchFolder folder;
  test::write_text(folder.path() / "o.yaml", "output: there\n");
  std::string output;
  Options options;
  options.add("--output,-o", &output, "where to").required = true;
  EXPECT_THROW(options.check_required(), InvalidOption);
  options.read_yaml(folder.path() / "o.yaml");
  EXPECT_NO_THROW(options.check_required());
  EXPECT_EQ(output, "there");
}

}  // namespace
}  // namespace roadbook
