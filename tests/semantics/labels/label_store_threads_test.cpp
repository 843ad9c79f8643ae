#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <fstream>
#include <set>
#include <thread>

#include "mapping/store/map_file_sqlite.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/semantics/label_store_fixture.hpp"

// Several threads change the labels of a map at the same time.

namespace roadbook {
namespace {

using test::LabelStoreTest;

TEST_F(LabelStoreTest, ManyAtOnceLoseAndDoubleNothing) {
  LabelStore store(map_);
  std::vector<std::thread> people;
  for (int person = 0; person < 4; ++person)
    people.emplace_back([&, person] {
      for (int i = 0; i < 20; ++i)
        store.create(space(store, 0.1 * i), "p" + std::to_string(person));
    });
  for (auto& p : people) p.join();
  std::set<std::int64_t> ids;
  for (const Label& label : store.labels()) ids.insert(label.id);
  EXPECT_EQ(ids.size(), 80U);
  EXPECT_EQ(*ids.rbegin(), 80);
}

// Number of changes of the file. SQLite counts transactions in its header.
std::uint32_t transactions_of(const std::filesystem::path& map) {
  std::array<char, 4> bytes{};
  std::ifstream file(map, std::ios::binary);
  file.seekg(24).read(bytes.data(), bytes.size());
  std::uint32_t count = 0;
  for (const char byte : bytes) count = count << 8U | static_cast<unsigned char>(byte);
  return count;
}

TEST_F(LabelStoreTest, ManyThatWaitForAReaderAreStoredTogether) {
  LabelStore store(map_);
  const std::uint32_t before = transactions_of(map_);
  std::vector<std::thread> people;
  {
    const SqlDatabase reader(map_, SqlMode::kRead);  // another program reads with SQLite
    reader.run("BEGIN");
    static_cast<void>(reader.value("SELECT count(*) FROM map_meta"));
    for (int person = 0; person < 8; ++person)
      people.emplace_back(
          [&, person] { store.create(space(store, 0.1), "p" + std::to_string(person)); });
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    EXPECT_EQ(transactions_of(map_), before);
    reader.run("COMMIT");
  }
  for (auto& p : people) p.join();
  EXPECT_EQ(store.labels().size(), 8U);
  EXPECT_LE(transactions_of(map_) - before, 2U);  // the first alone, then the seven that waited
}

}  // namespace
}  // namespace roadbook
