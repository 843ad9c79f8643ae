#include "tests/support/source_tree.hpp"

namespace roadbook::test {

std::filesystem::path source_tree() { return ROADBOOK_SOURCE_TREE; }

}  // namespace roadbook::test
