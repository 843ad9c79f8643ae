#pragma once

#include <filesystem>

namespace roadbook::test {

/// The folder of the sources this test was built from (not __FILE__, which a compiler cache may
/// write relative to the build).
std::filesystem::path source_tree();

}  // namespace roadbook::test
