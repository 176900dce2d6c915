#include "dem/io/snapshot.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <variant>

#include "dem/base/error.h"
#include "dem/base/files/file_bytes.h"
#include "dem/io/import_csv.h"
#include "dem/io/import_dump.h"
#include "dem/io/import_vtk.h"
#include "dem/io/import_xyz.h"

namespace granrad {

namespace {

constexpr std::string_view hdf5_mark = "\x89HDF\r\n\x1a\n";
constexpr const char* formats_read =
    "read are: frames of granrun (.hdf), CSV with a header x,y,z,radius, LIGGGHTS and LAMMPS text dumps, XYZ and "
    "extended XYZ, VTK (.vtp, .vtu, legacy .vtk); all but frames also packed by gzip (.gz)";

/// Kinds of files that are not read, by their first bytes.
const char* foreign_kind(std::string_view text) {
  const auto starts = [&](std::string_view mark) { return text.starts_with(mark); };
  if (starts("PK\x03\x04")) return "a zip or npz file";
  if (starts("\x28\xB5\x2F\xFD")) return "packed by zstd";
  if (starts("\xFD"
             "7zXZ"))
    return "packed by xz";
  if (starts("BZh")) return "packed by bzip2";
  if (starts("solid ") || starts("solid\n")) return "a mesh (STL)";
  if (starts("ply\n") || starts("ply\r")) return "a mesh (PLY)";
  if (starts("{") || starts("[")) return "JSON";
  if (starts("LAMMPS data file") || starts("LIGGGHTS data file")) return "a LAMMPS data file";
  if (text.substr(0, 4096).find('\0') != text.npos) return "binary";
  return nullptr;
}

bool is_whole_number(std::string_view text) {
  return !text.empty() && text.size() < 19 && std::all_of(text.begin(), text.end(), ::isdigit);
}

/// Names of columns, as far as anyone can tell.
bool is_csv_header(std::string_view line) {
  if (line.find(',') != line.npos) return true;
  std::vector<std::string_view> words;
  split_words(line, words);
  return line.find_first_of(";\t") != line.npos ||
         std::any_of(words.begin(), words.end(), [](auto word) { return word == "x" || word == "X"; });
}

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

/// One snapshot alone in its file.
struct Single {
  Snapshot snapshot;
  std::vector<std::int64_t> step;
  explicit Single(Snapshot read) : snapshot(std::move(read)), step{snapshot.bed.step} {}
  const std::vector<std::int64_t>& steps() const { return step; }
  std::string note() const { return {}; }
  Snapshot read(std::size_t) const { return snapshot; }
};

using AnyFile = std::variant<Single, DumpFile, XyzFile>;

AnyFile open(const std::filesystem::path& file, double radius_m) {
  if (beginning(file).starts_with(hdf5_mark) || file.extension() == ".hdf") return Single(read_frame(file));
  const std::string name = file.string();
  std::string text = file_bytes(file);
  if (text.starts_with("# vtk DataFile")) return Single(import_vtk_legacy(name, text, radius_m));
  TextLines lines(text);
  std::string_view line;
  while (lines.next(line) && (line.empty() || line.front() == '#')) continue;
  if (line.starts_with("ITEM:")) return DumpFile(file, std::move(text), radius_m);
  if (line.starts_with("<?xml") || line.starts_with("<VTKFile"))
    return Single(import_vtk_xml(name, std::string_view(text).substr(text.find('<')), radius_m));
  const char* kind = foreign_kind(text);
  if (!kind && is_whole_number(line)) return XyzFile(name, TextLines(std::move(text)), radius_m);
  if (!kind && (line.empty() || is_csv_header(line)))
    return Single(import_csv(name, TextLines(std::move(text)), radius_m));
  throw InputError(advised(fmt::format("{}: holds no particles in a format that is read{}", name,
                                       kind ? fmt::format(" (it is {})", kind) : ""),
                           formats_read));
}

}  // namespace

struct SnapshotFile::Impl {
  std::string name;
  AnyFile file;
};

SnapshotFile::SnapshotFile(const std::filesystem::path& file, double radius_m)
    : impl_(new Impl{file.string(), open(file, radius_m)}) {}

SnapshotFile::~SnapshotFile() = default;

const std::vector<std::int64_t>& SnapshotFile::steps() const {
  return std::visit(
      [](const auto& file) -> const auto& { return file.steps(); }, impl_->file);
}

std::size_t SnapshotFile::find(const SnapshotChoice& choice) const {
  const auto& all = steps();
  if (choice.kind == SnapshotChoice::Kind::first) return 0;
  if (choice.kind == SnapshotChoice::Kind::last) return all.size() - 1;
  const auto found = std::find(all.begin(), all.end(), choice.step);
  if (found != all.end()) return static_cast<std::size_t>(found - all.begin());
  constexpr std::size_t shown = 12;
  const std::vector<std::int64_t> some(
      all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(shown, all.size())));
  throw InputError(fmt::format("{}: holds no step {}; there are {}{}", impl_->name, choice.step,
                               fmt::join(some, ", "),
                               all.size() > shown ? fmt::format(", ... {}", all.back()) : ""));
}

Snapshot SnapshotFile::read(std::size_t k) const {
  return std::visit(
      [&](const auto& file) {
        Snapshot snapshot = file.read(k);
        if (k + 1 == file.steps().size()) snapshot.note = file.note();
        return snapshot;
      },
      impl_->file);
}

Snapshot read_snapshot(const std::filesystem::path& file, double radius_m, const SnapshotChoice& choice) {
  const SnapshotFile all(file, radius_m);
  return all.read(all.find(choice));
}

}  // namespace granrad
