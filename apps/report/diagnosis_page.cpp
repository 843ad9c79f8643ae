#include "apps/report/diagnosis_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/report/html.hpp"
#include "apps/report/page_style.hpp"
#include "apps/report/simulation_section.hpp"
#include "apps/report/svg_plot.hpp"
#include "base/format.hpp"
#include "diagnosis/inference/plausible_size.hpp"

namespace roadbook {
namespace {

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

// Code between backticks, the rest escaped.
std::string with_code(const std::string& text) {
  std::string html;
  bool code = false;
  std::size_t begin = 0;
  for (std::size_t tick = text.find('`'); tick != std::string::npos; tick = text.find('`', begin)) {
    html += escaped(text.substr(begin, tick - begin)) + (code ? "</code>" : "<code>");
    code = !code;
    begin = tick + 1;
  }
  return html + escaped(text.substr(begin)) + (code ? "</code>" : "");
}

std::string folded(const std::string& title, const std::string& body) {
  return "<details><summary>" + escaped(title) + "</summary>\n" + body + "</details>\n";
}

std::string section(const std::string& title, const std::string& body) {
  return "<section><h2>" + escaped(title) + "</h2>\n" + body + "</section>\n";
}

std::string figure(const EvidencePlot& plot) {
  if (plot.bins.empty()) return "";
  return "<figure>" + evidence_svg(plot) + "<figcaption>" + escaped(plot.channel) +
         ": measured minus explained [" +
         escaped(plot.unit.empty() ? "standard deviations" : plot.unit) + "] against " +
         escaped(plot.covariate) +
         ". Orange: as the files state it. Blue: with all corrections. By chance, 95 % of the blue "
         "points lie within the band. The fitted path takes up a part of a fault: the orange line "
         "may show less than its size.</figcaption></figure>\n";
}

std::string gain_text(const HeldOutGain& gain) {
  return fixed(gain.total, 1) + " nats (" + fixed(gain.low, 1) + " to " + fixed(gain.high, 1) +
         "), " + short_number(gain.per_sample) + " a sample" +
         (gain.interleaved ? ", on interleaved blocks" : ", on held-out blocks");
}

// Lists the places in the map in a table, because there may be many.
std::string places_table(const std::vector<FoundPlace>& places) {
  if (places.empty()) return "";
  std::string html =
      "<div class=\"scroll\"><table><thead><tr><th>x [m]</th><th>y [m]</th><th>within [m]</th>"
      "<th>landmarks</th><th>to be found again</th><th>found</th><th>sightings expected</th>"
      "<th>sightings</th><th>p</th></tr></thead><tbody>";
  for (const FoundPlace& p : places)
    html += "<tr><td>" + fixed(p.middle.x(), 1) + "</td><td>" + fixed(p.middle.y(), 1) +
            "</td><td>" + fixed(p.reach_m, 1) + "</td><td>" + std::to_string(p.landmarks) +
            "</td><td>" + fixed(p.expected, 1) + "</td><td>" + std::to_string(p.found) +
            "</td><td>" + fixed(p.expected_sightings, 0) + "</td><td>" +
            std::to_string(p.sightings) + "</td><td>" + short_number(p.p) + "</td></tr>";
  return html + "</tbody></table></div>\n";
}

std::string cause_section(const FoundCause& c, const Advice& advice) {
  std::string body =
      "<p><b>" + escaped(advice.size) + "</b>, " + escaped(advice.certainty) + ".</p>\n";
  if (!advice.action.empty()) body += "<p>" + with_code(advice.action) + ".</p>\n";
  if (!advice.gain.empty()) body += "<p>" + escaped(advice.gain) + ".</p>\n";
  if (const std::string doubt = size_doubt(c); !doubt.empty())
    body += "<p><b>" + escaped(doubt) + "</b></p>\n";
  body += places_table(c.places) + figure(c.plot);
  std::string evidence = "<p><code>" + escaped(c.effect) + "</code> = " + short_number(c.size) +
                         (c.unit == "1" ? "" : " " + escaped(c.unit)) +
                         " (95 %: " + short_number(c.low) + " to " + short_number(c.high) +
                         "), p = " + short_number(c.p) + ", evidence " + fixed(c.evidence, 1) +
                         " nats, gain " + gain_text(c.gain) + ".</p>\n";
  if (!c.note.empty()) evidence += "<p>" + escaped(c.note) + "</p>\n";
  if (!c.inseparable.empty())
    evidence += "<p>Not separable in this drive from " + escaped(listed(c.inseparable)) +
                (c.separating.empty() ? "" : "; " + escaped(c.separating)) + ".</p>\n";
  return section(advice.fault, body + folded("Evidence", evidence));
}

// Draws the estimated smooth function of the covariate.
std::string curve_figure(const EvidencePlot& plot) {
  if (plot.curve.size() < 2) return "";
  EvidencePlot curve;
  curve.channel = plot.channel;
  curve.covariate = plot.covariate;
  for (const auto& [x, y] : plot.curve) curve.bins.push_back({x, y, y, 0.0, 0});
  return "<figure>" + evidence_svg(curve) + "<figcaption>Estimated function [" +
         escaped(plot.curve_unit) + "] against " + escaped(plot.covariate) +
         ".</figcaption></figure>\n";
}

std::string unknown_title(const UnknownCause& u) {
  return "Unknown: " + u.stream + "." + u.hook + " depends on " + u.depends_on;
}

std::string unknown_section(const UnknownCause& u) {
  std::string body =
      "<p>No effect of the catalogue explains it.</p>\n" + curve_figure(u.plot) + figure(u.plot);
  std::string evidence = "<p>p = " + short_number(u.p) + ", gain " + gain_text(u.gain) + ".</p>\n";
  if (!u.inseparable.empty())
    evidence += "<p>Not separable in this drive from " + escaped(listed(u.inseparable)) + ".</p>\n";
  return section(unknown_title(u), body + folded("Evidence", evidence));
}

// The first screen: what is wrong, by how much, how sure that is, what to do.
std::string summary_section(const Diagnosis& d, const std::vector<Advice>& advice) {
  std::string rows;
  const auto add = [&](const std::string& fault, const std::string& size, const std::string& sure,
                       const std::string& action) {
    rows += "<tr><td><b>" + escaped(fault) + "</b></td><td>" + escaped(size) + "</td><td>" +
            escaped(sure) + "</td><td>" + with_code(action) + "</td></tr>";
  };
  for (const Advice& a : advice)
    if (!a.of_place) add(a.fault, a.size, a.certainty, a.action);
  for (const UnknownCause& u : d.unknown)
    add(unknown_title(u), "see the curve below", "sure that it depends, not why",
        "Look at the curve: its x axis shows where to search");
  if (rows.empty() && !d.unexplained.empty())
    return section("No fault has a name", "<p>Some readings are unexplained: see below.</p>\n");
  if (rows.empty())
    return section("Nothing is wrong with the sensors",
                   "<p>The stated calibration of the sensors explains these " +
                       std::to_string(d.samples) + " readings.</p>\n");
  std::string body =
      "<div class=\"scroll\"><table class=\"stacked\"><thead><tr><th>fault</th><th>size (95 %)</th>"
      "<th>certainty</th><th>to do</th></tr></thead><tbody>" +
      rows + "</tbody></table></div>\n";
  if (const std::string text = reckoning_text(d); !text.empty())
    body += "<p><b>" + escaped(text) + ".</b></p>\n";
  return section("Found", body);
}

std::string place_section(const std::vector<Advice>& advice) {
  std::string rows;
  for (const Advice& a : advice)
    if (a.of_place)
      rows += "<li><b>" + escaped(a.fault) + "</b>: " + escaped(a.size) + ". " +
              with_code(a.action) + ".</li>";
  return rows.empty() ? "" : section("Features of the place", "<ul>" + rows + "</ul>\n");
}

std::string fine_section(const Diagnosis& d, const std::optional<StatedVehicle>& stated) {
  const std::vector<std::string> nouns = checked_and_fine(d, stated);
  if (nouns.empty()) return "";
  return section(
      "Checked and fine",
      "<p>" + escaped(capitalised(listed(nouns))) +
          ".</p>\n<p>An error in any of them would have shown in this drive at twice its plausible "
          "size (<code>roadbook diagnose --list-effects</code> prints the sizes).</p>\n");
}

std::string blind_section(const Diagnosis& d, const std::optional<StatedVehicle>& stated) {
  std::string rows;
  for (const BlindSpot& spot : blind_spots(d, stated))
    rows += "<li>" + escaped(capitalised(listed(spot.nouns))) + ": <b>" + escaped(spot.drive) +
            "</b>.</li>";
  return rows.empty() ? ""
                      : section("Not shown by this drive, and the drive that shows it",
                                "<ul>" + rows + "</ul>\n");
}

std::string checks_section(const Diagnosis& d) {
  std::string html =
      "<div class=\"scroll\"><table><thead><tr><th>stream</th><th>channel</th><th>model</th>"
      "<th>rows</th><th>mean / its error</th><th>scale</th><th>p white</th><th>p tails</th></tr>"
      "</thead><tbody>";
  const auto add = [&](const std::vector<ChannelCheck>& checks, const char* when) {
    for (const ChannelCheck& c : checks) {
      html += "<tr><td>" + escaped(c.stream) + "</td><td>" + escaped(c.channel) + "</td><td>";
      html += when;
      html += "</td><td>" + std::to_string(c.rows) + "</td><td>" + fixed(c.mean_z, 1) +
              "</td><td>" + fixed(c.scale, 3) + "</td><td>" + short_number(c.whiteness_p) +
              "</td><td>" + short_number(c.tails_p) + "</td></tr>";
    }
  };
  add(d.before, "nominal");
  add(d.after, "extended");
  return section("Checks of the residuals", folded("Table", html + "</tbody></table></div>\n"));
}

std::string list_section(const std::string& title, const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  std::string html = "<ul class=\"warnings\">";
  for (const std::string& line : lines) html += "<li>" + escaped(line) + "</li>";
  return section(title, html + "</ul>\n");
}

// Pixels of the plot.
constexpr double kPlotWidth = 700.0, kPlotHeight = 260.0, kPlotLeft = 50.0, kPlotBottom = 40.0,
                 kPlotTop = 10.0;

struct Axes {
  double x_low, x_high, y;
  [[nodiscard]] std::string at(double px, double py) const {
    const double u = (px - x_low) / (x_high - x_low) * (kPlotWidth - kPlotLeft - 10.0) + kPlotLeft;
    const double v = kPlotTop + (kPlotHeight - kPlotTop - kPlotBottom) * 0.5 * (1.0 - py / y);
    return fixed(u, 1) + " " + fixed(v, 1);
  }
};

std::string evidence_curve(const EvidencePlot& plot,
                           const Axes& axes,
                           double EvidenceBin::*value,
                           const char* css_class) {
  std::string path;
  for (const EvidenceBin& bin : plot.bins)
    path += (path.empty() ? "M" : "L") + axes.at(bin.x, bin.*value);
  return std::string("<path class=\"track ") + css_class + "\" d=\"" + path + "\"/>";
}

}  // namespace

std::string evidence_svg(const EvidencePlot& plot) {
  Axes axes{plot.bins.front().x, plot.bins.back().x, 0.0};
  const double deviation = plot.unit.empty() ? 1.0 : plot.deviation;
  if (axes.x_high <= axes.x_low) axes.x_high = axes.x_low + 1.0;
  for (const EvidenceBin& bin : plot.bins)
    axes.y =
        std::max({axes.y, 1.1 * std::abs(bin.before), 1.1 * std::abs(bin.after), 3.0 * bin.sigma});
  std::string body;
  const auto text = [&](double x, double y, const char* anchor, const std::string& words) {
    body += "<text x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\" text-anchor=\"" + anchor +
            "\">" + escaped(words) + "</text>";
  };
  const auto position = [&](double x, double y) {
    const std::string both = axes.at(x, y);
    const auto space = both.find(' ');
    return std::pair{std::stod(both.substr(0, space)), std::stod(both.substr(space + 1))};
  };
  for (const double tick : round_ticks(axes.x_low, axes.x_high, 8)) {
    body += "<path class=\"grid\" d=\"M" + axes.at(tick, -axes.y) + "L" + axes.at(tick, axes.y) +
            "\"/>";
    text(position(tick, 0.0).first, kPlotHeight - kPlotBottom + 16.0, "middle", short_number(tick));
  }
  for (const double round : round_ticks(-deviation * axes.y, deviation * axes.y, 5)) {
    const double tick = round / deviation;
    body += "<path class=\"grid\" d=\"M" + axes.at(axes.x_low, tick) + "L" +
            axes.at(axes.x_high, tick) + "\"/>";
    text(kPlotLeft - 6.0, position(axes.x_low, tick).second + 4.0, "end",
         short_number(deviation * tick));
  }
  const double band = 2.0 * plot.bins.front().sigma;
  body += "<path fill=\"var(--soft)\" opacity=\".15\" d=\"M" + axes.at(axes.x_low, band) + "L" +
          axes.at(axes.x_high, band) + "L" + axes.at(axes.x_high, -band) + "L" +
          axes.at(axes.x_low, -band) + "Z\"/>";
  body += evidence_curve(plot, axes, &EvidenceBin::before, "s1") +
          evidence_curve(plot, axes, &EvidenceBin::after, "s0");
  text(0.5 * (kPlotWidth + kPlotLeft), kPlotHeight - 6.0, "middle", plot.covariate);
  return "<svg viewBox=\"0 0 " + fixed(kPlotWidth, 0) + " " + fixed(kPlotHeight, 0) +
         "\" role=\"img\"><title>" + escaped(plot.channel + " against " + plot.covariate) +
         "</title>" + body + "</svg>\n";
}

std::string diagnosis_page(const Diagnosis& d,
                           const std::string& drive,
                           const std::optional<StatedVehicle>& stated) {
  const std::vector<Advice> advice = advice_of(d, stated);
  std::string body = summary_section(d, advice) + place_section(advice);
  for (std::size_t i = 0; i < advice.size(); ++i) body += cause_section(d.causes[i], advice[i]);
  for (const UnknownCause& u : d.unknown) body += unknown_section(u);
  body += simulation_section(d.simulated) + fine_section(d, stated) + blind_section(d, stated) +
          list_section("Unexplained", d.unexplained) + list_section("Notes", d.notes) +
          checks_section(d);
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         escaped(drive) + " - roadbook diagnosis</title>\n<style>" + std::string(kPageStyle) +
         "</style></head><body><main>\n<header><p>roadbook diagnosis</p><h1>" + escaped(drive) +
         "</h1></header>\n" + body + "</main></body></html>\n";
}

}  // namespace roadbook
