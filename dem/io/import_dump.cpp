#include "dem/io/import_dump.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "dem/base/error.h"
#include "dem/io/particle_table.h"

namespace granrad {

namespace {

constexpr std::string_view item = "ITEM: ";
constexpr double most_steps = 9e15;  // a double holds every whole number below

bool parse(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

/// Where x or xu is absent: xs or xsu, a part of the box, becomes x.
bool take_scaled(std::vector<std::string>& columns, const std::string& x) {
  const auto place = [&](const std::string& name) { return std::find(columns.begin(), columns.end(), name); };
  if (place(x) != columns.end() || place(x + "u") != columns.end()) return false;
  const auto wrapped = place(x + "s"), at = wrapped != columns.end() ? wrapped : place(x + "su");
  if (at == columns.end()) return false;
  *at = x;
  return true;
}

}  // namespace

/// What stands before the rows of a snapshot.
struct DumpFile::Header {
  std::int64_t step = 0, atoms = -1;
  double time_s = 0;
  Box box;
  std::array<bool, 3> periodic{};
  std::string columns;
};

/// Reads on from a place of the file.
class DumpFile::Reader {
 public:
  Reader(std::string file, TextLines lines) : file_(std::move(file)), lines_(std::move(lines)) {}

  /// Up to the rows of the next snapshot; false at the end of the file.
  bool next_header(Header& header) {
    header.atoms = -1;
    std::string_view line;
    begin_ = {};
    for (auto before = lines_.place(); lines_.next(line); before = lines_.place()) {
      if (line.empty() || (line.front() == '#' && !begin_)) continue;
      if (lines_.at_end() && !lines_.ends_with_newline() && item.starts_with(line))
        cut("the file ends before ITEM: ATOMS");
      if (!line.starts_with(item))
        fail(fmt::format("\"{}\" (expected a line that starts with \"ITEM: \")", line));
      if (!begin_) begin_ = before;
      line.remove_prefix(item.size());
      if (line.starts_with("ATOMS")) {
        if (header.atoms < 0) fail("ITEM: ATOMS stands before ITEM: NUMBER OF ATOMS");
        header.columns = line.substr(5);
        return true;
      }
      take(line, header);
    }
    if (begin_) cut("the file ends before ITEM: ATOMS");
    return false;
  }

  /// Passes over the rows.
  void skip_rows(const Header& header) {
    std::string_view line;
    for (std::int64_t k = 0; k < header.atoms; ++k) {
      if (!lines_.next(line)) cut(fmt::format("{} of {} atoms", k, header.atoms));
      if (line.starts_with(item))
        fail(fmt::format("the snapshot is cut short: {} of {} atoms", k, header.atoms));
    }
  }

  Snapshot read_rows(const Header& header, double radius_m) {
    split_words(header.columns, words_);
    std::vector<std::string> columns(words_.begin(), words_.end());
    std::array<bool, 3> scaled{};
    for (int axis = 0; axis < 3; ++axis) scaled[axis] = take_scaled(columns, std::string(1, "xyz"[axis]));
    ParticleTable table(file_, lines_.line_number(), std::move(columns), radius_m);
    std::string_view line;
    for (std::int64_t k = 0; k < header.atoms && lines_.next(line); ++k) {
      split_words(line, words_);
      table.add_row(lines_.line_number(), words_);
    }
    Snapshot snapshot = table.finish();
    Bed& bed = snapshot.bed;
    for (int axis = 0; axis < 3; ++axis)
      if (scaled[axis])
        for (auto& p : bed.position_m) p[axis] = header.box.min[axis] + p[axis] * header.box.size()[axis];
    bed.box = header.box;
    bed.periodic = header.periodic;
    bed.step = header.step;
    bed.time_s = header.time_s;
    return snapshot;
  }

  TextLines::Place begin() const { return *begin_; }
  bool at_cut_line() const { return lines_.at_end() && !lines_.ends_with_newline(); }

  /// Thrown where the file ends inside a snapshot.
  struct Cut {
    std::string where, what;
  };

 private:
  std::string here() const { return fmt::format("{}:{}", file_, lines_.line_number()); }
  /// A line that ends with the file, without a newline, may not be all there.
  [[noreturn]] void fail(const std::string& what) const {
    if (at_cut_line()) throw Cut{here(), what};
    throw InputError(fmt::format("{}: {}", here(), what));
  }
  [[noreturn]] void cut(const std::string& what) const {
    throw Cut{here(), "the snapshot is cut short: " + what};
  }

