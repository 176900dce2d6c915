#include "dem/io/snapshot.h"

#include <fmt/core.h>

#include <fstream>

#include "dem/base/error.h"
#include "dem/io/import_csv.h"
#include "dem/io/import_dump.h"

namespace granrad {

namespace {

/// The first bytes of a file; throws IoError.
std::string beginning(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || !std::filesystem::is_regular_file(file))
    throw IoError(fmt::format("{}: {}", file.string(),
                              std::filesystem::exists(file) ? "cannot be read" : "there is no such file"));
  std::string bytes(16, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

}  // namespace

Snapshot read_snapshot(const std::filesystem::path& file, double radius_m) {
  const std::string start = beginning(file);
  if (start.starts_with("\x89HDF\r\n\x1a\n") || file.extension() == ".hdf") return read_frame(file);
  if (start.starts_with("ITEM:")) return import_dump(file, radius_m);
  if (start.starts_with("\x1f\x8b"))
    throw InputError(fmt::format("{}: is compressed; unpack it first (gunzip)", file.string()));
  return import_csv(file, radius_m);
}

}  // namespace granrad
