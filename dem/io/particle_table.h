#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "dem/io/snapshot.h"

namespace granrad {

/// Rows of a text file with named columns, turned into the particles of a Bed: the part that CSV and dump
/// files share. Known columns: id, x y z, radius or diameter, temperature (also T, Temp, f_Temp, f_Temp[0]),
/// vx vy vz, omegax omegay omegaz, material (number, from 0); others are ignored. SI.
class ParticleTable {
 public:
  /// `header_line` is where the column names stand. `radius_m` > 0 serves files without a radius. Throws
  /// InputError when a needed column is missing or given twice.
  ParticleTable(std::string file, std::size_t header_line, std::vector<std::string> columns, double radius_m);

  /// Reads one row of as many texts as there are columns; problems are kept for `finish`.
  void add_row(std::size_t line, const std::vector<std::string_view>& fields);
  /// Records a problem of a line.
  void problem(std::size_t line, const std::string& what);
  /// The particles in ascending id (1, 2, ... in file order when the file has none). Throws InputError with
  /// the first twenty problems.
  Snapshot finish();

 private:
  enum Column {
    id,
    x,
    y,
    z,
    radius,
    diameter,
    temperature,
    vx,
    vy,
    vz,
    omegax,
    omegay,
    omegaz,
    material,
    count
  };
  int position_of(const std::vector<const char*>& names, std::size_t header_line);
  double number(Column column, std::size_t line, const std::vector<std::string_view>& fields, double absent);
  void sort_by_id();

  std::string file_;
  std::vector<std::string> names_;
  int at_[count];  ///< position in a row, or -1
  double radius_m_;
  std::vector<std::string> problems_;
  std::size_t problem_count_ = 0;
  std::vector<std::size_t> line_;  ///< of each particle, for messages
  Snapshot snapshot_;
};

}  // namespace granrad
