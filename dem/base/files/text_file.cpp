#include "dem/base/files/text_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

#include "dem/base/error.h"

namespace granrad {

void write_text_file(const std::filesystem::path& file, const std::string& text) {
  std::error_code failure;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), failure);
  const auto temporary = file.string() + fmt::format(".tmp{}", getpid());
  std::FILE* stream = std::fopen(temporary.c_str(), "w");
  if (!stream)
    throw IoError(fmt::format("{}: cannot write ({})", file.string(),
                              failure ? failure.message() : std::strerror(errno)));
  const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  const int write_errno = errno;
  const bool closed = std::fclose(stream) == 0;
  if (!written || !closed) {
    const int why = written ? errno : write_errno;
    std::remove(temporary.c_str());
    throw IoError(fmt::format("{}: cannot write ({})", file.string(), std::strerror(why)));
  }
  put_in_place(temporary, file);
}

void put_in_place(const std::filesystem::path& temporary, const std::filesystem::path& file) {
  std::error_code failure;
  const int descriptor = ::open(temporary.c_str(), O_RDONLY);
  if (descriptor < 0 || ::fsync(descriptor) != 0) failure.assign(errno, std::generic_category());
  if (descriptor >= 0) ::close(descriptor);
  if (!failure) std::filesystem::rename(temporary, file, failure);
  if (failure) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw IoError(fmt::format("{}: cannot write ({})", file.string(), failure.message()));
  }
}

std::string read_text_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  if (!in || std::filesystem::is_directory(file))
    throw IoError(fmt::format("{}: cannot be read", file.string()));
  return text.str();
}

std::uint64_t text_hash(const std::string& text) {
  std::uint64_t hash = 14695981039346656037ull;
  for (unsigned char c : text) hash = (hash ^ c) * 1099511628211ull;
  return hash;
}

}  // namespace granrad
