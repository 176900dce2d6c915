#include "fit/generate/child_program.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "dem/base/error.h"

namespace granrad {

namespace {

constexpr int cannot_start = 127;  // as a shell says it

}  // namespace

std::string sibling_program(const std::string& name) {
  std::error_code failure;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", failure);
  const auto beside = self.parent_path() / name;
  return !failure && std::filesystem::exists(beside) ? beside.string() : name;
}

int run_child(const std::string& program, const std::vector<std::string>& arguments,
              const std::filesystem::path& log) {
  std::vector<char*> words{const_cast<char*>(program.c_str())};
  for (const auto& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  const int out = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (out < 0) throw IoError(fmt::format("{}: {}", log.string(), std::strerror(errno)));
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) {
    // Killed with us, whatever kills us: a run left alone would hold its folder against the one that resumes it.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(cannot_start);
    dup2(out, 1);
    dup2(out, 2);
    execvp(program.c_str(), words.data());
    _exit(cannot_start);
  }
  close(out);
  if (child < 0) throw IoError(fmt::format("{}: cannot be started ({})", program, std::strerror(errno)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == cannot_start)
    throw IoError(
        advised(fmt::format("{}: cannot be started", program), "install granrun beside vfgen or on PATH"));
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace granrad
