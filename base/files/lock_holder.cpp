#include "base/files/lock_holder.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

#include "base/text.hpp"

namespace roadbook {
namespace {

constexpr std::int64_t kSqliteLockBegin = 0x40000000;  // SQLite's pending byte
constexpr std::size_t kMostText = 120;                 // of a command line in a message

// Returns the words of a process's command line on one line, without control characters.
std::string command_of(const std::string& pid) {
  std::ifstream file("/proc/" + pid + "/cmdline", std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  while (!text.empty() && text.back() == '\0') text.pop_back();
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  const std::size_t words = text.find(' ');
  const std::size_t folder = text.rfind('/', words);
  if (folder != std::string::npos) text.erase(0, folder + 1);
  if (text.size() > kMostText) text = text.substr(0, kMostText) + "...";
  return text;
}

// Returns the process of a line of /proc/locks that locks `inode` as SQLite or FolderLock does;
// empty otherwise.
// `1: POSIX  ADVISORY  WRITE 1234 08:01:5678 1073741824 1073742335`. Lines with "->" only wait.
std::string process_of(const std::string& line, ino_t inode) {
  std::istringstream words(line);
  std::string number;
  std::string kind;
  std::string advice;
  std::string mode;
  std::string pid;
  std::string place;
  std::string begin;
  words >> number >> kind >> advice >> mode >> pid >> place >> begin;
  const std::size_t colon = place.rfind(':');
  if (colon == std::string::npos || place.substr(colon + 1) != std::to_string(inode)) return {};
  if (kind == "FLOCK") return pid;
  return kind == "POSIX" && parse_int(begin).value_or(0) >= kSqliteLockBegin ? pid : std::string();
}

}  // namespace

// The file is not opened: closing it would end the locks that this process has on it.
std::string lock_holder(const std::filesystem::path& file) {
  struct stat status {};
  std::ifstream locks("/proc/locks");
  if (stat(file.c_str(), &status) == 0)
    for (std::string line; std::getline(locks, line);) {
      const std::string pid = process_of(line, status.st_ino);
      if (pid.empty() || pid == "0" || pid == "-1") continue;
      const std::string command = command_of(pid);
      return "process " + pid + (command.empty() ? "" : " (" + command + ")");
    }
  return "another process";
}

}  // namespace roadbook
