#include "dem/mesh/import_stl.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <set>

#include "dem/base/error.h"
#include "dem/base/files/file_bytes.h"
#include "dem/base/files/text_lines.h"
#include "dem/mesh/mesh_mend.h"

namespace granrad {

namespace {

constexpr std::size_t binary_head = 84, binary_facet = 50;  // bytes; the head ends with the number of facets

/// Whatever its head says: some begin with "solid".
bool is_binary(const std::string& bytes) {
  constexpr std::size_t enough = 512;  // coordinates have bytes of zero, text has none
  return bytes.size() >= binary_head && bytes.substr(0, enough).find('\0') != std::string::npos;
}

/// What follows the last facet belongs to no facet: some programs write more.
Facets read_binary(const std::string& bytes, const std::string& file) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + binary_head - sizeof count, sizeof count);
  const std::size_t whole = (bytes.size() - binary_head) / binary_facet;
  if (whole < count)
    throw InputError(fmt::format("{}: the file is cut short: {} of {} triangles", file, whole, count));
  Facets solid;
  for (std::size_t k = 0; k < count; ++k) {
    float facet[12];  // normal, then corners
    std::memcpy(facet, bytes.data() + binary_head + binary_facet * k, sizeof facet);
    for (int corner = 3; corner < 12; corner += 3)
      solid.corners.push_back({facet[corner], facet[corner + 1], facet[corner + 2]});
  }
  return solid;
}

class TextReader {
 public:
  TextReader(std::string file, std::string text) : file_(std::move(file)), lines_(std::move(text)) {}

  std::vector<Facets> read() {
    std::string_view line;
    while (lines_.next(line)) {
      split_words(line, words_);
      line_ = line;
      if (!words_.empty()) take(lower(words_[0]));
    }
    if (open_) fail("the file ends inside a solid (it is cut short)");
    return std::move(solids_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, lines_.line_number(), what));
  }
  static std::string lower(std::string_view word) {
    std::string text(word);
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
  }

  void take(const std::string& keyword) {
    if (keyword == "solid") {
      solids_.push_back(
          {words_.size() > 1 ? std::string(line_.substr(words_[1].data() - line_.data())) : "", {}});
      open_ = true;
    } else if (!open_) {
      fail("is not an STL file (a text file starts with \"solid\"; a binary one must be whole)");
    } else if (keyword == "vertex") {
      solids_.back().corners.push_back(vertex());
    } else if (keyword == "endfacet") {
      if (solids_.back().corners.size() % 3 != 0) fail("a facet must have three vertices");
    } else if (keyword == "endsolid") {
      open_ = false;
    } else if (keyword != "facet" && keyword != "outer" && keyword != "endloop") {
      fail("is not a line of an STL file");
    }
  }

  Vec3 vertex() const {
    Vec3 v;
    if (words_.size() != 4) fail("a vertex must be three numbers");
    for (int axis = 0; axis < 3; ++axis) {
      std::string_view text = words_[axis + 1];
      if (text.starts_with('+')) text.remove_prefix(1);
      const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), v[axis]);
      if (failure != std::errc{} || end != text.data() + text.size() || !std::isfinite(v[axis]))
        fail(fmt::format("vertex coordinate = {} (must be a finite number)", words_[axis + 1]));
    }
    return v;
  }

  std::string file_;
  TextLines lines_;
  std::string_view line_;
  std::vector<std::string_view> words_;
  std::vector<Facets> solids_;
  bool open_ = false;
};

/// Names differ: a solid without one is called by its number, one called as another gets a number behind.
void name_apart(std::vector<Facets>& solids) {
  std::set<std::string> known;
  for (std::size_t k = 0; k < solids.size(); ++k) {
    const std::string name = solids[k].name.empty() ? fmt::format("{}", k + 1) : solids[k].name;
    solids[k].name = name;
    for (int copy = 2; !known.insert(solids[k].name).second; ++copy)
      solids[k].name = fmt::format("{}_{}", name, copy);
  }
}

}  // namespace

std::vector<Wall> import_stl(const std::filesystem::path& file, double scale, const std::string& name,
                             std::string* note) {
  const std::string bytes = file_bytes(file);
  std::vector<Facets> solids = is_binary(bytes) ? std::vector{read_binary(bytes, file.string())}
                                                : TextReader(file.string(), bytes).read();
  std::erase_if(solids, [](const Facets& solid) { return solid.corners.empty(); });
  name_apart(solids);
  MeshMending mending;
  std::vector<Wall> walls = mended(solids, scale, file.string(), mending);
  if (walls.empty())
    throw InputError(solids.empty() ? fmt::format("{}: has no triangles", file.string())
                                    : fmt::format("{}: no triangle has an area", file.string()));
  for (Wall& wall : walls) wall.name = solids.size() == 1 ? name : fmt::format("{}.{}", name, wall.name);
  if (note) *note = mending.note().empty() ? "" : fmt::format("{}: {}", file.string(), mending.note());
  return walls;
}

}  // namespace granrad
