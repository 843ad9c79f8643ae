#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <atomic>
#include <thread>
#include <vector>

#include "mapping/store/map_check.hpp"
#include "mapping/store/map_file_sqlite.hpp"
#include "tests/semantics/label_store_fixture.hpp"

// A step that fails, or a full disk. The labels in memory are those on the disk. Each caller learns
// whether the store saved its change.

namespace roadbook {
namespace {

using namespace std::chrono_literals;

class LabelStoreTrouble : public test::LabelStoreTest {
 protected:
  LabelStoreTrouble() {
    ::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &was_);
  }
  ~LabelStoreTrouble() override { make_room(); }

  /// Limits every file to the present size of the map, like a full disk.
  void fill_disk() const {
    rlimit full = was_;
    full.rlim_cur = std::filesystem::file_size(map_);
    setrlimit(RLIMIT_FSIZE, &full);
  }
  void make_room() const { setrlimit(RLIMIT_FSIZE, &was_); }

  Label long_note(const LabelStore& store) const {
    Label label = space(store, 1.0);
    label.note = std::string(900, 'x');
    return label;
  }
  /// A valid label that is not valid JSON. Storing it fails at the write, after the first label of
  /// the row.
  Label no_text(const LabelStore& store) const {
    Label label = space(store, 2.0);
    label.note = "\xff";
    return label;
  }
  /// Another program reads the map while `begin` starts threads. The changes of these threads have
  /// to wait together.
  template <class Begin>
  void while_somebody_reads(const Begin& begin) const {
    const SqlDatabase reader(map_, SqlMode::kRead);
    reader.run("BEGIN");
    static_cast<void>(reader.value("SELECT count(*) FROM map_meta"));
    begin();
    std::this_thread::sleep_for(500ms);
    reader.run("COMMIT");
  }
  void expect_as_on_the_disk(const LabelStore& store) const {
    const auto stored = read_label_events(map_);
    const auto known = store.events();
    ASSERT_EQ(stored.size(), known.size());
    for (std::size_t i = 0; i < known.size(); ++i) {
      EXPECT_EQ(stored[i].event, known[i].event);
      EXPECT_EQ(stored[i].label.id, known[i].label.id);
      EXPECT_EQ(stored[i].label.who, known[i].label.who);
    }
    EXPECT_TRUE(check_map(map_).problems.empty());
  }

 private:
  rlimit was_{};
};

TEST_F(LabelStoreTrouble, AFullDiskStoresNothingOfWhatItRefusesAndLosesNothingElse) {
  std::size_t stored = 0;
  std::size_t refused = 0;
  {
    LabelStore store(map_);
    fill_disk();
    const Label label = long_note(store);
    for (int i = 0; i < 12; ++i) {
      try {
        store.create(label, "ann", "r" + std::to_string(i));
        ++stored;
      } catch (const StorageError&) {
        ++refused;
      }
      EXPECT_EQ(store.labels().size(), stored);
    }
    make_room();
    EXPECT_GT(refused, 0U);
    // The disk has room again. Each request is sent again: the store saves the refused ones, and it
    // does not save the others twice.
    for (int i = 0; i < 12; ++i) store.create(label, "ann", "r" + std::to_string(i));
    EXPECT_EQ(store.labels().size(), 12U);
  }
  EXPECT_EQ(read_labels(map_).size(), 12U);
  EXPECT_TRUE(check_map(map_).problems.empty());
}

TEST_F(LabelStoreTrouble, AFullDiskIsToldToAllWhoseChangesWaitTogether) {
  std::atomic<int> refused = 0;
  {
    LabelStore store(map_);
    std::vector<std::thread> people;
    const auto create = [&](const std::string& who) {
      try {
        store.create_all({long_note(store), long_note(store)}, who, "row");
      } catch (const StorageError&) {
        ++refused;
      }
    };
    while_somebody_reads([&] {
      fill_disk();
      for (int i = 0; i < 8; ++i) people.emplace_back(create, "p" + std::to_string(i));
    });
    for (auto& p : people) p.join();
    make_room();
    EXPECT_GE(refused, 7);  // the first request may use the last free bytes of a page
    EXPECT_EQ(store.labels().size(), 2U * static_cast<std::size_t>(8 - refused));
    expect_as_on_the_disk(store);
    // Each request is sent again and stored once.
    refused = 0;
    for (int i = 0; i < 8; ++i) create("p" + std::to_string(i));
    EXPECT_EQ(refused, 0);
    EXPECT_EQ(store.labels().size(), 16U);
    expect_as_on_the_disk(store);
  }
  EXPECT_EQ(read_labels(map_).size(), 16U);
}

TEST_F(LabelStoreTrouble, AStepThatFailsMidwayLeavesNothingOfItAndAllOfTheOthers) {
  LabelStore store(map_);
  store.create(space(store, 0.0), "ann", "first");
  EXPECT_ANY_THROW(store.create_all({space(store, 1.0), no_text(store)}, "ann", "row"));
  EXPECT_EQ(store.labels().size(), 1U);
  expect_as_on_the_disk(store);
  // In one turn, some steps fail and others succeed.
  std::atomic<int> failed = 0;
  std::vector<std::thread> people;
  while_somebody_reads([&] {
    for (int i = 0; i < 9; ++i)
      people.emplace_back([&, i] {
        try {
          store.create_all({space(store, 1.0), i % 3 == 1 ? no_text(store) : space(store, 4.0)},
                           "p" + std::to_string(i), "row");
        } catch (const std::exception&) {
          ++failed;
        }
      });
  });
  for (auto& p : people) p.join();
  EXPECT_EQ(failed, 3);
  ASSERT_EQ(store.labels().size(), 13U);
  EXPECT_EQ(store.labels().back().id, 13);
  for (const Label& label : store.labels())
    EXPECT_TRUE(label.who == "ann" || (label.who.back() - '0') % 3 != 1) << label.who;
  expect_as_on_the_disk(store);
  // A failed step is not in the history: undo reverts the step before it.
  EXPECT_EQ(store.undo("ann").at(0).id, 1);
  EXPECT_TRUE(store.undo("p1").empty());
}

}  // namespace
}  // namespace roadbook
