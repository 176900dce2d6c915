#include "coupling/study/study_outputs.h"

#include "dem/base/constants.h"

namespace granrad {

namespace {

StudyFigure read_figure(TomlTable table) {
  StudyFigure figure;
  figure.title = table.string({"title", "heads the figure"});
  figure.text = table.string({"text", "a sentence below it"}, "");
  figure.x = table.string({"x", "column of x; with particles, the quantity distributed"});
  figure.y = table.string_list({"y", "columns, one line each"}, 1);
  figure.x_label = table.string({"x_label", "of the axis", "x"}, figure.x);
  figure.y_label =
      table.string({"y_label", "of the axis", "the first y"}, figure.y.empty() ? "" : figure.y.front());
  figure.groups = table.string_list({"groups", "whose cases are shown", "all that have x"});
  figure.history = table.string_list({"history", "cases whose history is shown: y over time"});
  figure.profiles = table.string_list(
      {"profiles", "cases whose last frame is shown: temperature_K, velocity_m_s or solid_fraction along z"});
  figure.particles =
      table.string_list({"particles", "validated cases whose particles are shown: distributions of x"});
  figure.by = table.string({"by", "a varied key: one line for each of its values"}, "");
  figure.log_x = table.boolean({"log_x", "logarithmic axis"}, false);
  figure.log_y = table.boolean({"log_y", "logarithmic axis"}, false);
  for (auto& curve : table.tables({"curve", "A line that is not ours: what others state"}))
    figure.curves.push_back({curve.string({"label", "of the line"}), curve.string({"formula", "of x"})});
  return figure;
}

StudyProbe read_probe(TomlTable table) {
  StudyProbe probe;
  probe.name = table.string({"name", "of the quantity"});
  probe.group = table.string({"group", "whose runs have it", "all"}, "");
  probe.what = table.choice({"what", "mean over the particles, velocity downwards; or their number"},
                            {"temperature_K", "velocity_m_s", "count"}, "temperature_K");
  probe.axis = table.choice({"axis", "across the planes"}, {"x", "y", "z"}, "z").front() - 'x';
  probe.in_diameters = table.has("from_diameters") || table.has("to_diameters");
  const double from_m =
      table.number({"from_m", "lower plane, from the lower face of the box", "the face"}, {.unit = "m"}, 0);
  const double to_m = table.number({"to_m", "upper plane", "no limit"}, {.unit = "m"}, infinity);
  const double from_d = table.number({"from_diameters", "the same in mean diameters"}, {}, 0);
  const double to_d = table.number({"to_diameters", "the same in mean diameters"}, {}, infinity);
  probe.from = probe.in_diameters ? from_d : from_m;
  probe.to = probe.in_diameters ? to_d : to_m;
  probe.last = table.choice({"frames", "the last, or the mean over the second half"}, {"last", "second_half"},
                            "last") == "last";
  if (!(probe.to > probe.from)) table.problem("", "a probe needs from < to");
  return probe;
}

StudyFit read_fit(TomlTable table) {
  StudyFit fit;
  fit.name = table.string({"name", "by which claims refer to it"});
  fit.x = table.string({"x", "column of x"});
  fit.y = table.string({"y", "column of y"});
  fit.form = table.choice(
      {"form",
       "power: a x^b; line: a + b x; logarithm: a ln(b x); exponential_logarithm: a e^(b x) + c ln(d x)"},
      {"power", "line", "logarithm", "exponential_logarithm"});
  fit.group = table.string({"group", "whose cases are fitted", "all"}, "");
  fit.x_min = table.number({"x_min", "points below are left out", "no limit"}, {}, 0);
  fit.x_max = table.number({"x_max", "points above are left out", "no limit"}, {}, 0);
  return fit;
}

}  // namespace

void read_outputs(TomlTable& root, Study& study) {
  for (auto& column : root.tables({"column", "A further column of study.csv"}))
    study.columns.push_back({column.string({"name", "of the column"}),
                             column.string({"formula", "of other columns; errors are carried through it"})});
  for (auto& probe :
       root.tables({"probe", "A quantity of runs: a mean over the particles between two planes of the box"}))
    study.probes.push_back(read_probe(probe));
  for (auto& fit : root.tables({"fit", "A curve through two columns, by vfgen curve"}))
    study.fits.push_back(read_fit(fit));
  for (auto& figure : root.tables({"figure", "A figure of the page"}))
    study.figures.push_back(read_figure(figure));
  if (auto claims = root.table({"claims", "Numbers of others beside ours"}); claims.present())
    study.claims = claims.file({"file", "CSV of claims (docs/study.md)"}, true);
}

}  // namespace granrad
