#include "tests/apps/running_program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <sstream>
#include <vector>

namespace roadbook::test {

RunningProgram::RunningProgram(const std::string& arguments, const std::filesystem::path& folder) {
  std::vector<std::string> words{"roadbook"};
  std::istringstream list(arguments);
  for (std::string word; list >> word;) words.push_back(word);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const std::string out = (outputs_.path() / "out").string();
  const std::string err = (outputs_.path() / "err").string();
  pid_ = fork();
  if (pid_ != 0) return;
  const int mode = O_WRONLY | O_CREAT | O_TRUNC;
  const bool ready = chdir(folder.c_str()) == 0 && dup2(open(out.c_str(), mode, 0600), 1) == 1 &&
                     dup2(open(err.c_str(), mode, 0600), 2) == 2;
  if (ready) execv(ROADBOOK_PROGRAM, pointers.data());
  _exit(127);
}

RunningProgram::~RunningProgram() {
  if (has_ended_ || pid_ <= 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, &status_, 0);
}

bool RunningProgram::is_running() {
  if (!has_ended_) has_ended_ = waitpid(pid_, &status_, WNOHANG) == pid_;
  return !has_ended_;
}

void RunningProgram::hold() const { kill(pid_, SIGSTOP); }
void RunningProgram::go_on() const { kill(pid_, SIGCONT); }
void RunningProgram::kill_now() const { kill(pid_, SIGKILL); }

CommandResult RunningProgram::wait() {
  if (!has_ended_) waitpid(pid_, &status_, 0);
  has_ended_ = true;
  CommandResult result;
  result.status = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
  result.out = read_text(outputs_.path() / "out");
  result.err = read_text(outputs_.path() / "err");
  return result;
}

}  // namespace roadbook::test
