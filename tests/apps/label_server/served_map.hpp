#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>

#include "apps/label_server/label_api.hpp"

namespace roadbook::test {

/// The labelling server without its sockets, on the map of a folder that goes with the test.
class ServedMap : public ::testing::Test {
 protected:
  explicit ServedMap(const PersonLearnerOptions& options = {}) : options_(options) {
    std::filesystem::create_directories(folder_);
  }
  ~ServedMap() override {
    close();
    std::filesystem::remove_all(folder_);
  }
  void open() {
    place_ = read_label_place(map_);
    store_ = std::make_unique<LabelStore>(map_);
    views_ = std::make_unique<AnchorViews>(&store_->map(), &drives_);
    tiles_ = std::make_unique<TilePyramid>(place_.image);
    images_ = std::make_unique<PeopleImages>(&store_->map(), &drives_, options_, 0.4);
    service_ = std::make_unique<LabelService>(store_.get(), &hub_, images_.get(), place_.classes);
    learning_ =
        std::make_unique<Learning>(place_.image, BoxLearnerOptions(), service_.get(), &hub_);
    people_ = std::make_unique<PeopleLearning>(
        images_.get(), service_.get(), &hub_, place_.people, options_, place_.people_record,
        [this](const PeopleRecord& record) { store_->write_table(people_record_table(record)); });
    paint_ = std::make_unique<PaintWatch>(service_.get(), KeyframeImages(), &hub_);
    api_ = std::make_unique<LabelApi>(LabelApi::Parts{&place_, "1", tiles_.get(), views_.get(),
                                                      service_.get(), learning_.get(),
                                                      people_.get(), paint_.get(), &hub_, "ann"});
  }
  void close() {
    api_.reset();
    people_.reset();
    paint_.reset();
    learning_.reset();
    service_.reset();
    images_.reset();
    store_.reset();
  }

  PersonLearnerOptions options_;
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() /
      ("label_server." + std::to_string(getpid()) + "." +
       ::testing::UnitTest::GetInstance()->current_test_info()->name());
  const std::filesystem::path map_ = folder_ / "lot.gpkg";
  std::vector<std::optional<Drive>> drives_;
  LabelPlace place_;
  EventHub hub_;
  std::unique_ptr<LabelStore> store_;
  std::unique_ptr<AnchorViews> views_;
  std::unique_ptr<TilePyramid> tiles_;
  std::unique_ptr<PeopleImages> images_;
  std::unique_ptr<LabelService> service_;
  std::unique_ptr<Learning> learning_;
  std::unique_ptr<PeopleLearning> people_;
  std::unique_ptr<PaintWatch> paint_;
  std::unique_ptr<LabelApi> api_;
};

}  // namespace roadbook::test
