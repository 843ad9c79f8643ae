#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "base/error.hpp"
#include "exchange/export/export_map.hpp"
#include "mapping/layers/layer_style_qml.hpp"
#include "mapping/layers/map_layers_vector.hpp"
#include "mapping/store/map_check.hpp"
#include "tests/apps/label_server/lot.hpp"
#include "tests/exchange/stored_speeds.hpp"
#include "tests/support/command_output.hpp"

// Tests the styles that QGIS finds in a map, and the projects that refer to it. The tests do not
// need QGIS: they open the files with GDAL, the library that QGIS uses.

namespace roadbook {
namespace {

using test::Folder;
using test::output_of;
using test::Stored;

std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it)
    found.push_back((*it)[1]);
  return found;
}

// A map with all layers that have a style, except labels of other classes.
struct StyledMap : Stored {
  StyledMap() {
    MapUpdate update(map);
    for (const char* name : {"parking_spaces", "crossings"}) {
      VectorLayer layer;
      layer.name = name;
      layer.type = GeometryType::kPolygonZ;
      layer.features = {{{{0, 0, 0, 0}, {5, 0, 0, 0}, {5, 2, 0, 0}, {0, 0, 0, 0}}, {}}};
      update.write_layer(layer);
    }
    update.commit();
    test::write_lot_picture(map, {});
  }
};

TEST(QgisStyles, NameColumnsOfTheirLayersAndAreWellFormed) {
  const StyledMap place;
  const PlainTable table = MapLayers(place.map).read_table("layer_styles");
  const auto column = [&](const std::string& name) {
    for (std::size_t i = 0; i < table.fields.size(); ++i)
      if (table.fields[i].name == name) return i;
    ADD_FAILURE() << name;
    return std::size_t{0};
  };
  const auto text = [&](const std::vector<FieldValue>& row, const std::string& name) {
    return std::get<std::string>(row[column(name)]);
  };
  std::set<std::string> styled;
  for (const auto& row : table.rows) {
    const std::string name = text(row, "f_table_name");
    styled.insert(name);
    EXPECT_EQ(text(row, "f_geometry_column"), "geom");
    EXPECT_EQ(text(row, "f_table_catalog") + text(row, "f_table_schema"), "");
    EXPECT_EQ(row[column("useAsDefault")], FieldValue(std::int64_t{1}));
    const std::string qml = text(row, "styleQML");
    std::ofstream(place.folder / "style.qml") << qml;
    EXPECT_EQ(output_of("xmllint --noout " + (place.folder / "style.qml").string()), "");
    const VectorLayer layer = MapLayers(place.map).read_layer(name);
    for (const char* pattern : {"attr=\"(\\w+)\"", "fieldName=\"(\\w+)\"", "&quot;(\\w+)&quot;"})
      for (const std::string& field : matches(qml, pattern))
        EXPECT_TRUE(layer.field(field)) << name << ": " << field;
  }
  EXPECT_EQ(styled, (std::set<std::string>{"crossings", "dynamic_map", "friction", "intersections",
                                           "landmark_points", "lane_paths", "lanes",
                                           "parking_spaces", "poses", "speed_profile"}));
}

TEST(QgisStyles, AreTheSameForTheSameLayersAndGoWithThem) {
  const StyledMap place;
  EXPECT_TRUE(check_map(place.map).problems.empty());
  const auto rows = [&] { return MapLayers(place.map).read_table("layer_styles").rows; };
  const auto before = rows();
  const auto digest = [&] { return load_meta(place.map).table_digests.at("layer_styles"); };
  const std::string digest_before = digest();
  {
    MapUpdate update(place.map);
    update.write_layer(MapLayers(place.map).read_layer("lanes"));
    update.commit();
  }
  EXPECT_EQ(rows(), before);
  EXPECT_EQ(digest(), digest_before);
  {
    MapUpdate update(place.map);
    update.remove("crossings");
    update.commit();
  }
  EXPECT_EQ(rows().size(), before.size() - 1);
  EXPECT_TRUE(check_map(place.map).problems.empty());
  // GDAL lists the styles as a table; roadbook does not list them as a layer.
  EXPECT_NE(
      output_of("ogrinfo -ro -so " + place.map.string() + " layer_styles").find("styleQML: String"),
      std::string::npos);
  for (const LayerInfo& layer : MapLayers(place.map).list()) EXPECT_NE(layer.name, "layer_styles");
  export_map(place.map, "gpkg", place.folder / "layers.gpkg");
  EXPECT_NE(
      output_of("ogrinfo -ro -so " + (place.folder / "layers.gpkg").string() + " layer_styles")
          .find("Feature Count: " + std::to_string(before.size() - 1)),
      std::string::npos);
}

