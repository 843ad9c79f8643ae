#include "mapping/layers/layer_style_qml.hpp"

#include <cmath>
#include <utility>

#include "base/colour_ramp.hpp"

namespace roadbook {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else if (c == '"') {
      result += "&quot;";
    } else {
      result += c;
    }
  }
  return result;
}

std::string option(const std::string& name, const std::string& type, const std::string& value) {
  return "<Option name=\"" + name + "\" type=\"" + type + "\" value=\"" + escaped(value) + "\"/>\n";
}

// Settings that follow an expression over the columns: name and expression.
std::string by_expression(const Settings& expressions) {
  if (expressions.empty()) return "";
  std::string text = "<data_defined_properties>\n<Option type=\"Map\">\n" +
                     option("name", "QString", "") + "<Option name=\"properties\" type=\"Map\">\n";
  for (const auto& [name, expression] : expressions)
    text += "<Option name=\"" + name + "\" type=\"Map\">\n" + option("active", "bool", "true") +
            option("expression", "QString", expression) + option("type", "int", "3") +
            "</Option>\n";
  return text + "</Option>\n" + option("type", "QString", "collection") +
         "</Option>\n</data_defined_properties>\n";
}

// `inner`: the symbol that the layer repeats, of a line of markers.
std::string symbol_layer(const std::string& kind,
                         const Settings& settings,
                         const Settings& expressions = {},
                         const std::string& inner = "") {
  std::string text = "<layer class=\"" + kind +
                     "\" enabled=\"1\" locked=\"0\" pass=\"0\">\n<Option type=\"Map\">\n";
  for (const auto& [name, value] : settings) text += option(name, "QString", value);
  text += "</Option>\n";
  // QGIS before 3.22 reads these.
  for (const auto& [name, value] : settings)
    text += "<prop k=\"" + name + "\" v=\"" + escaped(value) + "\"/>\n";
  return text + by_expression(expressions) + inner + "</layer>\n";
}

std::string symbol(const std::string& name, const std::string& type, const std::string& layers) {
  return "<symbol name=\"" + name + "\" type=\"" + type +
         "\" alpha=\"1\" clip_to_extent=\"1\" force_rhr=\"0\">\n" + layers + "</symbol>\n";
}

std::string single(const std::string& type, const std::string& layers) {
  return "<renderer-v2 type=\"singleSymbol\" symbollevels=\"0\" enableorderby=\"0\" "
         "forceraster=\"0\">\n<symbols>\n" +
         symbol("0", type, layers) + "</symbols>\n</renderer-v2>\n";
}

std::string line(const std::string& colour, double width_mm, const std::string& pen = "solid") {
  return symbol_layer("SimpleLine", {{"line_color", colour},
                                     {"line_style", pen},
                                     {"line_width", std::to_string(width_mm)},
                                     {"line_width_unit", "MM"},
                                     {"joinstyle", "miter"},
                                     {"capstyle", "flat"}});
}

// A line that shows on light ground and on dark.
std::string cased_line(const std::string& colour, double width_mm) {
  return line("20,20,20,170", width_mm + 0.5) + line(colour, width_mm);
}

Settings marker(const std::string& shape,
                const std::string& colour,
                const std::string& outline,
                double size,
                const std::string& unit = "MM") {
  return {{"name", shape},
          {"color", colour},
          {"outline_color", outline},
          {"outline_style", outline.empty() ? "no" : "solid"},
          {"outline_width", "0.15"},
          {"outline_width_unit", "MM"},
          {"size", std::to_string(size)},
          {"size_unit", unit}};
}

std::string colour_text(double part, int alpha) {
  const auto rgb = colour_ramp(part);
  return std::to_string(rgb[0]) + "," + std::to_string(rgb[1]) + "," + std::to_string(rgb[2]) +
         "," + std::to_string(alpha);
}

std::string number_text(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

struct Ramp {
  std::string column;
  std::string unit;
  std::vector<double> bounds;  ///< ascending
  bool high_is_calm = true;    ///< calm is dark, danger yellow, as in the rasters
  int alpha = 255;
};

std::string graduated(const Ramp& ramp, const std::string& shape, double size, const char* unit) {
  std::string ranges;
  std::string symbols;
  const std::size_t count = ramp.bounds.size() - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = std::to_string(i);
    const double part = static_cast<double>(i) / static_cast<double>(count - 1);
    const bool open = i + 1 == count;
    const std::string label =
        open ? "from " + number_text(ramp.bounds[i])
             : number_text(ramp.bounds[i]) + " to " + number_text(ramp.bounds[i + 1]);
    ranges += "<range lower=\"" + number_text(ramp.bounds[i]) + "\" upper=\"" +
              number_text(ramp.bounds[i + 1]) + "\" symbol=\"" + name + "\" label=\"" + label +
              ramp.unit + "\" render=\"true\"/>\n";
    symbols += symbol(
        name, "marker",
        symbol_layer("SimpleMarker",
                     marker(shape, colour_text(ramp.high_is_calm ? 1.0 - part : part, ramp.alpha),
                            "", size, unit)));
  }
  return "<renderer-v2 type=\"graduatedSymbol\" attr=\"" + ramp.column +
         "\" graduatedMethod=\"GraduatedColor\" symbollevels=\"0\" enableorderby=\"0\" "
         "forceraster=\"0\">\n<ranges>\n" +
         ranges + "</ranges>\n<symbols>\n" + symbols + "</symbols>\n</renderer-v2>\n";
}

