#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "mapping/store/map_file.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/apps/shared_drives.hpp"

namespace roadbook::test {

/// Three short drives, a map of the first, and one with all layers that the verbs need.
struct Place {
  Place() {
    for (const char* name : {"a", "b", "c"}) {
      const std::string visit = std::to_string(name[0] - 'a');
      const auto drive = simulate_drive(
          "zurich --size small --max-duration-s 6 --image-scale 0.5 --visit " + visit,
          folder.path() / name);
      EXPECT_EQ(drive.status, 0) << drive.err;
    }
    make("map a -m a.gpkg");
    std::filesystem::copy_file(folder.path() / "a.gpkg", folder.path() / "full.gpkg");
    make("roads -m full.gpkg");
  }
  void make(const std::string& arguments) const {
    const auto made = run_command("roadbook " + arguments + " -q", folder.path());
    EXPECT_EQ(made.status, 0) << arguments << ": " << made.err;
  }
  static const Place& of_all_tests() {
    static const Place place;
    return place;
  }

  ScratchFolder folder;
};

inline std::set<std::string> sessions_of(const std::filesystem::path& map) {
  std::set<std::string> names;
  for (const Session& session : load_map(map).sessions) names.insert(session.name);
  return names;
}

/// Makes m.gpkg a copy of another map of the folder.
inline void copy_map(const std::filesystem::path& folder, const std::string& from) {
  for (const char* rest : {"m.gpkg", "m.gpkg.part", "m.gpkg.new"})
    std::filesystem::remove(folder / rest);
  std::filesystem::copy_file(folder / from, folder / "m.gpkg");
}

}  // namespace roadbook::test