TEST(QgisProject, NamesLayersThatAreThereFromWhereverItLies) {
  const StyledMap place;
  std::filesystem::create_directory(place.folder / "projects");
  for (const char* name : {"place.qgs", "projects/other.qgs"}) {
    SCOPED_TRACE(name);
    const auto file = place.folder / name;
    EXPECT_EQ(export_map(place.map, "qgis", file), std::vector{file});
    EXPECT_EQ(output_of("xmllint --noout " + file.string()), "");
    const std::string text = read_file(file);
    const auto sources = matches(text, "<datasource>([^<]*)</datasource>");
    EXPECT_EQ(sources, matches(text, "<layer-tree-layer [^>]* source=\"([^\"]*)\""));
    EXPECT_EQ(sources.size(), MapLayers(place.map).list().size());
    EXPECT_EQ(matches(text, "<maplayer[^>]*>\\s*<id>([^<]*)</id>"),
              matches(text, "<layer-tree-layer id=\"([^\"]*)\""));
    const std::string map = std::string(name) == "place.qgs" ? "./place.gpkg" : "../place.gpkg";
    for (const std::string& source : sources) {
      const auto bar = source.find("|layername=");
      const std::string command =
          bar == std::string::npos
              ? "gdalinfo '" + source + "'"
              : "ogrinfo -ro -so '" + source.substr(0, bar) + "' " + source.substr(bar + 11);
      EXPECT_NE(source.find(map), std::string::npos) << source;
      int status = -1;
      const std::string output =
          output_of("cd " + file.parent_path().string() + " && " + command, &status);
      EXPECT_EQ(status, 0) << output;
      EXPECT_NE(output.find("roadbook local frame"), std::string::npos) << output;
    }
    // The overhead image lies under all others and is shown.
    EXPECT_EQ(sources.back(), "GPKG:" + map + ":overhead");
    EXPECT_NE(text.find("overhead\" providerKey=\"gdal\" checked=\"Qt::Checked\""),
              std::string::npos);
    EXPECT_NE(text.find("<Absolute type=\"bool\">false</Absolute>"), std::string::npos);
  }
}

TEST(QgisProject, PackedItIsTheSameAndItsBytesAreToo) {
  const StyledMap place;
  export_map(place.map, "qgis", place.folder / "place.qgs");
  export_map(place.map, "qgis", place.folder / "place.qgz");
  const std::string packed = read_file(place.folder / "place.qgz");
  EXPECT_EQ(output_of("python3 -c \"import sys, zipfile; z = zipfile.ZipFile('" +
                      (place.folder / "place.qgz").string() +
                      "'); assert z.namelist() == ['place.qgs']; "
                      "sys.stdout.buffer.write(z.read('place.qgs'))\""),
            read_file(place.folder / "place.qgs"));
  export_map(place.map, "qgis", place.folder / "place.qgz");
  EXPECT_EQ(read_file(place.folder / "place.qgz"), packed);
  EXPECT_THROW(export_map(place.map, "qgis", place.folder / "place.xml"), InvalidOption);
}

// GDAL's own tools combine the vector layers, the rasters and the GeoTIFFs of a map.
TEST(MapFrame, RastersAreCutAlongVectorLayers) {
  const StyledMap place;
  const auto cut = [&](const std::string& raster, const std::filesystem::path& lines) {
    const auto clip = place.folder / "clip.tif";
    std::filesystem::remove(clip);
    const std::string text =
        output_of("gdalwarp -q -cutline " + lines.string() +
                  " -cl parking_spaces -crop_to_cutline " + raster + " " + clip.string());
    EXPECT_EQ(text, "");
    return output_of("gdalinfo " + clip.string());
  };
  export_map(place.map, "geotiff", place.folder / "overhead.tif", {.layers = {"overhead"}});
  export_map(place.map, "gpkg", place.folder / "layers.gpkg");
  for (const std::string& raster :
       {"GPKG:" + place.map.string() + ":overhead", (place.folder / "overhead.tif").string()})
    for (const auto& lines : {place.map, place.folder / "layers.gpkg"}) {
      const std::string info = cut(raster, lines);
      EXPECT_NE(info.find("Size is 125, 50"), std::string::npos) << info;  // 5 x 2 m at 4 cm
      EXPECT_NE(info.find("roadbook local frame"), std::string::npos) << info;
    }
}

// In files of earlier versions, vector layers have a named datum and rasters have none.
TEST(MapFrame, ChangesOfAnOlderMapUniteItsTwoDefinitions) {
  const StyledMap place;
  const SqlDatabase database(place.map, SqlMode::kReadWrite);
  const auto definitions = [&] {
    return database.value(
        "SELECT group_concat(DISTINCT definition) FROM gpkg_spatial_ref_sys WHERE srs_id > 99999");
  };
  const std::string today = definitions();
  EXPECT_EQ(today.find("LOCAL_CS", 1), std::string::npos) << today;
  database.run(
      "UPDATE gpkg_spatial_ref_sys SET definition = 'LOCAL_CS[\"roadbook local frame\","
      "LOCAL_DATUM[\"roadbook local datum\",32767],UNIT[\"metre\",1],AXIS[\"X\",EAST],"
      "AXIS[\"Y\",NORTH]]' WHERE srs_id = 100000");
  EXPECT_NE(definitions(), today);
  unite_map_frames(database);
  EXPECT_EQ(definitions(), today);
}

}  // namespace
}  // namespace roadbook
