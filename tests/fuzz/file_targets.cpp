#include "tests/fuzz/file_targets.h"

#include <fmt/core.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "dem/base/error.h"
#include "dem/base/toml/toml_reader.h"
#include "dem/io/snapshot.h"
#include "dem/mesh/import_stl.h"
#include "dem/scene/scene.h"
#include "fit/correlation/correlation.h"
#include "raytrace/rays/view_factor_file.h"

namespace granrad {

namespace {

/// A file in memory that readers find by its path.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes) : descriptor_(memfd_create("fuzz", 0)) {
    for (std::size_t done = 0; done < bytes.size();) {
      const auto wrote = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
      if (wrote <= 0) break;
      done += static_cast<std::size_t>(wrote);
    }
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  std::filesystem::path path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

 private:
  int descriptor_;
};

template <class Read>
void expect_error_at_most(Read&& read) {
  try {
    read();
  } catch (const Error&) {
  }
}

void feed_snapshot(std::string_view bytes) {
  const MemoryFile file(bytes);
  for (const double radius_m : {0.0, 0.5})
    expect_error_at_most([&] {
      const SnapshotFile all(file.path(), radius_m);
      constexpr std::size_t most = 3;
      for (std::size_t k = 0; k < std::min(most, all.steps().size()); ++k) all.read(k);
    });
}

void feed_frame(std::string_view bytes) {
  const MemoryFile file(bytes);
  expect_error_at_most([&] { read_frame(file.path()); });
}

void feed_view_factors(std::string_view bytes) {
  const MemoryFile file(bytes);
  expect_error_at_most([&] { read_view_factors(file.path()); });
}

void feed_stl(std::string_view bytes) {
  const MemoryFile file(bytes);
  expect_error_at_most([&] { import_stl(file.path(), 0.001, "wall"); });
}

void feed_table(std::string_view bytes) {
  const MemoryFile file(bytes);
  expect_error_at_most([&] { read_correlation(file.path()); });
}

void feed_scene(std::string_view bytes) {
  expect_error_at_most([&] {
    TomlDocument document = TomlDocument::from_string(bytes, "scene.toml");
    read_scene(document);
    document.effective_text();
    document.finish();
  });
}

}  // namespace

const std::vector<FileTarget>& file_targets() {
  static const std::vector<FileTarget> all{
      {"scene", feed_scene},  {"table", feed_table}, {"dump", feed_snapshot},
      {"csv", feed_snapshot}, {"stl", feed_stl},     {"vtk", feed_snapshot},
      {"xyz", feed_snapshot}, {"frame", feed_frame}, {"view_factors", feed_view_factors},
  };
  return all;
}

}  // namespace granrad
