#include <fmt/format.h>

#include <cmath>

#include "dem/base/error.h"
#include "dem/base/files/text_file.h"
#include "dem/base/toml/toml_reader.h"
#include "fit/correlation/correlation.h"

namespace granrad {

namespace {

constexpr int file_version = 1;
constexpr const char* provenance_keys[] = {"source", "method", "inputs", "created_by", "note"};

/// Name and place of every number of RowStatistics, for reading and for writing.
struct StatisticsField {
  const char *key, *meaning;
  double RowStatistics::*value;
  bool signed_value = false;
};
constexpr StatisticsField statistics_fields[] = {
    {"snapshots", "snapshots that were fitted", &RowStatistics::snapshots},
    {"pp_samples", "pairs of particles that were fitted", &RowStatistics::pp_samples},
    {"pw_samples", "particles and walls that were fitted", &RowStatistics::pw_samples},
    {"pp_rmse", "rms of fit minus traced F_pp", &RowStatistics::pp_rmse},
    {"pw_rmse", "rms of fit minus traced F_pw", &RowStatistics::pw_rmse},
    {"pp_ray_noise", "part of pp_rmse that is noise of the rays", &RowStatistics::pp_ray_noise},
    {"pw_ray_noise", "part of pw_rmse that is noise of the rays", &RowStatistics::pw_ray_noise},
    {"pp_scatter", "part of pp_rmse that is scatter of the bed", &RowStatistics::pp_scatter},
    {"pw_scatter", "part of pw_rmse that is scatter of the bed", &RowStatistics::pw_scatter},
    {"pp_held_out_rmse", "pp_rmse on snapshots that were not fitted", &RowStatistics::pp_held_out_rmse},
    {"pw_held_out_rmse", "pw_rmse on snapshots that were not fitted", &RowStatistics::pw_held_out_rmse},
    {"pp_left_out_rmse", "pp_rmse of the table without this row, interpolated",
     &RowStatistics::pp_left_out_rmse},
    {"pw_left_out_rmse", "pw_rmse of the table without this row, interpolated",
     &RowStatistics::pw_left_out_rmse},
    {"closure_mean", "mean over particles of the sum of F minus 1", &RowStatistics::closure_mean, true},
    {"closure_rms", "rms of the same", &RowStatistics::closure_rms},
};

RowStatistics read_statistics(TomlTable table) {
  RowStatistics statistics;
  if (!table.present()) return statistics;
  for (const auto& field : statistics_fields)
    statistics.*field.value =
        table.number({field.key, field.meaning}, {.unit = "1", .min = field.signed_value ? -1e300 : 0}, 0);
  const NumberRule error{.unit = "1", .min = 0};
  if (table.has("pp_standard_error"))
    statistics.pp_standard_error =
        table.number_list({"pp_standard_error", "of each coefficient in pp"}, error, 1);
  if (table.has("pw_standard_error"))
    statistics.pw_standard_error =
        table.number_list({"pw_standard_error", "of each coefficient in pw"}, error, 1);
  return statistics;
}

std::vector<double> read_coefficients(TomlTable& row, const char* key, CorrelationForm form,
                                      Partner partner) {
  auto values = row.number_list({key, "coefficients, as many as the form takes"}, {}, 1);
  const auto count = coefficient_count(form, partner);
  if (row.has(key) && values.size() != count)
    row.problem(key, advised(fmt::format("{} coefficients (form \"{}\" takes {})", values.size(),
                                         to_string(form), count),
                             fmt::format("give exactly {}", count)));
  else if (!values.empty())
    if (const auto problem = coefficient_problem(form, partner, values); !problem.empty())
      row.problem(key, problem);
  return values;
}

CorrelationRow read_row(TomlTable& table, CorrelationForm form) {
  CorrelationRow row;
  row.solid_fraction = table.number({"solid_fraction", "volume of particles per volume"},
                                    {.unit = "1",
                                     .min = 0,
                                     .max = 0.7405,
                                     .min_exclusive = true,
                                     .why = "volume of solid per volume; 0.7405 is the densest"});
  row.pp = read_coefficients(table, "pp", form, Partner::sphere);
  row.pw = read_coefficients(table, "pw", form, Partner::wall);
  row.statistics =
      read_statistics(table.table({"statistics", "How well the row fits, as vfgen fit wrote it"}));
  return row;
}

void read_rows(TomlTable& root, CorrelationTable& table) {
  auto rows = root.tables({"row", "Coefficients at one solid fraction; rows ascend"});
  if (rows.empty())
    root.problem("row", advised("no [[row]] (a table needs at least one solid fraction)", "add [[row]]"));
  for (auto& entry : rows) {
    table.rows.push_back(read_row(entry, table.form));
    const auto count = table.rows.size();
    if (count > 1 && entry.has("solid_fraction") &&
        !(table.rows[count - 1].solid_fraction > table.rows[count - 2].solid_fraction))
      entry.problem(
          "solid_fraction",
          advised(fmt::format("{} after {} (rows ascend in solid fraction, each once)",
                              table.rows[count - 1].solid_fraction, table.rows[count - 2].solid_fraction),
                  "sort them"));
  }
}

}  // namespace

CorrelationTable read_correlation(TomlDocument& document, const std::string& name) {
  auto root = document.root();
  CorrelationTable table;
  table.name = name;
  root.choice({"format", "what this file is"}, {"granrad.correlation"});
  root.integer({"version", "of the format"}, 1, file_version);
  table.title = root.string({"title", "what the table describes"}, "");
  table.form = correlation_form(root.choice(
      {"form", "of the correlation; its equations are in docs/equations.md"}, correlation_form_names()));
  root.choice({"pp_distance", "what d* of two particles is; contact at 1"}, {"centre_distance_over_d"});
  table.pw_distance = root.choice({"pw_distance", "what d* of particle and wall is; contact at 0.5, or at 1"},
                                  {"centre_to_plane_over_d", "h_plus_r_over_d"}) == "h_plus_r_over_d"
                          ? WallDistance::h_plus_r_over_d
                          : WallDistance::centre_to_plane_over_d;
  if (!takes_wall_distance_from_surface(table.form) && table.pw_distance == WallDistance::h_plus_r_over_d)
    root.problem("pw_distance",
                 advised(fmt::format("\"h_plus_r_over_d\" (form \"{}\" is defined for h/d, contact at 0.5)",
                                     to_string(table.form)),
                         "use \"centre_to_plane_over_d\""));
  table.pp_cutoff = root.number({"pp_cutoff", "d* of the farthest pair of particles"},
                                {.unit = "1",
                                 .min = 1,
                                 .max = largest_pp_cutoff,
                                 .min_exclusive = true,
                                 .why = "d* of the farthest pair, contact is 1"});
  table.pw_cutoff = root.number({"pw_cutoff", "d* of the farthest wall"}, {.unit = "1",
                                                                           .min = 1,
                                                                           .max = largest_pw_cutoff,
                                                                           .min_exclusive = true,
                                                                           .why = "d* of the farthest wall"});
  table.clip = root.number({"clip", "view factors below are taken as zero"},
                           {.unit = "1", .min = 0, .max = 1e-3, .why = "a view factor is never negative"}, 0);
  read_rows(root, table);
  auto provenance = root.table({"provenance", "Where the numbers come from"});
  for (const char* key : provenance_keys)
    if (provenance.has(key)) table.provenance.emplace_back(key, provenance.string({key, "in words"}));
  document.finish();
  return table;
}

namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += '\\', out += c;
    else if (c == '\n')
      out += "\\n";
    else if (static_cast<unsigned char>(c) < 0x20)
      out += ' ';
    else
      out += c;
  }
  return out + "\"";
}

