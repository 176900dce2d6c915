#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "dem/base/toml/choice_names.h"

namespace granrad {

class TomlDocument;

/// What a case does. All but `command` are commands of our two programs.
enum class StudyKind { run, validate, measure, trace, fit, command };
inline constexpr ChoiceNames<StudyKind::command> study_kinds;
inline const char* to_string(StudyKind kind) {
  return study_kinds.of(kind);
}

/// One case: one folder below the study's.
struct StudyCase {
  std::string name;   ///< folder: "group/point", "group/point_seed-2"
  std::string point;  ///< the name without the seed: cases of one point are averaged
  std::string group;
  StudyKind kind = StudyKind::run;
  std::filesystem::path scene;
  std::vector<std::string> set, unset;                      ///< "key=value"; keys taken out before
  std::vector<std::pair<std::string, std::string>> varied;  ///< key, value: a column each
  std::string start;                                        ///< run: begins with the last frame of this point
  std::vector<std::string> from;                            ///< trace: runs; fit: traces, by point
  bool quick = false;                                       ///< part of a quick run
  bool skipped = false;                                     ///< known, but not of this run
  std::vector<std::string> quick_set;                       ///< further settings of a quick run
  std::vector<std::string> options;                         ///< further words of the command
};

/// A column of our own: a formula of other columns (see formula.h).
struct StudyColumn {
  std::string name, formula;
};

/// A mean over the particles between two planes of the box, taken from the frames of a run: a quantity of its name.
struct StudyProbe {
  std::string name, group;  ///< group empty: every run
  std::string what;         ///< temperature_K, velocity_m_s (downwards) or count
  int axis = 2;
  double from = 0, to = 0;    ///< from the lower face of the box
  bool in_diameters = false;  ///< from and to are in mean diameters, else in m
  bool last = true;           ///< of the last frame; else the mean over the second half of the frames
};

/// A curve through points of the study, by `vfgen curve`.
struct StudyFit {
  std::string name, x, y, form, group;
  double x_min = 0, x_max = 0;  ///< equal: no limit
};

/// A line of a figure that is not ours: a formula of x.
struct StudyCurve {
  std::string label, formula;
};

struct StudyFigure {
  std::string title, text, x, x_label, y_label;
  std::vector<std::string> y, groups;  ///< columns; groups empty: all that have x
  std::vector<std::string> history;    ///< points: lines of y over time instead, of their first cases
  std::vector<std::string>
      profiles;  ///< points: y (temperature_K, velocity_m_s or solid_fraction) along z instead
  std::vector<std::string> particles;  ///< validated points: distributions of x over the particles instead
  std::string by;                      ///< a varied key: one line each of its values
  bool log_x = false, log_y = false;
  std::vector<StudyCurve> curves;
};

/// A parameter study. File (TOML):
///   [study]   title, scene, kind = "run", set = ["key=value"], unset = ["key"], seeds = [1, 2, 3], seed_key
///   [[vary]]  key = "feed.solid_fraction"           values = [0.07, 0.25]   every combination of all [[vary]]
///   [[vary]]  keys = ["a.T", "b.T"]                 values = [700, 1300]    all keys get the same value
///   [[vary]]  names = ["fine", "coarse"]            set = [["a=1", "b=2"], ["a=3"]]        rows of sets
///   [[case]]  name, set, unset, kind, scene, start, from, options           a single case beside them
///   [[group]] name, and all of the above once more: several base scenes in one study
///   [[column]] name, formula;  [[probe]];  [[fit]];  [[figure]];  [claims] file
/// [sweep] is the old name of [study].
struct Study {
  std::filesystem::path file;
  std::string title;
  std::vector<StudyCase> cases;
  std::vector<StudyColumn> columns;
  std::vector<StudyProbe> probes;
  std::vector<StudyFit> fits;
  std::vector<StudyFigure> figures;
  std::filesystem::path claims;  ///< CSV, see claims.h

  std::vector<const StudyCase*> of_point(const std::string& point) const;
};

/// Throws InputError (every problem), IoError. Scenes are read later, each case for itself.
/// `quick`: cases that are not marked quick = true (a [[vary]] names its quick steps) are skipped, the others get
/// their quick_set last.
Study read_study(const std::filesystem::path& file, bool quick = false);
/// The same of a document; `file` is its name.
Study read_study(TomlDocument& document, const std::filesystem::path& file, bool quick = false);

}  // namespace granrad
