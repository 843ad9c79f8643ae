#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/option_table.hpp"
#include "apps/verb.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook {
namespace {

using test::CommandResult;
using test::run_command;
using test::ScratchFolder;

CommandResult run(const std::string& command) {
  const ScratchFolder folder;
  return run_command(command, folder.path());
}

// Expects exactly one line on standard error, which begins with "error: ".
void expect_one_error_line(const CommandResult& result) {
  EXPECT_EQ(result.err.rfind("error: ", 0), 0U) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_EQ(result.out, "");
}

TEST(Command, HelpNamesEveryVerbAndEndsWell) {
  const auto result = run("roadbook --help");
  EXPECT_EQ(result.status, 0);
  for (const Verb& verb : all_verbs())
    EXPECT_NE(result.out.find("\n  " + verb.name + " "), std::string::npos) << verb.name;
}

TEST(Command, EveryVerbHasHelpWithItsOptions) {
  for (const Verb& verb : all_verbs()) {
    const auto result = run("roadbook " + verb.name + " --help");
    EXPECT_EQ(result.status, 0) << verb.name;
    CommonOptions common;
    const Options options = options_of(verb, common);
    for (const Option& option : options.all())
      EXPECT_NE(result.out.find(option.name), std::string::npos) << verb.name << " " << option.name;
  }
}

TEST(Command, TheManualHasASectionForEveryVerb) {
  const auto manual = test::read_text(std::filesystem::path(ROADBOOK_SOURCE_DIR) / "docs" /
                                      "reference" / "command_line.md");
  for (const Verb& verb : all_verbs()) {
    EXPECT_NE(manual.find("\n### " + verb.name + "\n"), std::string::npos) << verb.name;
    EXPECT_NE(manual.find("\nroadbook " + verb.name + " "), std::string::npos) << verb.name;
  }
}

// To renew the tables: build/release/tests/apps/test_apps --gtest_filter='*OptionTables*' with
// ROADBOOK_WRITE_TABLES=1 in the environment.
TEST(Command, TheManualHasTheOptionTablesOfTheProgram) {
  const auto file =
      std::filesystem::path(ROADBOOK_SOURCE_DIR) / "docs" / "reference" / "command_line.md";
  const std::string page = test::read_text(file);
  const std::string renewed = with_option_tables(page);
  if (std::getenv("ROADBOOK_WRITE_TABLES") != nullptr) test::write_text(file, renewed);
  EXPECT_EQ(page, renewed);
  for (const Verb& verb : all_verbs())
    EXPECT_NE(page.find("<!-- options of " + verb.name + " -->\n\n| option | meaning |"),
              std::string::npos)
        << verb.name;
}

TEST(Command, AModelOfEffectsThatIsWrongIsNamedWithItsFile) {
  const ScratchFolder folder;
  for (const auto& [text, want] :
       {std::pair{"effects:\n  cam.focl: 0.1\n", "m.yaml: effects: got cam.focl"},
        std::pair{"effects:\n  cam.focal: wide\n", "m.yaml:2: effects.cam.focal: got wide"},
        std::pair{"effects:\n  wheels0.radius: -5\n", "m.yaml: effects: got wheels0.radius = -5"},
        std::pair{"effect:\n  wheels0.radius: 0.1\n", "m.yaml:"}}) {
    test::write_text(folder.path() / "m.yaml", text);
    const auto result =
        run_command("roadbook simulate zurich --size small -o d --model m.yaml", folder.path());
    EXPECT_EQ(result.status, 2) << text;
    EXPECT_NE(result.err.find(want), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "d"));
  }
}

TEST(Command, AMissingVerbIsWrongUsage) {
  const auto result = run("roadbook");
  EXPECT_EQ(result.status, 1);
  expect_one_error_line(result);
}

TEST(Command, AMistypedVerbNamesTheOneThatWasMeant) {
  const auto result = run("roadbook overhaed -m x.gpkg");
  EXPECT_EQ(result.status, 1);
  expect_one_error_line(result);
  EXPECT_NE(result.err.find("did you mean overhead?"), std::string::npos) << result.err;
}

TEST(Command, AMistypedOptionNamesTheOneThatWasMeant) {
  const auto result = run("roadbook map drive --mpa place.gpkg");
  EXPECT_EQ(result.status, 1);
  expect_one_error_line(result);
  EXPECT_NE(result.err.find("did you mean --map?"), std::string::npos) << result.err;
}

TEST(Command, AMistypedChoiceNamesTheOneThatWasMeant) {
  const auto result = run("roadbook export -m x.gpkg -o y --format geojsn");
  EXPECT_EQ(result.status, 1);
  expect_one_error_line(result);
  EXPECT_NE(result.err.find("did you mean geojson?"), std::string::npos) << result.err;
}

TEST(Command, AMissingOptionIsWrongUsage) {
  const auto result = run("roadbook roads");
  EXPECT_EQ(result.status, 1);
  expect_one_error_line(result);
  EXPECT_NE(result.err.find("--map: got nothing"), std::string::npos) << result.err;
}

TEST(Command, AnOptionWithoutItsValueIsWrongUsage) {
  const auto result = run("roadbook roads -m");
  EXPECT_EQ(result.status, 1);
  expect_one_error_line(result);
}

TEST(Command, AnArgumentTooManyIsWrongUsage) {
  const auto result = run("roadbook check a b");
  EXPECT_EQ(result.status, 1);
  expect_one_error_line(result);
}

