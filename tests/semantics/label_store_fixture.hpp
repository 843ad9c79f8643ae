#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "mapping/store/map_file_builder.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/semantics/label_map.hpp"

namespace roadbook::test {

/// A small map with a label store. The test removes the map at its end.
class LabelStoreTest : public ::testing::Test {
 protected:
  LabelStoreTest() {
    std::filesystem::create_directories(folder_);
    MapFileBuilder(map_, "key").finish(test::label_map(10), {});
  }
  ~LabelStoreTest() override { std::filesystem::remove_all(folder_); }

  Label space(const LabelStore& store, double x) const {
    Label label =
        label_of_box(store.map(), {0, store.map().keyframes[3].t_ns, 1}, {{x, 5.0}, 0.0, 5.0, 2.5});
    label.kind = "parking_space";
    return label;
  }

  std::filesystem::path folder_ = std::filesystem::temp_directory_path() /
                                  ("label_store." + std::to_string(getpid()) + "." +
                                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
  std::filesystem::path map_ = folder_ / "map.gpkg";
};

}  // namespace roadbook::test