std::string landmarks() {
  const auto one = [](const char* name, const char* colour) {
    return symbol(name, "marker", symbol_layer("SimpleMarker", marker("circle", colour, "", 0.8)));
  };
  return "<renderer-v2 type=\"categorizedSymbol\" attr=\"ground\" symbollevels=\"0\" "
         "enableorderby=\"0\" forceraster=\"0\">\n<categories>\n"
         "<category value=\"1\" symbol=\"0\" label=\"on the ground\" render=\"true\"/>\n"
         "<category value=\"0\" symbol=\"1\" label=\"above it\" render=\"true\"/>\n"
         "</categories>\n<symbols>\n" +
         one("0", "90,200,90,255") + one("1", "255,90,60,255") + "</symbols>\n</renderer-v2>\n";
}

// QGIS turns markers clockwise.
std::string poses() {
  Settings settings = marker("filled_arrowhead", "255,120,50,255", "90,30,0,255", 0.5, "MapUnit");
  settings.emplace_back("size_map_unit_scale", "3x:0,0,1,1.2,1,6");  // 1.2 to 6 mm on the screen
  return single("marker",
                symbol_layer("SimpleMarker", settings, {{"angle", R"(-degrees("heading_rad"))"}}));
}

// Arrows along lanes that were driven in one direction.
std::string lanes() {
  const std::string arrow =
      symbol("@0@1", "marker",
             symbol_layer("SimpleMarker",
                          marker("filled_arrowhead", "255,255,255,255", "20,20,20,255", 3.0),
                          {{"angle", R"(if("forward_passes" = 0, 180, 0))"}}));
  const Settings along{{"placement", "interval"},        {"interval", "12"},
                       {"interval_unit", "MM"},          {"offset_along_line", "6"},
                       {"offset_along_line_unit", "MM"}, {"rotate", "1"}};
  return single("line",
                line("255,255,255,255", 0.3, "dash") +
                    symbol_layer("MarkerLine", along, {{"enabled", R"("one_way" = 1)"}}, arrow));
}

std::string labels_of(const std::string& column) {
  return "<labeling type=\"simple\">\n<settings>\n<text-style fieldName=\"" + column +
         "\" isExpression=\"0\" fontFamily=\"Sans Serif\" fontSize=\"8\" fontSizeUnit=\"Point\" "
         "textColor=\"255,255,255,255\">\n<text-buffer bufferDraw=\"1\" bufferSize=\"0.7\" "
         "bufferSizeUnits=\"MM\" bufferColor=\"20,20,20,255\"/>\n</text-style>\n"
         "<placement placement=\"1\"/>\n<rendering drawLabels=\"1\"/>\n</settings>\n</labeling>\n";
}

const Ramp& speeds() {
  static const Ramp ramp{"speed_mps", " m/s", {0, 1, 2, 3, 4, 5, 6, 8, 10, 14, 100}};
  return ramp;
}

Ramp friction() { return {"mean", "", {0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 100}}; }

Ramp see_through(Ramp ramp) {
  ramp.alpha = 150;
  return ramp;
}

}  // namespace

std::optional<LayerStyle> layer_style(const std::string& layer) {
  if (layer == "parking_spaces")
    return LayerStyle{single("fill", cased_line("255,212,0,255", 0.4)), ""};
  if (layer == "crossings") return LayerStyle{single("fill", cased_line("0,225,255,255", 0.4)), ""};
  if (layer == "other_labels")
    return LayerStyle{single("fill", cased_line("255,90,220,255", 0.4)), labels_of("class")};
  if (layer == "lanes") return LayerStyle{lanes(), ""};
  if (layer == "lane_paths")
    return LayerStyle{single("line", cased_line("40,120,255,255", 0.6)), ""};
  if (layer == "intersections")
    return LayerStyle{
        single("marker", symbol_layer("SimpleMarker",
                                      marker("circle", "255,255,255,255", "40,120,255,255", 3.0))),
        ""};
  if (layer == "poses") return LayerStyle{poses(), ""};
  if (layer == "landmark_points") return LayerStyle{landmarks(), ""};
  if (layer == "speed_profile") return LayerStyle{graduated(speeds(), "circle", 1.8, "MM"), ""};
  if (layer == "dynamic_map")
    return LayerStyle{graduated(see_through(speeds()), "square", 0.5, "MapUnit"), ""};
  if (layer == "friction")
    return LayerStyle{graduated(see_through(friction()), "circle", 0.8, "MapUnit"), ""};
  return std::nullopt;
}

std::string qml_of(const LayerStyle& style) {
  return "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n"
         "<qgis version=\"3.22.16\" styleCategories=\"Symbology|Labeling\" labelsEnabled=\"" +
         std::string(style.labeling.empty() ? "0" : "1") + "\">\n" + style.renderer +
         style.labeling + "</qgis>\n";
}

}  // namespace roadbook
