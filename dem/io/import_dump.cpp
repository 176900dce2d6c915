#include "dem/io/import_dump.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "dem/base/error.h"
#include "dem/base/text_lines.h"
#include "dem/io/particle_table.h"

namespace granrad {

namespace {

constexpr std::string_view item = "ITEM: ";

class DumpReader {
 public:
  DumpReader(const std::filesystem::path& file, double radius_m)
      : file_(file.string()), radius_m_(radius_m), lines_(file) {}

  Snapshot read() {
    std::optional<Snapshot> last;
    std::string_view line;
    while (lines_.next(line)) {
      if (line.empty()) continue;
      if (!line.starts_with(item))
        fail(fmt::format("\"{}\" (expected a line that starts with \"ITEM: \")", line));
      line.remove_prefix(item.size());
      if (line == "TIMESTEP")
        step_ = static_cast<std::int64_t>(number_line("the step"));
      else if (line == "TIME")
        time_s_ = number_line("the time");
      else if (line == "NUMBER OF ATOMS")
        atoms_ = static_cast<std::int64_t>(number_line("the number of atoms"));
      else if (line == "UNITS")
        read_units();
      else if (line.starts_with("BOX BOUNDS"))
        read_bounds(line.substr(10));
      else if (line.starts_with("ATOMS"))
        last = read_atoms(line.substr(5));
      else
        lines_.next(line);  // an item we do not know: skip its value (units and the like)
    }
    if (!last) throw InputError(fmt::format("{}: holds no snapshot (no \"ITEM: ATOMS\")", file_));
    return std::move(*last);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, lines_.line_number(), what));
  }
  static bool parse(std::string_view text, double& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
  }
  double number_line(const char* what) {
    std::string_view line;
    double value = 0;
    if (!lines_.next(line)) fail(fmt::format("the file ends before {}", what));
    if (!parse(line, value) || value < 0)
      fail(fmt::format("{} = \"{}\" (must be a number >= 0)", what, line));
    return value;
  }

  /// SI, or numbers of the user's own making; others would be wrong by powers of ten.
  void read_units() {
    std::string_view line;
    if (lines_.next(line) && line != "si" && line != "lj")
      fail(fmt::format("units = \"{}\" (lengths must be in metres) convert the dump to SI", line));
  }

  void read_bounds(std::string_view flags) {
    split_words(flags, words_);
    const bool triclinic = words_.size() == 6 && words_[0] == "xy";
    if (triclinic) words_.erase(words_.begin(), words_.begin() + 3);
    for (int axis = 0; axis < 3; ++axis) periodic_[axis] = words_.size() == 3 && words_[axis] == "pp";
    for (int axis = 0; axis < 3; ++axis) {
      std::string_view line;
      if (!lines_.next(line)) fail("the file ends inside the box bounds");
      split_words(line, words_);
      if (double tilt = 0; triclinic && words_.size() == 3) {
        if (!parse(words_[2], tilt) || tilt != 0)
          fail(fmt::format("\"{}\" (the box is tilted: only upright boxes are read) give x,y,z,radius as CSV",
                           line));
        words_.pop_back();
      }
      if (words_.size() != 2 || !parse(words_[0], box_.min[axis]) || !parse(words_[1], box_.max[axis]) ||
          box_.max[axis] < box_.min[axis])
        fail(fmt::format("\"{}\" (box bounds must be two rising numbers)", line));
    }
  }

  /// Where x or xu is absent: xs or xsu, a part of the box, becomes x.
  static bool take_scaled(std::vector<std::string>& columns, const std::string& x) {
    const auto place = [&](const std::string& name) {
      return std::find(columns.begin(), columns.end(), name);
    };
    if (place(x) != columns.end() || place(x + "u") != columns.end()) return false;
    const auto wrapped = place(x + "s"), at = wrapped != columns.end() ? wrapped : place(x + "su");
    if (at == columns.end()) return false;
    *at = x;
    return true;
  }

  Snapshot read_atoms(std::string_view header) {
    if (atoms_ < 0) fail("ITEM: ATOMS stands before ITEM: NUMBER OF ATOMS");
    split_words(header, words_);
    std::vector<std::string> columns(words_.begin(), words_.end());
    std::array<bool, 3> scaled{};
    for (int axis = 0; axis < 3; ++axis) scaled[axis] = take_scaled(columns, std::string(1, "xyz"[axis]));
    ParticleTable table(file_, lines_.line_number(), std::move(columns), radius_m_);
    std::string_view line;
    for (std::int64_t k = 0; k < atoms_; ++k) {
      if (!lines_.next(line) || line.starts_with(item))
        fail(fmt::format("the snapshot is cut short: {} of {} atoms", k, atoms_));
      split_words(line, words_);
      table.add_row(lines_.line_number(), words_);
    }
    Snapshot snapshot = table.finish();
    Bed& bed = snapshot.bed;
    for (int axis = 0; axis < 3; ++axis)
      if (scaled[axis])
        for (auto& p : bed.position_m) p[axis] = box_.min[axis] + p[axis] * box_.size()[axis];
    bed.box = box_;
    bed.periodic = periodic_;
    bed.step = step_;
    bed.time_s = time_s_;
    atoms_ = -1;
    return snapshot;
  }

  std::string file_;
  double radius_m_;
  TextLines lines_;
  std::vector<std::string_view> words_;
  std::int64_t step_ = 0, atoms_ = -1;
  double time_s_ = 0;
  Box box_;
  std::array<bool, 3> periodic_{};
};

}  // namespace

Snapshot import_dump(const std::filesystem::path& file, double radius_m) {
  return DumpReader(file, radius_m).read();
}

}  // namespace granrad
