#include "dem/io/import_xyz.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "dem/base/error.h"
#include "dem/io/particle_table.h"

namespace granrad {

namespace {

template <class T>
bool parse(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// KEY=value and KEY="several words" of the second line; names in lower case.
std::map<std::string, std::string> keys_of(std::string_view line) {
  std::map<std::string, std::string> keys;
  for (std::size_t at = 0; at < line.size();) {
    const auto equals = line.find('=', at);
    if (equals == line.npos) break;
    auto begin = line.find_last_of(" \t", equals);
    begin = begin == line.npos || begin < at ? at : begin + 1;
    std::string name(line.substr(begin, equals - begin));
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const bool quoted = equals + 1 < line.size() && line[equals + 1] == '"';
    const auto first = equals + (quoted ? 2 : 1);
    const auto end = std::min(quoted ? line.find('"', first) : line.find_first_of(" \t", first), line.size());
    keys[name] = std::string(line.substr(std::min(first, line.size()), end - std::min(first, line.size())));
    at = end + 1;
  }
  return keys;
}

/// What Properties=pos:R:3:radius:R:1 names, one name a column; texts (S) get names nobody knows.
std::vector<std::string> columns_of(const std::string& properties) {
  if (properties.empty()) return {"(element)", "x", "y", "z"};
  std::vector<std::string_view> parts;
  split_at(':', properties, parts);
  std::vector<std::string> columns;
  for (std::size_t k = 0; k + 2 < parts.size(); k += 3) {
    std::int64_t count = 0;
    if (!parse(parts[k + 2], count) || count < 1 || count > 64) return {};
    const std::string name(parts[k]);
    for (int c = 0; c < count; ++c)
      columns.push_back(parts[k + 1] == "S" ? fmt::format("({})", name)
                        : count == 3        ? fmt::format("{}:{}", name, c)
                        : count == 1        ? name
                                            : fmt::format("({}:{})", name, c));
  }
  return parts.size() % 3 == 0 ? columns : std::vector<std::string>{};
}

class Reader {
 public:
  Reader(const std::string& file, TextLines lines) : file_(file), lines_(std::move(lines)) {}

  struct Cut {
    std::string what;
  };

  /// The two lines before the rows; false at the end.
  bool next_head() {
    std::string_view line;
    do begin_ = lines_.place();
    while (lines_.next(line) && line.empty());
    if (line.empty()) return false;
    if (!parse(line, count_) || count_ < 0)
      fail(fmt::format("\"{}\" (expected the number of particles of an XYZ file)", line));
    if (!lines_.next(line)) throw Cut{"the file ends after the number of particles"};
    keys_ = keys_of(line);
    return true;
  }
  void skip_rows() {
    std::string_view line;
    for (std::int64_t k = 0; k < count_; ++k)
      if (!lines_.next(line)) throw Cut{fmt::format("{} of {} particles", k, count_)};
    if (lines_.at_end() && !lines_.ends_with_newline() && count_ > 0) cut_line_ = true;
  }
  Snapshot read_rows(double radius_m) {
    const auto columns = columns_of(keys_["properties"]);
    if (columns.empty())
      fail(fmt::format("Properties = \"{}\" (must be name:type:number, name:type:number ...)",
                       keys_["properties"]));
    // texts stand in columns that nobody reads
    ParticleTable table(file_, lines_.line_number(), columns, radius_m);
    std::string_view line;
    for (std::int64_t k = 0; k < count_ && lines_.next(line); ++k) {
      split_words(line, words_);
      table.add_row(lines_.line_number(), words_);
    }
    const std::size_t last = lines_.line_number();
    Snapshot snapshot = table.finish();
    read_box(snapshot.bed, last - static_cast<std::size_t>(count_));
    snapshot.bed.step = step();
    const auto time = keys_.find("time");
    if (time != keys_.end() && !parse(time->second, snapshot.bed.time_s)) snapshot.bed.time_s = 0;
    return snapshot;
  }
  std::int64_t step() {
    std::int64_t step = 0;
    for (const char* name : {"timestep", "step", "frame"})
      if (const auto found = keys_.find(name); found != keys_.end() && parse(found->second, step)) break;
    return std::max<std::int64_t>(step, 0);
  }
  TextLines::Place begin() const { return begin_; }
  bool cut_line() const { return cut_line_; }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, lines_.line_number(), what));
  }

  void read_box(Bed& bed, std::size_t line) {
    const auto lattice = keys_.find("lattice");
    if (lattice == keys_.end()) return;
    const auto numbers = [&](const std::string& text, std::size_t count) {
      std::vector<double> values;
      split_words(text, words_);
      for (const auto word : words_)
        if (double v = 0; parse(word, v) && std::isfinite(v)) values.push_back(v);
      if (values.size() != count || words_.size() != count)
        throw InputError(fmt::format("{}:{}: \"{}\" must be {} numbers", file_, line, text, count));
      return values;
    };
    const auto a = numbers(lattice->second, 9);
    for (int k = 0; k < 9; ++k)
      if (k % 4 == 0 ? !(a[static_cast<std::size_t>(k)] > 0) : a[static_cast<std::size_t>(k)] != 0)
        throw InputError(advised(fmt::format("{}:{}: Lattice = \"{}\" (the box is tilted: only upright boxes "
                                             "are read)",
                                             file_, line, lattice->second),
                                 "give x,y,z,radius as CSV"));
    if (const auto origin = keys_.find("origin"); origin != keys_.end()) {
      const auto o = numbers(origin->second, 3);
      bed.box.min = {o[0], o[1], o[2]};
    }
    bed.box.max = bed.box.min + Vec3{a[0], a[4], a[8]};
    bed.periodic = {true, true, true};
    if (const auto pbc = keys_.find("pbc"); pbc != keys_.end()) {
      split_words(pbc->second, words_);
      for (std::size_t axis = 0; axis < 3; ++axis)
        bed.periodic[axis] = axis < words_.size() && (words_[axis].starts_with('T') || words_[axis] == "1");
    }
  }

  std::string file_;
  TextLines lines_;
  TextLines::Place begin_;
  std::int64_t count_ = 0;
  std::map<std::string, std::string> keys_;
  std::vector<std::string_view> words_;
  bool cut_line_ = false;
};

}  // namespace

XyzFile::XyzFile(std::string file, TextLines lines, double radius_m)
    : file_(std::move(file)), lines_(std::move(lines)), radius_m_(radius_m) {
  Reader reader(file_, lines_);
  try {
    while (reader.next_head()) {
      reader.skip_rows();
      if (reader.cut_line() && !steps_.empty()) throw Reader::Cut{"its last line has no end"};
      if (reader.cut_line())
        note_ = fmt::format("{}: the last line has no end; its last number may be cut", file_);
      steps_.push_back(reader.step());
      begins_.push_back(reader.begin());
    }
  } catch (const Reader::Cut& cut) {
    if (steps_.empty()) throw InputError(fmt::format("{}: the snapshot is cut short: {}", file_, cut.what));
    note_ = fmt::format("{}: the last snapshot is not whole ({}); the one before it counts as the last",
                        file_, cut.what);
  }
  if (steps_.empty()) throw InputError(fmt::format("{}: holds no snapshot", file_));
}

Snapshot XyzFile::read(std::size_t k) const {
  Reader reader(file_, lines_.from(begins_[k]));
  reader.next_head();
  return reader.read_rows(radius_m_);
}

}  // namespace granrad