/// Shortest text that reads back as the same double.
std::string number_text(double v) {
  return fmt::format("{}", v);
}

std::string list_text(const std::vector<double>& values) {
  return fmt::format("[{}]", fmt::join(values, ", "));
}

std::string error_text(const std::vector<double>& errors) {
  return fmt::format("[{:.3g}]", fmt::join(errors, ", "));
}

std::string statistics_text(const RowStatistics& statistics) {
  std::string out;
  for (const auto& field : statistics_fields)
    if (statistics.*field.value != 0) out += fmt::format("{} = {:.5g}\n", field.key, statistics.*field.value);
  if (!statistics.pp_standard_error.empty())
    out += "pp_standard_error = " + error_text(statistics.pp_standard_error) + "\n";
  if (!statistics.pw_standard_error.empty())
    out += "pw_standard_error = " + error_text(statistics.pw_standard_error) + "\n";
  return out.empty() ? "" : "[row.statistics]\n" + out;
}

}  // namespace

CorrelationTable read_correlation(const std::filesystem::path& file) {
  auto document = TomlDocument::from_file(file);
  return read_correlation(document, file.string());
}

CorrelationTable parse_correlation(const std::string& text, const std::string& name) {
  auto document = TomlDocument::from_string(text, name);
  return read_correlation(document, name);
}

std::string correlation_text(const CorrelationTable& table) {
  std::string out = fmt::format(
      "format = \"granrad.correlation\"\nversion = {}\ntitle = {}\nform = \"{}\"\n"
      "pp_distance = \"centre_distance_over_d\"\npw_distance = \"{}\"\npp_cutoff = {}\npw_cutoff = {}\nclip "
      "= {}\n",
      file_version, quoted(table.title), to_string(table.form), to_string(table.pw_distance),
      number_text(table.pp_cutoff), number_text(table.pw_cutoff), number_text(table.clip));
  for (const auto& row : table.rows)
    out +=
        fmt::format("\n[[row]]\nsolid_fraction = {}\npp = {}\npw = {}\n{}", number_text(row.solid_fraction),
                    list_text(row.pp), list_text(row.pw), statistics_text(row.statistics));
  if (!table.provenance.empty()) out += "\n[provenance]\n";
  for (const auto& [key, text] : table.provenance) out += fmt::format("{} = {}\n", key, quoted(text));
  return out;
}

void write_correlation(const std::filesystem::path& file, const CorrelationTable& table) {
  write_text_file(file, correlation_text(table));
}

}  // namespace granrad
