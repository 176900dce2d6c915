#pragma once
#include <string>
#include <vector>

#include "fit/correlation/correlation.h"

namespace granrad {

/// One finding of a check. A problem makes a table physically wrong; a note is what its user should know.
struct CheckFinding {
  bool problem = false;
  std::string text;
};

/// Looks at a valid table as physics:
///  - upper bounds: F_pp <= the exact two-sphere factor, F_pw <= 1/2. Beyond by more than 10 % of the contact
///    value: problem; by more than 1 % (a least-squares cubic does): note.
///  - walls: how often F_pw exceeds the exact factor of its own wall in the bed below, where it is held: note.
///  - lower bound: where the raw curve is negative: note, or problem when that is at contact.
///  - monotone: a held value that grows with distance by more than 5 % of the contact value: problem; less:
///    note.
///  - neighbours: F_pp at d* = 2 must not grow with solid fraction by more than 5 %: note.
///  - range: cutoffs and solid fractions in which it may be used: note.
///  - closure: row sums of the spheres of a hard-sphere bed in a box of 12.5 x 5 x 25 d, at every solid
///    fraction the bed can be packed to, before any closing. Mean off 1 by more than 25 %: problem; else note.
/// Findings come in the order of the rows.
std::vector<CheckFinding> check_table(const CorrelationTable& table);

}  // namespace granrad