TEST(Command, NumbersAreTakenStrictly) {
  for (const char* threads : {"two", "2x", "0x2", "-1", "1e9", "nan", "''"}) {
    const auto result = run(std::string("roadbook check . --threads ") + threads);
    EXPECT_EQ(result.status, 1) << threads;
    EXPECT_NE(result.err.find("error: --threads: got "), std::string::npos) << result.err;
  }
}

TEST(Command, AnOptionsFileIsReadAndTheCommandLineWins) {
  const ScratchFolder folder;
  test::write_text(folder.path() / "options.yaml", "threads: 2000\n");
  const auto read = run_command("roadbook check . --options options.yaml", folder.path());
  EXPECT_EQ(read.status, 2);
  EXPECT_EQ(read.err.rfind("error: options.yaml:1: threads: got '2000', want ", 0), 0U) << read.err;
  const auto won =
      run_command("roadbook check x --options options.yaml --threads 2", folder.path());
  EXPECT_EQ(won.err.find("threads"), std::string::npos) << won.err;
}

TEST(Command, AnUnknownKeyOfAnOptionsFileNamesTheNearest) {
  const ScratchFolder folder;
  test::write_text(folder.path() / "options.yaml", "# options\nthraeds: 2\n");
  const auto result = run_command("roadbook check . --options options.yaml", folder.path());
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.err.find("options.yaml:2: thraeds"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("did you mean threads"), std::string::npos) << result.err;
}

TEST(Command, JsonIsOneObjectOnStandardOutputEvenForBadInput) {
  const auto result = run("roadbook check nowhere --json");
  EXPECT_EQ(result.status, 2);
  const auto object = nlohmann::json::parse(result.out);
  ASSERT_EQ(object.at("problems").size(), 1U);
  EXPECT_EQ(object["problems"][0].at("severity"), "error");
  EXPECT_NE(object["problems"][0].at("file").get<std::string>().find("nowhere"), std::string::npos);
}

TEST(Command, AMapThatIsNotThereIsBadInput) {
  for (const char* command :
       {"roadbook roads -m none.gpkg", "roadbook overhead -m none.gpkg",
        "roadbook report -m none.gpkg -o r.html", "roadbook export -m none.gpkg -f tum -o p.tum"}) {
    const auto result = run(command);
    EXPECT_EQ(result.status, 2) << command;
    expect_one_error_line(result);
    EXPECT_NE(result.err.find("none.gpkg"), std::string::npos) << result.err;
  }
}

TEST(Command, AFullStandardOutputIsAStorageError) {
  const auto result = run("roadbook completion bash > /dev/full");
  EXPECT_EQ(result.status, 3) << result.err;
}

TEST(Command, CompletionScriptsAreSoundAndKnowTheVerbs) {
  const auto bash = run("roadbook completion bash > script && bash -n script && cat script");
  EXPECT_EQ(bash.status, 0) << bash.err;
  for (const Verb& verb : all_verbs()) EXPECT_NE(bash.out.find(verb.name), std::string::npos);
  const auto zsh = run(
      "roadbook completion zsh > script && if command -v zsh > /dev/null; then zsh -n script; fi");
  EXPECT_EQ(zsh.status, 0) << zsh.err;
}

TEST(Command, BashCompletesVerbsOptionsAndChoices) {
  // Runs the completion function as bash would, for the words given.
  const auto complete = [](const std::string& words, int position) {
    return run("bash -c 'eval \"$(roadbook completion bash)\"; COMP_WORDS=(" + words +
               "); COMP_CWORD=" + std::to_string(position) +
               "; _roadbook; echo \"${COMPREPLY[@]}\"'")
        .out;
  };
  EXPECT_EQ(complete("roadbook ove", 1), "overhead\n");
  EXPECT_EQ(complete("roadbook export --form", 2), "--format\n");
  EXPECT_EQ(complete("roadbook export --format t", 3), "tum\n");
  EXPECT_EQ(complete("roadbook import kitt", 2), "kitti kitti360\n");
}

// Checks the figures of docs/results/friction.md, "Recorded laps": the median of the mean error
// along a horizon.
TEST(Command, TheLapsOfARealCarGiveTheDocumentedFigures) {
  expect_one_error_line(run("roadbook evaluate laps -o laps"));
  expect_one_error_line(run("roadbook evaluate rows --only nothing -o rows"));
  ROADBOOK_REQUIRE_DATA(folder, "indy_av21");
  const auto result = run("roadbook evaluate laps -o laps --json --data " +
                          (folder / "Putnam_park2023_run4_2.csv").string());
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("horizons"), 53);
  const std::vector<double> documented{.126, .250, .242, .037, .032};
  ASSERT_EQ(json.at("mean_abs_error_deg").size(), documented.size());
  for (std::size_t i = 0; i < documented.size(); ++i)
    EXPECT_NEAR(json.at("mean_abs_error_deg")[i].at("median"), documented[i], 0.002) << i;
}

TEST(Command, ArgumentsThatTakeSeveralTakeSeveral) {
  // Both drives are missing. The error names the first drive, so the command did not refuse either
  // of them as an extra argument.
  const auto result = run("roadbook map first second -m place.gpkg");
  EXPECT_EQ(result.status, 2) << result.err;
  EXPECT_NE(result.err.find("first"), std::string::npos) << result.err;
}

TEST(Command, AnInterruptEndsWithItsOwnStatus) {
  // Rendering takes a minute, so the simulation is still running when the signal arrives.
  const auto result =
      run("roadbook simulate zurich --size small -o drive & child=$!; sleep 2; kill -INT $child; "
          "wait $child");
  EXPECT_EQ(result.status, 5) << result.err;
  EXPECT_NE(result.err.find("error: interrupted"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace roadbook
