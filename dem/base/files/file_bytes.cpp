#include "dem/base/files/file_bytes.h"

#include <fmt/core.h>
#include <zlib.h>

#include <memory>

#include "dem/base/error.h"

namespace granrad {

namespace {

struct CloseGzip {
  void operator()(gzFile file) const { gzclose(file); }
};

}  // namespace

std::string file_bytes(const std::filesystem::path& file) {
  namespace fs = std::filesystem;
  std::error_code failure;
  if (!fs::exists(file, failure)) throw IoError(fmt::format("{}: there is no such file", file.string()));
  if (fs::is_directory(file, failure)) throw IoError(fmt::format("{}: is a folder", file.string()));
  const std::unique_ptr<gzFile_s, CloseGzip> in(gzopen(file.c_str(), "rb"));
  if (!in) throw IoError(fmt::format("{}: cannot be read", file.string()));
  constexpr unsigned block = 1 << 16;
  gzbuffer(in.get(), block);
  std::string bytes;
  for (int got = 1; got > 0;) {
    const std::size_t before = bytes.size();
    bytes.resize(before + block);
    got = gzread(in.get(), bytes.data() + before, block);
    bytes.resize(before + static_cast<std::size_t>(got > 0 ? got : 0));
  }
  int state = Z_OK;
  gzerror(in.get(), &state);
  if (state != Z_OK && state != Z_STREAM_END)
    throw IoError(fmt::format("{}: cannot be read to its end (damaged, or cut short)", file.string()));
  return bytes;
}

std::optional<std::string> inflated(std::string_view packed, std::size_t size) {
  constexpr std::size_t most_growth =
      1040;  // of the format; more is a false claim, refused before it is allocated
  if (size / most_growth > packed.size()) return {};
  std::string bytes(size, '\0');
  uLongf got = size;
  const int state = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &got,
                               reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  if (state != Z_OK || got != size) return {};
  return bytes;
}

}  // namespace granrad
