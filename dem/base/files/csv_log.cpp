#include "dem/base/files/csv_log.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <vector>

#include "dem/base/error.h"
#include "dem/base/files/csv.h"
#include "dem/base/files/text_file.h"

namespace granrad {

namespace {

constexpr double same_time = 1e-9;  // relative: times are written with twelve digits

/// The rows whose time is not after `time_s`, and their times without repetition, from 0.
std::string rows_up_to(const std::string& text, double time_s, std::size_t cells,
                       std::vector<double>& times_s) {
  std::string kept;
  std::size_t start = text.find('\n') + 1;
  for (std::size_t end; (end = text.find('\n', start)) != std::string::npos; start = end + 1) {
    const std::string line = text.substr(start, end - start);
    const double row_s = std::strtod(line.c_str(), nullptr);
    if (split_cells(line).size() != cells || row_s > time_s * (1 + same_time)) continue;
    kept += line + "\n";
    if (row_s != times_s.back()) times_s.push_back(row_s);
  }
  return kept;
}

/// The time before which rows are missing: further from the row before than its neighbours are from theirs. Rows that
/// come at another interval from some time on are no gap.
std::optional<double> after_gap_s(const std::vector<double>& times_s) {
  constexpr double too_far = 1.5;
  for (std::size_t k = 1; k + 1 < times_s.size(); ++k) {
    const double before = k > 1 ? times_s[k - 1] - times_s[k - 2] : 0, after = times_s[k + 1] - times_s[k];
    if (times_s[k] - times_s[k - 1] > too_far * std::max(before, after)) return times_s[k];
  }
  return {};
}

}  // namespace

CsvLog::CsvLog(const std::filesystem::path& file, const std::string& header, double last_row_s)
    : file_(file) {
  std::string rows;
  std::vector<double> times_s{0};
  if (last_row_s > 0 && std::filesystem::exists(file))
    rows = rows_up_to(read_text_file(file), last_row_s, split_cells(header).size(), times_s);
  const double reached_s = times_s.back();
  if (const auto gap_s = after_gap_s(times_s))
    note_ = fmt::format("{}: rows before {:g} s are missing", file.string(), *gap_s);
  if (std::abs(reached_s - last_row_s) > same_time * last_row_s)
    note_ = fmt::format("{}: its rows end at {:g} s, the run goes on at {:g} s: rows between are missing",
                        file.string(), reached_s, last_row_s);
  write_text_file(file, header + "\n" + rows);
}

void CsvLog::append(const std::string& rows) {
  std::FILE* out = std::fopen(file_.c_str(), "ab");
  if (!out) throw IoError(fmt::format("{}: cannot be written", file_.string()));
  const bool written = std::fwrite(rows.data(), 1, rows.size(), out) == rows.size() &&
                       std::fflush(out) == 0 && fsync(fileno(out)) == 0;
  if (std::fclose(out) != 0 || !written) throw IoError(fmt::format("{}: cannot be written", file_.string()));
}

}  // namespace granrad
