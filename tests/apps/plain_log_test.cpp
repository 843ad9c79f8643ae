#include <gtest/gtest.h>

#include "tests/apps/run_command.hpp"

namespace roadbook {
namespace {

using test::write_text;

// A covariate that cannot be used ends the command before it reports any cause.
TEST(PlainLogCommand, SaysInOneLineWhatIsWrongWithACovariate) {
  const test::ScratchFolder folder;
  write_text(folder.path() / "p.csv", "t,x,y,h\n0,0,0,0\n1,1,0,0\n");
  write_text(folder.path() / "c.csv", "t,w,volts\n0,0,12.5\n1,0,nan\n2,0,none\n");
  const std::string base =
      "vehicle: {radius_m: 0.5, track_width_m: 1.5, wheelbase_m: 2.5}\n"
      "poses: {file: p.csv, time: t, x: x, y: y, heading: h}\n"
      "gyro: {file: c.csv, time: t, rate: w}\n"
      "covariates:\n";
  const auto expect_error = [&](const std::string& covariates, const std::string& line) {
    write_text(folder.path() / "log.yaml", base + covariates);
    const auto run = test::run_command("roadbook diagnose log.yaml", folder.path());
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(run.err, "error: " + line + "\n");
  };
  expect_error("  - {name: volts, file: c.csv, time: t}\n",
               "c.csv:3: covariates.volts.column: got 'nan' and 1 more such rows, want a finite "
               "number");
  expect_error(
      "  - {name: speed, file: c.csv, time: t, column: w}\n",
      "log.yaml:5: covariates[0].name: got speed, want another name: this one is diagnosis' own");
}

}  // namespace
}  // namespace roadbook