  std::string_view value_line(const char* of) {
    std::string_view line;
    if (!lines_.next(line)) cut(fmt::format("the file ends before {}", of));
    return line;
  }
  double number_line(const char* of) {
    const std::string_view line = value_line(of);
    double value = 0;
    if (!parse(line, value) || value < 0) fail(fmt::format("{} = \"{}\" (must be a number >= 0)", of, line));
    return value;
  }
  std::int64_t whole_line(const char* of) {
    const double value = number_line(of);
    if (value > most_steps || value != std::floor(value))
      fail(fmt::format("{} = {} (must be a whole number below 9e15)", of, value));
    return static_cast<std::int64_t>(value);
  }

  void take(std::string_view name, Header& header) {
    if (name == "TIMESTEP")
      header.step = whole_line("the step");
    else if (name == "TIME")
      header.time_s = number_line("the time");
    else if (name == "NUMBER OF ATOMS")
      header.atoms = whole_line("the number of atoms");
    else if (name == "UNITS")
      read_units();
    else if (name.starts_with("BOX BOUNDS"))
      read_bounds(name.substr(10), header);
    else
      value_line("the value of an ITEM");  // one we do not know
  }

  /// SI, or numbers of the user's own making; others would be wrong by powers of ten.
  void read_units() {
    const std::string_view line = value_line("the units");
    if (line != "si" && line != "lj")
      fail(
          advised(fmt::format("units = \"{}\" (lengths must be in metres)", line), "convert the dump to SI"));
  }

  void read_bounds(std::string_view flags, Header& header) {
    split_words(flags, words_);
    const bool triclinic = words_.size() == 6 && words_[0] == "xy";
    if (triclinic) words_.erase(words_.begin(), words_.begin() + 3);
    for (int axis = 0; axis < 3; ++axis) header.periodic[axis] = words_.size() == 3 && words_[axis] == "pp";
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view line = value_line("the end of the box bounds");
      split_words(line, words_);
      if (double tilt = 0; triclinic && words_.size() == 3) {
        if (!parse(words_[2], tilt) || tilt != 0)
          fail(advised(fmt::format("\"{}\" (the box is tilted: only upright boxes are read)", line),
                       "give x,y,z,radius as CSV"));
        words_.pop_back();
      }
      Box& box = header.box;
      if (words_.size() != 2 || !parse(words_[0], box.min[axis]) || !parse(words_[1], box.max[axis]) ||
          box.max[axis] < box.min[axis])
        fail(fmt::format("\"{}\" (box bounds must be two rising numbers)", line));
    }
  }

  std::string file_;
  TextLines lines_;
  std::vector<std::string_view> words_;
  std::optional<TextLines::Place> begin_;
};

DumpFile::DumpFile(const std::filesystem::path& file, std::string text, double radius_m)
    : file_(file.string()), lines_(std::move(text)), radius_m_(radius_m) {
  Reader reader(file_, lines_);
  Header header;
  try {
    while (reader.next_header(header)) {
      reader.skip_rows(header);
      if (reader.at_cut_line() && header.atoms > 0 && !steps_.empty())
        throw Reader::Cut{file_, "its last line has no end"};
      if (reader.at_cut_line() && header.atoms > 0)
        note_ = fmt::format("{}: the last line has no end; its last number may be cut", file_);
      steps_.push_back(header.step);
      begins_.push_back(reader.begin());
    }
  } catch (const Reader::Cut& cut) {
    if (steps_.empty()) throw InputError(fmt::format("{}: {}", cut.where, cut.what));
    note_ = fmt::format(
        "{}: the last snapshot is not whole ({}); the one before it, of step {}, counts as the last", file_,
        cut.what, steps_.back());
  }
  if (steps_.empty()) throw InputError(fmt::format("{}: holds no snapshot (no \"ITEM: ATOMS\")", file_));
}

Snapshot DumpFile::read(std::size_t k) const {
  Reader reader(file_, lines_.from(begins_[k]));
  Header header;
  reader.next_header(header);
  return reader.read_rows(header, radius_m_);
}

}  // namespace granrad
