#include "apps/report/occupancy_section.hpp"

#include <algorithm>

#include "apps/report/html.hpp"
#include "base/format.hpp"

namespace roadbook {
namespace {

constexpr const char* kNoTruth = "unknown: no true surfaces";

std::string share_text(double share, int digits = 1) { return fixed(100.0 * share, digits) + " %"; }

double part_of(std::size_t part, std::size_t whole) {
  return static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(whole, 1));
}

// A row: the demand, its figure, the wanted figure, and the meaning.
HtmlRow wanted_row(const std::string& demand,
                   const std::string& figure,
                   const std::string& wanted,
                   bool met,
                   const std::string& meaning) {
  return {demand, figure, wanted + (met ? " (met)" : " (not met)"), meaning};
}

HtmlRow open_row(const std::string& demand,
                 const std::string& figure,
                 const std::string& wanted,
                 const std::string& meaning) {
  return {demand, figure, wanted, meaning};
}

void add_free_space(const OccupancyDemands& d, std::vector<HtmlRow>& rows) {
  const std::string name = "5 free space";
  rows.push_back(
      open_row(name, share_text(d.free_share()), "",
               "cells called free: probability plus two standard deviations below 0.196"));
  if (d.driven.cells > 0)
    rows.push_back(open_row(
        name, share_text(part_of(d.driven.free, d.driven.cells)), "",
        "of the ground that the vehicle drove on is called free; " +
            share_text(part_of(d.driven.occupied, d.driven.cells), 2) + " is called occupied, " +
            share_text(1.0 - part_of(d.driven.seen, d.driven.cells)) + " was not seen"));
  if (!d.truth) {
    rows.push_back(open_row(name, kNoTruth, "at least 95 %", "free cells that are called free"));
    rows.push_back(
        open_row(name, kNoTruth, "at most 0.5 %", "occupied cells that are called free"));
    return;
  }
  rows.push_back(wanted_row(name, share_text(d.truth->free_recall), "at least 95 %",
                            d.truth->free_recall >= 0.95, "free cells that are called free"));
  rows.push_back(wanted_row(name, share_text(d.truth->occupied_called_free, 2), "at most 0.5 %",
                            d.truth->occupied_called_free <= 0.005,
                            "occupied cells that are called free"));
}

void add_moving_things(const OccupancyDemands& d, std::vector<HtmlRow>& rows) {
  const std::string name = "6 moving things";
  rows.push_back(open_row(name, share_text(d.figures.vanished_share, 2), "",
                          "free cells that had readings of something that left"));
  const std::string meaning = "free cells crossed by people that are called occupied (trails)";
  if (d.trails)
    rows.push_back(wanted_row(name, share_text(d.trails->called_occupied, 2), "below 1 %",
                              d.trails->called_occupied < 0.01, meaning));
  else
    rows.push_back(open_row(name, d.truth ? "unknown: no people on seen ground" : kNoTruth,
                            "below 1 %", meaning));
}

std::vector<HtmlRow> demand_rows(const OccupancyDemands& d) {
  std::vector<HtmlRow> rows;
  rows.push_back(
      open_row("1 complete", share_text(1.0 - d.undecided_share()), "",
               "of " + fixed(d.area_m2(), 0) + " m2 of seen ground is decided: free or occupied"));
  rows.push_back(open_row("2 compact", fixed(d.figures.bytes_per_m2, 0) + " bytes/m2", "",
                          "packed patches over the seen ground"));
  rows.push_back(open_row("3 real time",
                          d.updates_a_scan() > 0.0 ? fixed(d.updates_a_scan(), 0) + " changes"
                                                   : "unknown: made by an earlier version",
                          "", "changed cells a scan (cameras: a keyframe)"));
  rows.push_back(open_row("4 suppresses detail", share_text(d.figures.merged_share), "",
                          "of the cells are left after merging equal neighbours"));
  add_free_space(d, rows);
  add_moving_things(d, rows);
  const std::string calibration = "mean difference of stated probability and true share";
  if (d.truth)
    rows.push_back(wanted_row("7 uncertainty", fixed(d.truth->calibration_error, 4), "below 0.03",
                              d.truth->calibration_error < 0.03, calibration));
  else
    rows.push_back(open_row("7 uncertainty", kNoTruth, "below 0.03", calibration));
  return rows;
}

}  // namespace

std::string occupancy_section(const ReportData& data) {
  if (!data.occupancy) return "";
  const OccupancyDemands& demands = *data.occupancy;
  std::string html =
      "<p>The grid against the seven demands on a representation of the environment. "
      "Cells have " +
      fixed(100.0 * demands.cell_m, 0) + " cm.</p>";
  html += html_table({"demand", "figure", "wanted", "meaning"}, demand_rows(demands));
  std::vector<HtmlRow> drives;
  for (const OccupancyDrive& d : demands.drives)
    drives.push_back({d.drive, d.sensor == "cameras" ? "cameras" : "range scanner",
                      std::to_string(d.scans) + (d.sensor == "cameras" ? " keyframes" : " scans"),
                      fixed(d.temper, 3)});
  html += html_table({"drive", "sensor", "readings", "weight of a further reading"}, drives);
  return html_section("Free space", html);
}

}  // namespace roadbook
