#include "exchange/export/qgis_project.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

#include "base/error.hpp"
#include "exchange/export/xml_elements.hpp"
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

void append_frame(pugi::xml_node parent, const char* name) {
  const auto frame =
      append_element(append_element(parent, name), "spatialrefsys", {{"nativeFormat", "Wkt"}});
  append_text(frame, "wkt", map_crs_wkt());
  append_element(frame, "proj4");
  append_text(frame, "srsid", "0");
  append_text(frame, "srid", "0");
  append_element(frame, "authid");
  append_text(frame, "description", "roadbook local frame");
  append_element(frame, "projectionacronym");
  append_element(frame, "ellipsoidacronym");
  append_text(frame, "geographicflag", "false");
}

void append_extent(pugi::xml_node canvas, const Eigen::AlignedBox2d& box) {
  const auto extent = append_element(canvas, "extent");
  append_text(extent, "xmin", fixed_text(box.min().x(), 3));
  append_text(extent, "ymin", fixed_text(box.min().y(), 3));
  append_text(extent, "xmax", fixed_text(box.max().x(), 3));
  append_text(extent, "ymax", fixed_text(box.max().y(), 3));
}

std::string source_of(const QgisProject& project, const QgisLayer& layer) {
  return layer.raster ? "GPKG:" + project.map + ":" + layer.name
                      : project.map + "|layername=" + layer.name;
}

std::string layer_id(const QgisLayer& layer) { return "roadbook_" + layer.name; }

const char* checked(bool visible) { return visible ? "Qt::Checked" : "Qt::Unchecked"; }

void append_tree_layer(pugi::xml_node tree, const QgisProject& project, const QgisLayer& layer) {
  append_element(append_element(tree, "layer-tree-layer",
                                {{"id", layer_id(layer)},
                                 {"name", layer.title},
                                 {"source", source_of(project, layer)},
                                 {"providerKey", layer.raster ? "gdal" : "ogr"},
                                 {"checked", checked(layer.visible)},
                                 {"expanded", "0"},
                                 {"legend_exp", ""}}),
                 "customproperties");
}

void append_tree(pugi::xml_node qgis, const QgisProject& project) {
  const auto tree = append_element(qgis, "layer-tree-group");
  append_element(tree, "customproperties");
  std::string name;
  pugi::xml_node group = tree;
  for (const QgisLayer& layer : project.layers) {
    if (layer.group != name) {
      group = layer.group.empty()
                  ? tree
                  : append_element(
                        tree, "layer-tree-group",
                        {{"name", layer.group}, {"checked", "Qt::Checked"}, {"expanded", "1"}});
      if (!layer.group.empty()) append_element(group, "customproperties");
    }
    name = layer.group;
    append_tree_layer(group, project, layer);
  }
}

void append_pipe(pugi::xml_node map_layer, const QgisLayer& layer) {
  const auto renderer = append_element(append_element(map_layer, "pipe"), "rasterrenderer");
  if (layer.bands >= 3) {
    add_attributes(renderer, {{"type", "multibandcolor"},
                              {"redBand", "1"},
                              {"greenBand", "2"},
                              {"blueBand", "3"},
                              {"alphaBand", layer.bands == 4 ? "4" : "-1"},
                              {"opacity", "1"}});
    return;
  }
  add_attributes(renderer, {{"type", "singlebandgray"},
                            {"grayBand", "1"},
                            {"gradient", "BlackToWhite"},
                            {"alphaBand", "-1"},
                            {"opacity", "1"}});
  const auto contrast = append_element(renderer, "contrastEnhancement");
  append_text(contrast, "minValue", fixed_text(layer.least, 3));
  append_text(contrast, "maxValue", fixed_text(layer.most, 3));
  append_text(contrast, "algorithm",
              layer.most == 255.0 ? "NoEnhancement" : "StretchToMinimumMaximum");
}

void append_map_layer(pugi::xml_node layers, const QgisProject& project, const QgisLayer& layer) {
  const auto style = layer.raster ? std::nullopt : layer_style(layer.name);
  auto node = append_element(layers, "maplayer", {{"type", layer.raster ? "raster" : "vector"}});
  if (!layer.raster)
    add_attributes(node, {{"geometry", layer.geometry},
                          {"labelsEnabled", style && !style->labeling.empty() ? "1" : "0"}});
  add_attributes(node, {{"autoRefreshEnabled", "0"}, {"hasScaleBasedVisibilityFlag", "0"}});
  append_text(node, "id", layer_id(layer));
  append_text(node, "datasource", source_of(project, layer));
  append_text(node, "layername", layer.title);
  append_frame(node, "srs");
  append_text(node, "provider", layer.raster ? "gdal" : "ogr");
  if (layer.raster)
    append_pipe(node, layer);
  else
    add_attributes(node.child("provider"), {{"encoding", "UTF-8"}});
  if (style) {
    const std::string text = style->renderer + style->labeling;
    ROADBOOK_ASSERT(node.append_buffer(text.data(), text.size()));
  }
  append_text(node, "blendMode", "0");
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
  pugi::xml_document document;
  document.append_child(pugi::node_doctype)
      .set_value("qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'");
  const auto qgis =
      append_element(document, "qgis", {{"version", "3.22.16"}, {"projectname", project.title}});
  append_element(qgis, "homePath", {{"path", ""}});
  append_text(qgis, "title", project.title);
  append_frame(qgis, "projectCrs");
  append_tree(qgis, project);
  const auto canvas =
      append_element(qgis, "mapcanvas", {{"name", "theMapCanvas"}, {"annotationsVisible", "1"}});
  append_text(canvas, "units", "meters");
  append_extent(canvas, project.extent);
  append_text(canvas, "rotation", "0");
  append_frame(canvas, "destinationsrs");
  const auto layers = append_element(qgis, "projectlayers");
  for (const QgisLayer& layer : project.layers) append_map_layer(layers, project, layer);
  const auto order = append_element(qgis, "layerorder");
  for (const QgisLayer& layer : project.layers)
    append_element(order, "layer", {{"id", layer_id(layer)}});
  const auto properties = append_element(qgis, "properties");
  add_attributes(append_text(append_element(properties, "Paths"), "Absolute", "false"),
                 {{"type", "bool"}});
  add_attributes(
      append_text(append_element(properties, "SpatialRefSys"), "ProjectionsEnabled", "1"),
      {{"type", "int"}});
  std::ostringstream text;
  document.save(text, "", pugi::format_indent | pugi::format_no_declaration);
  return text.str();
}

}  // namespace roadbook
