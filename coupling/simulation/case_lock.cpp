#include "coupling/simulation/case_lock.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "dem/base/error.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

std::string holder(int descriptor) {
  char text[256] = "";
  const auto size = pread(descriptor, text, sizeof text - 1, 0);
  return size > 0 ? std::string(text, size) : "another process";
}

/// Whether the name still leads to the file we opened: its holder removes it at the end.
bool is_still_there(const fs::path& file, int descriptor) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && stat(file.c_str(), &named) == 0 && opened.st_ino == named.st_ino;
}

}  // namespace

std::string host_name() {
  char name[256] = "";
  return gethostname(name, sizeof name - 1) == 0 ? name : "unknown";
}

CaseLock::CaseLock(const fs::path& folder) : file_(folder / file_name) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw IoError(fmt::format("{}: cannot be created ({})", folder.string(), failure.message()));
  for (;;) {
    descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor_ < 0)
      throw IoError(fmt::format("{}: cannot be written ({})", file_.string(), std::strerror(errno)));
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      const int reason = errno;
      const std::string who = holder(descriptor_);
      close(descriptor_);
      if (reason == EWOULDBLOCK)
        throw InputError(advised(fmt::format("{} (in use by {})", folder.string(), who),
                                 "wait until it ends, stop it, or name another folder"));
      throw IoError(fmt::format("{}: cannot be locked ({})", file_.string(), std::strerror(reason)));
    }
    if (is_still_there(file_, descriptor_)) break;
    close(descriptor_);
  }
  const auto text = fmt::format("process {} on {}", getpid(), host_name());
  if (ftruncate(descriptor_, 0) != 0 || pwrite(descriptor_, text.data(), text.size(), 0) < 0) {
    close(descriptor_);
    throw IoError(fmt::format("{}: cannot be written ({})", file_.string(), std::strerror(errno)));
  }
}

CaseLock::~CaseLock() {
  unlink(file_.c_str());
  close(descriptor_);
}

}  // namespace granrad
