#include "semantics/labels/label_layers.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "base/error.hpp"
#include "mapping/store/map_check.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/mapping/store/small_map.hpp"
#include "tests/semantics/label_map.hpp"

namespace roadbook {
namespace {

class LabelLayers : public ::testing::Test {
 protected:
  LabelLayers() { MapFileBuilder(map_, "key").finish(test::label_map(20), {}); }

  static Label space(const Map& map, double x, const std::string& kind) {
    Label label = label_of_box(map, {0, map.keyframes[3].t_ns, 1}, {{x, 5.0}, 0.4, 5.0, 2.5});
    label.kind = kind;
    return label;
  }
  static Label crossing(const Map& map) {
    Label label = label_of_polygon(map, {0, map.keyframes[3].t_ns, 1}, {{1, 3}, {3, 3}, {2, 5}});
    label.kind = "crossing";
    return label;
  }

  test::Folder folder_;
  std::filesystem::path map_ = folder_ / "map.gpkg";
};

double number(const VectorLayer& layer, std::size_t feature, const std::string& field) {
  return std::get<double>(layer.features.at(feature).values.at(*layer.field(field)));
}

// If the server is killed, the labels are stored, but the layers are from before.
TEST_F(LabelLayers, AreCurrentUntilALabelIsOtherwise) {
  EXPECT_TRUE(label_layers_are_current(map_)) << "without labels";
  const auto expect_stale_then_current = [&] {
    EXPECT_FALSE(label_layers_are_current(map_));
    renew_label_layers(map_);
    EXPECT_TRUE(label_layers_are_current(map_));
  };
  const auto change = [&](const auto& how) {
    LabelStore store(map_);
    how(store);
  };
  change([](LabelStore& store) { store.create(space(store.map(), 1.0, "parking_space"), "ann"); });
  expect_stale_then_current();
  change([](LabelStore& store) { store.change(*store.find(1), "ann"); });
  expect_stale_then_current();
  change([](LabelStore& store) { store.create(crossing(store.map()), "ann"); });
  expect_stale_then_current();
  change([](LabelStore& store) { store.remove(2, 1, "ann"); });
  expect_stale_then_current();
}

TEST_F(LabelLayers, HoldSpacesCrossingsAndOtherThingsWhereTheyAreButNoRejections) {
  {
    LabelStore store(map_);
    const Map& m = store.map();
    store.create_all({space(m, 1.0, "parking_space"), crossing(m),
                      space(m, 4.0, rejected_kind("parking_space")), space(m, 7.0, "loading_bay")},
                     "ann");
  }
  renew_label_layers(map_);
  EXPECT_TRUE(check_map(map_).problems.empty());
  const MapLayers layers(map_);
  const VectorLayer spaces = layers.read_layer("parking_spaces");
  ASSERT_EQ(spaces.features.size(), 1U);
  EXPECT_EQ(std::get<std::int64_t>(spaces.features[0].values.at(*spaces.field("space"))), 1);
  EXPECT_EQ(number(spaces, 0, "length_m"), 5.0);
  EXPECT_NEAR(number(spaces, 0, "heading_rad"), 0.4, 1e-9);
  EXPECT_EQ(number(spaces, 0, "coverage"), 1.0);
  const Label label = *LabelStore(map_).find(1);
  const Map map = load_map(map_);
  const auto corners = corners_in_map(map, label);
  ASSERT_EQ(spaces.features[0].points.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR((spaces.features[0].points[i].head<3>() - corners[i % 4]).norm(), 0.0, 1e-9);
  // The longer axis of the ellipse, computed by hand.
  const Eigen::Matrix2d c = *covariance_in_map(map, label);
  const double half = 0.5 * (c(0, 0) - c(1, 1));
  EXPECT_NEAR(number(spaces, 0, "sigma_m"),
              std::sqrt(0.5 * c.trace() + std::sqrt(half * half + c(0, 1) * c(0, 1))), 1e-9);
  EXPECT_EQ(layers.read_layer("crossings").features.size(), 1U);
  const VectorLayer other = layers.read_layer("other_labels");
  ASSERT_EQ(other.features.size(), 1U);
  EXPECT_EQ(other.features[0].values.at(*other.field("class")), FieldValue("loading_bay"));
  EXPECT_EQ(layers.read_table("label_classes").rows.size(), 2U);
}

TEST_F(LabelLayers, OfTodayAreWhatTheLabelsSayWhateverIsStored) {
  const auto stored = [&] { return MapLayers(map_).read_layer("parking_spaces").features.size(); };
  {
    LabelStore store(map_);
    store.create(space(store.map(), 1.0, "parking_space"), "ann");
  }
  renew_label_layers(map_);
  {
    LabelStore store(map_);  // a killed server: no program has renewed the layers
    store.create(space(store.map(), 4.0, "parking_space"), "ann");
  }
  EXPECT_EQ(stored(), 1U);
  {
    const MapLayers layers(map_);
    const auto today = label_layers_of_today(layers);
    EXPECT_EQ(layer_of_today(layers, today, "parking_spaces")->features.size(), 2U);
    EXPECT_FALSE(layer_of_today(layers, today, "crossings"));
  }
  {
    LabelStore store(map_);
    for (const Label& label : store.labels()) store.remove(label.id, label.version, "ann");
  }
  const MapLayers layers(map_);
  EXPECT_FALSE(layer_of_today(layers, label_layers_of_today(layers), "parking_spaces"));
  renew_label_layers(map_);
  EXPECT_FALSE(MapLayers(map_).has("parking_spaces"));
}

TEST_F(LabelLayers, ADiskTooFullForThemIsNotFilledWithHalfACopy) {
  {
    LabelStore store(map_);
    store.create(space(store.map(), 1.0, "parking_space"), "ann");
  }
  ::signal(SIGXFSZ, SIG_IGN);
  rlimit was{};
  getrlimit(RLIMIT_FSIZE, &was);
  rlimit full = was;
  full.rlim_cur = std::filesystem::file_size(map_) / 2;
  setrlimit(RLIMIT_FSIZE, &full);
  EXPECT_THROW(renew_label_layers(map_), StorageError);
  setrlimit(RLIMIT_FSIZE, &was);
  for (const auto& entry : std::filesystem::directory_iterator(map_.parent_path()))
    EXPECT_EQ(entry.path().extension(), ".gpkg") << entry.path();
  renew_label_layers(map_);
  EXPECT_TRUE(MapLayers(map_).has("parking_spaces"));
}

TEST_F(LabelLayers, LeaveALayerOfPlacesAloneThatCameFromElsewhere) {
  VectorLayer truth{
      "parking_spaces", "surveyed", GeometryType::kPolygonZ, {{"source", FieldType::kText}}, {}};
  truth.features.push_back(
      {{{0, 0, 0, 0}, {5, 0, 0, 0}, {5, 2, 0, 0}, {0, 0, 0, 0}}, {std::string("survey")}});
  {
    MapUpdate update(map_);
    update.write_layer(truth);
    update.commit();
  }
  {
    LabelStore store(map_);
    store.create(crossing(store.map()), "ann");
  }
  renew_label_layers(map_);
  const MapLayers layers(map_);
  EXPECT_EQ(layers.read_layer("parking_spaces").features[0].values[0], FieldValue("survey"));
  EXPECT_TRUE(layer_of_today(layers, label_layers_of_today(layers), "parking_spaces"));
  EXPECT_EQ(layers.read_layer("crossings").features.size(), 1U);
}

TEST_F(LabelLayers, ClassesAreTheMapsOwnAndOutliveABuild) {
  EXPECT_EQ(read_label_classes(MapLayers(map_)).size(), 2U);
  const std::vector<LabelClass> mine{{"parking_space", "Stellplatz", "#112233", true},
                                     {"island", "island", "#abcdef", false}};
  {
    LabelStore store(map_);
    store.write_table(label_class_table(mine));
  }
  EXPECT_TRUE(check_map(map_).problems.empty());
  MapFileBuilder(map_, "other").finish(test::label_map(25), {});
  const auto classes = read_label_classes(MapLayers(map_));
  ASSERT_EQ(classes.size(), 2U);
  EXPECT_EQ(classes[0].title, "Stellplatz");
  EXPECT_EQ(classes[1].colour, "#abcdef");
  EXPECT_FALSE(classes[1].box);
}

TEST_F(LabelLayers, WrongClassesAreRefusedWithTheirFault) {
  const auto fault = [&](const LabelClass& c) -> std::string {
    {
      MapUpdate update(map_);
      update.write_table(label_class_table({c}));
      update.commit();
    }
    try {
      static_cast<void>(read_label_classes(MapLayers(map_)));
    } catch (const BadInput& bad) {
      return bad.what();
    }
    return "taken";
  };
  EXPECT_NE(fault({"a", "a", "red", true}).find("colour 'red'"), std::string::npos);
  EXPECT_NE(fault({"not_a", "a", "#112233", true}).find("not_"), std::string::npos);
  EXPECT_NE(fault({"a", "", "#112233", true}).find("title"), std::string::npos);
}

TEST_F(LabelLayers, AMapThatTakesThePlaceOfALabelledOneHasThemWhereItsPosesAre) {
  {
    LabelStore store(map_);
    store.create_all({space(store.map(), 1.0, "parking_space"), crossing(store.map())}, "ann");
  }
  Map bent = load_map(map_);
  for (MapFrame& frame : bent.map_frames) frame.T_map_frame.translation().x() += 0.7;
  MapFinishOptions options;
  options.layers = label_layers(bent, read_labels(map_));
  MapFileBuilder(map_, "bent").finish(bent, {}, options);
  EXPECT_TRUE(check_map(map_).problems.empty());
  const MapLayers layers(map_);
  const VectorLayer spaces = layers.read_layer("parking_spaces");
  const auto today = label_layers_of_today(layers);
  ASSERT_EQ(spaces.features.size(), 1U);
  EXPECT_EQ(spaces.features[0].points, today.at(0).features[0].points);
  double middle = 0.0;
  for (std::size_t i = 0; i < 4; ++i) middle += 0.25 * spaces.features[0].points[i].x();
  EXPECT_NEAR(middle, 1.7, 1e-6);
  EXPECT_TRUE(layers.has("crossings"));
}

}  // namespace
}  // namespace roadbook
