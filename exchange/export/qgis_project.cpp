#include "exchange/export/qgis_project.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "base/text.hpp"
#include "exchange/layers/stored_paths.hpp"
#include "mapping/layers/layer_style_qml.hpp"
#include "mapping/layers/map_layers.hpp"

namespace roadbook {
namespace {

struct Known {
  std::string_view name;
  std::string_view title;
  std::string_view group;
  bool visible;
  double least = 0.0;
  double most = 255.0;
};

// From the top.
constexpr std::array<Known, 20> kKnown{{
    {"other_labels", "Other labels", "Labels", true},
    {"crossings", "Crossings", "Labels", true},
    {"parking_spaces", "Parking spaces", "Labels", true},
    {"speed_profile", "Speed along the lanes", "Speed and friction", true},
    {"friction", "Friction", "Speed and friction", false},
    {"dynamic_map", "Speed where people are met", "Speed and friction", false},
    {"intersections", "Intersections", "Roads", true},
    {"lanes", "Lanes, arrows: one way", "Roads", true},
    {"lane_paths", "Paths of the lanes", "Roads", true},
    {"poses", "Vehicle poses", "Recording", true},
    {"landmark_points", "Landmarks", "Recording", false},
    {"speed_colours", "Speed map", "Rasters", false},
    {"friction_colours", "Friction map", "Rasters", false},
    {"speed_map", "Speed [m/s]", "Rasters", false, 0.0, 14.0},
    {"speed_sigma", "Speed, standard deviation [m/s]", "Rasters", false, 0.0, 2.0},
    {"friction_mean", "Friction, mean", "Rasters", false, 0.0, 1.0},
    {"friction_sigma", "Friction, standard deviation", "Rasters", false, 0.0, 0.3},
    {"overhead_count", "Images averaged", "Overhead image", false, 0.0, 50.0},
    {"overhead_variance", "Variance of their grey values", "Overhead image", false, 0.0, 2000.0},
    {"overhead", "Overhead image", "Overhead image", true},
}};

std::string xml(const std::string& text) {
  std::string result;
  for (const char c : text)
    result += c == '&'   ? "&amp;"
              : c == '<' ? "&lt;"
              : c == '>' ? "&gt;"
              : c == '"' ? "&quot;"
                         : std::string(1, c);
  return result;
}

std::string element(const std::string& name, const std::string& text) {
  return "<" + name + ">" + xml(text) + "</" + name + ">\n";
}

std::string map_frame() {
  return "<spatialrefsys nativeFormat=\"Wkt\">\n" + element("wkt", map_crs_wkt()) +
         "<proj4></proj4>\n<srsid>0</srsid>\n<srid>0</srid>\n<authid></authid>\n"
         "<description>roadbook local "
         "frame</description>\n<projectionacronym></projectionacronym>\n"
         "<ellipsoidacronym></ellipsoidacronym>\n<geographicflag>false</geographicflag>\n"
         "</spatialrefsys>\n";
}

std::string extent_xml(const Eigen::AlignedBox2d& box) {
  return "<extent>\n" + element("xmin", fixed_text(box.min().x(), 3)) +
         element("ymin", fixed_text(box.min().y(), 3)) +
         element("xmax", fixed_text(box.max().x(), 3)) +
         element("ymax", fixed_text(box.max().y(), 3)) + "</extent>\n";
}

std::string source_of(const QgisProject& project, const QgisLayer& layer) {
  return layer.raster ? "GPKG:" + project.map + ":" + layer.name
                      : project.map + "|layername=" + layer.name;
}

std::string layer_id(const QgisLayer& layer) { return "roadbook_" + layer.name; }

const char* checked(bool visible) { return visible ? "Qt::Checked" : "Qt::Unchecked"; }

std::string tree_layer(const QgisProject& project, const QgisLayer& layer) {
  return "<layer-tree-layer id=\"" + layer_id(layer) + "\" name=\"" + xml(layer.title) +
         "\" source=\"" + xml(source_of(project, layer)) + "\" providerKey=\"" +
         (layer.raster ? "gdal" : "ogr") + "\" checked=\"" + checked(layer.visible) +
         "\" expanded=\"0\" legend_exp=\"\">\n<customproperties/>\n</layer-tree-layer>\n";
}

std::string tree(const QgisProject& project) {
  std::string text = "<layer-tree-group>\n<customproperties/>\n";
  std::string group;
  for (const QgisLayer& layer : project.layers) {
    if (layer.group != group && !group.empty()) text += "</layer-tree-group>\n";
    if (layer.group != group && !layer.group.empty())
      text += "<layer-tree-group name=\"" + xml(layer.group) +
              "\" checked=\"Qt::Checked\" expanded=\"1\">\n<customproperties/>\n";
    group = layer.group;
    text += tree_layer(project, layer);
  }
  return text + (group.empty() ? "" : "</layer-tree-group>\n") + "</layer-tree-group>\n";
}

std::string raster_pipe(const QgisLayer& layer) {
  const std::string renderer =
      layer.bands >= 3
          ? "<rasterrenderer type=\"multibandcolor\" redBand=\"1\" greenBand=\"2\" "
            "blueBand=\"3\" alphaBand=\"" +
                std::string(layer.bands == 4 ? "4" : "-1") + "\" opacity=\"1\"/>\n"
          : "<rasterrenderer type=\"singlebandgray\" grayBand=\"1\" gradient=\"BlackToWhite\" "
            "alphaBand=\"-1\" opacity=\"1\">\n<contrastEnhancement>\n" +
                element("minValue", fixed_text(layer.least, 3)) +
                element("maxValue", fixed_text(layer.most, 3)) +
                element("algorithm",
                        layer.most == 255.0 ? "NoEnhancement" : "StretchToMinimumMaximum") +
                "</contrastEnhancement>\n</rasterrenderer>\n";
  return "<pipe>\n" + renderer + "</pipe>\n";
}

std::string vector_style(const QgisLayer& layer) {
  const auto style = layer_style(layer.name);
  return style ? style->renderer + style->labeling : "";
}

std::string map_layer(const QgisProject& project, const QgisLayer& layer) {
  const auto style = layer.raster ? std::nullopt : layer_style(layer.name);
  const bool labels = style && !style->labeling.empty();
  return std::string("<maplayer type=\"") +
         (layer.raster ? "raster\""
                       : "vector\" geometry=\"" + layer.geometry + "\" labelsEnabled=\"" +
                             (labels ? "1" : "0") + "\"") +
         " autoRefreshEnabled=\"0\" hasScaleBasedVisibilityFlag=\"0\">\n" +
         element("id", layer_id(layer)) + element("datasource", source_of(project, layer)) +
         element("layername", layer.title) + "<srs>\n" + map_frame() + "</srs>\n" +
         (layer.raster ? "<provider>gdal</provider>\n" + raster_pipe(layer)
                       : "<provider encoding=\"UTF-8\">ogr</provider>\n" + vector_style(layer)) +
         "<blendMode>0</blendMode>\n</maplayer>\n";
}

const Known* known_layer(const std::string& name) {
  const auto* const found = std::find_if(kKnown.begin(), kKnown.end(),
                                         [&](const Known& known) { return known.name == name; });
  return found == kKnown.end() ? nullptr : found;
}

}  // namespace

std::vector<QgisLayer> arranged_layers(const std::vector<QgisLayer>& found) {
  std::vector<QgisLayer> layers;
  const auto add = [&](bool known, bool raster, const Known* as) {
    for (QgisLayer layer : found) {
      if ((known_layer(layer.name) != nullptr) != known || (!known && layer.raster != raster) ||
          (as != nullptr && as->name != layer.name))
        continue;
      layer.title = as != nullptr ? std::string(as->title) : layer.name;
      layer.group = as != nullptr ? std::string(as->group) : layer.raster ? "Rasters" : "Labels";
      layer.visible = as != nullptr && as->visible;
      if (as != nullptr) {
        layer.least = as->least;
        layer.most = as->most;
      }
      layers.push_back(std::move(layer));
    }
  };
  for (const Known& known : kKnown) add(true, false, &known);
  // Other layers come next to the layers of their kind.
  add(false, false, nullptr);
  add(false, true, nullptr);
  const auto rank = [](const QgisLayer& layer) {
    constexpr std::array<std::string_view, 6> kGroups{
        "Labels", "Speed and friction", "Roads", "Recording", "Rasters", "Overhead image"};
    return std::find(kGroups.begin(), kGroups.end(), layer.group) - kGroups.begin();
  };
  std::stable_sort(layers.begin(), layers.end(),
                   [&](const QgisLayer& a, const QgisLayer& b) { return rank(a) < rank(b); });
  return layers;
}

std::string qgs_text(const QgisProject& project) {
  std::string layers;
  std::string order;
  for (const QgisLayer& layer : project.layers) {
    layers += map_layer(project, layer);
    order += "<layer id=\"" + layer_id(layer) + "\"/>\n";
  }
  return "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n"
         "<qgis version=\"3.22.16\" projectname=\"" +
         xml(project.title) + "\">\n<homePath path=\"\"/>\n" + element("title", project.title) +
         "<projectCrs>\n" + map_frame() + "</projectCrs>\n" + tree(project) +
         "<mapcanvas name=\"theMapCanvas\" annotationsVisible=\"1\">\n<units>meters</units>\n" +
         extent_xml(project.extent) + "<rotation>0</rotation>\n<destinationsrs>\n" + map_frame() +
         "</destinationsrs>\n</mapcanvas>\n<projectlayers>\n" + layers +
         "</projectlayers>\n<layerorder>\n" + order +
         "</layerorder>\n<properties>\n<Paths>\n<Absolute type=\"bool\">false</Absolute>\n"
         "</Paths>\n<SpatialRefSys>\n<ProjectionsEnabled type=\"int\">1</ProjectionsEnabled>\n"
         "</SpatialRefSys>\n</properties>\n</qgis>\n";
}

}  // namespace roadbook
