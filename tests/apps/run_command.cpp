#include "tests/apps/run_command.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace roadbook::test {

namespace fs = std::filesystem;

std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << text;
}

CommandResult run_command(const std::string& command, const fs::path& folder) {
  const ScratchFolder outputs;
  const std::string program_folder = fs::path(ROADBOOK_PROGRAM).parent_path().string();
  const std::string line = "cd '" + folder.string() + "' && export PATH='" + program_folder +
                           "':\"$PATH\" && { " + command + "\n} > '" +
                           (outputs.path() / "out").string() + "' 2> '" +
                           (outputs.path() / "err").string() + "' < /dev/null";
  const int raw = std::system(line.c_str());
  CommandResult result;
  result.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
  result.out = read_text(outputs.path() / "out");
  result.err = read_text(outputs.path() / "err");
  return result;
}

ScratchFolder::ScratchFolder() {
  std::string name = (fs::temp_directory_path() / "roadbook_test_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no scratch folder");
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace roadbook::test
