#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "dem/io/column_names.h"
#include "dem/io/snapshot.h"

namespace granrad {

/// Rows of numbers with named columns, turned into the particles of a Bed: the part that all imports share.
/// Which names are known: ColumnNames; others are left out. SI. The type of dumps counts from 1, the material of
/// the Bed from 0.
class ParticleTable {
 public:
  /// How messages name a row: "FILE:LINE: ", or "FILE: point NUMBER: ".
  enum class RowsAre { lines, points };

  /// `header_line` is where the column names stand (0: nowhere). `radius_m` > 0 serves files without a radius.
  /// Throws InputError with every problem of the names (ColumnNames), or the needed columns that are missing.
  ParticleTable(std::string file, std::size_t header_line, std::vector<std::string> columns, double radius_m,
                RowsAre rows = RowsAre::lines);

  /// Reads one row of as many texts as there are columns; problems are kept for `finish`.
  void add_row(std::size_t line, const std::vector<std::string_view>& fields);
  /// The same of as many numbers.
  void add_row(std::size_t line, const std::vector<double>& numbers);
  /// Records a problem of a line.
  void problem(std::size_t line, const std::string& what);
  /// The particles in ascending id (1, 2, ... in file order when the file has none). Throws InputError with
  /// the first twenty problems.
  Snapshot finish();

 private:
  void refuse_names(std::size_t header_line) const;
  double parsed(std::size_t column, std::size_t line, std::string_view text);
  double checked(Quantity quantity, std::size_t line, double value);
  void add(std::size_t line, const std::vector<double>& values);
  void sort_by_id();
  std::string place(std::size_t line) const;

  std::string file_;
  ColumnNames names_;
  double radius_m_;
  RowsAre rows_;
  std::vector<std::string> problems_;
  std::size_t problem_count_ = 0;
  std::vector<std::size_t> line_;  ///< of each particle, for messages
  std::vector<double> values_;     ///< of one row, by quantity
  Snapshot snapshot_;
};

}  // namespace granrad
