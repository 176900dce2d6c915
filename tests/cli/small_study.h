#pragma once
#include <map>

#include "dem/base/files/csv.h"
#include "granrun.h"

namespace granrad::cli {

using Row = std::map<std::string, std::string>;

inline std::vector<Row> rows(const fs::path& csv) {
  const CsvTable table = read_csv(csv, true);
  std::vector<Row> all;
  for (const auto& cells : table.rows) {
    all.emplace_back();
    for (std::size_t k = 0; k < cells.size(); ++k) all.back()[table.names[k]] = cells[k];
  }
  return all;
}

/// 0.008 s of the small plug, and a study of it.
struct SmallStudy : Scratch {
  fs::path scene = root / "plug.toml", file = root / "study.toml", folder = root / "out";

  SmallStudy() { write("plug.toml", edited(small_plug, "end_time_s = 0.04", "end_time_s = 0.008")); }
  Outcome run(const std::string& study, const std::string& options = "") {
    write("study.toml", study);
    return granrun(*this, "study " + file.string() + " -o " + folder.string() + " --jobs 2 " + options);
  }
};

inline const std::string two_cases =
    "[study]\nscene = \"plug.toml\"\n[[vary]]\nkey = \"material.emissivity\"\nvalues = [0.4, 1]\n";

}  // namespace granrad::cli
