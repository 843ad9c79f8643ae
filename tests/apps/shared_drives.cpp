#include "tests/apps/shared_drives.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace roadbook::test {

namespace fs = std::filesystem;

namespace {

// Held by one process at a time; a process that ends leaves none behind.
class FileLock {
 public:
  explicit FileLock(const fs::path& file)
      : descriptor_(::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644)) {
    if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX) != 0)
      throw std::runtime_error("no lock: " + file.string());
  }
  ~FileLock() { ::close(descriptor_); }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_;
};

// Distinguishes builds of the program.
std::string name_of_program() {
  const fs::path program = ROADBOOK_PROGRAM;
  return std::to_string(fs::file_size(program)) + "_" +
         std::to_string(fs::last_write_time(program).time_since_epoch().count());
}

// The folder for drives of this build. Removes those of earlier builds.
fs::path folder_of_drives() {
  const fs::path all = ROADBOOK_TEST_DRIVES;
  const fs::path folder = all / name_of_program();
  fs::create_directories(all);
  const FileLock lock(all / "lock");
  if (fs::exists(folder)) return folder;
  for (const auto& entry : fs::directory_iterator(all))
    if (entry.is_directory()) fs::remove_all(entry.path());
  fs::create_directory(folder);
  return folder;
}

std::string file_name_of(std::string arguments) {
  for (char& c : arguments) {
    if (c == ' ')
      c = '+';
    else if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '.' && c != '_')
      throw std::invalid_argument("arguments of a shared drive: " + arguments);
  }
  return arguments;
}

}  // namespace

CommandResult simulate_drive(const std::string& arguments, const fs::path& drive) {
  const fs::path folder = folder_of_drives();
  const std::string name = file_name_of(arguments);
  const fs::path shared = folder / name;
  const fs::path out = folder / (name + ".json");
  CommandResult result;
  {
    const FileLock lock(folder / (name + ".lock"));
    if (!fs::exists(shared)) {
      fs::remove_all(folder / (name + ".part"));
      result =
          run_command("roadbook simulate " + arguments + " --json -q -o " + name + ".part", folder);
      if (result.status != 0) return result;
      write_text(out, result.out);
      fs::rename(folder / (name + ".part"), shared);
    }
  }
  result.status = 0;
  result.out = read_text(out);
  fs::copy(shared, drive, fs::copy_options::recursive);
  return result;
}

CommandResult run_example(const std::string& command,
                          const std::string& options,
                          const fs::path& folder) {
  const std::string simulate = "roadbook simulate ";
  const std::size_t out = command.find(" -o ");
  if (!command.starts_with(simulate) || out == std::string::npos)
    return run_command(command + options, folder);
  return simulate_drive(command.substr(simulate.size(), out - simulate.size()),
                        folder / command.substr(out + 4));
}

}  // namespace roadbook::test
