#include <fmt/core.h>

#include "dem/base/error.h"
#include "fit/vfgen/vfgen_commands.h"
#include "fit/vfgen/vfgen_options.h"

namespace granrad {

namespace {

/// Options of a fit as text, until they are checked.
struct FitText {
  std::string form = "cubic", pairs = "all", wall_distance = "centre_to_plane_over_d", choices = "own";
};

/// The paper's choices, unless an option says otherwise.
FitOptions fit_options(const CLI::App& sub, const FitText& text, FitOptions given) {
  const bool paper = text.choices == "paper";
  FitOptions options = paper ? paper_choices() : FitOptions{};
  const auto asked = [&](const char* option) { return !paper || sub.count(option) > 0; };
  if (asked("--form")) options.form = correlation_form(text.form);
  if (asked("--pairs")) options.visible_only = text.pairs == "visible";
  if (asked("--cutoff")) options.pp_cutoff = given.pp_cutoff;
  if (asked("--fit-walls")) options.walls = given.walls;
  if (asked("--wall-reach")) options.pw_reach = given.pw_reach;
  if (asked("--wall-distance"))
    options.pw_distance = text.wall_distance == "h_plus_r_over_d" ? WallDistance::h_plus_r_over_d
                                                                  : WallDistance::centre_to_plane_over_d;
  if (options.pw_distance == WallDistance::h_plus_r_over_d && !takes_wall_distance_from_surface(options.form))
    throw InputError(advised(
        fmt::format("--wall-distance: h_plus_r_over_d (form {} is defined for h/d)", to_string(options.form)),
        "use --wall-distance centre_to_plane_over_d"));
  return options;
}

}  // namespace

void add_fit(CLI::App& app, Body& body) {
  const auto command = std::make_shared<FitCommand>();
  const auto text = std::make_shared<FitText>();
  auto& sub = *app.add_subcommand("fit", "Correlation table from traced view factors");
  sub.add_option("FILE", command->files, "HDF5 files of vfgen trace; equal solid fractions become one row")
      ->required();
  sub.add_option("-o,--output", command->output, "table, TOML")->required();
  sub.add_option("--form", text->form,
                 "cubic: polynomial in 1/d*; transmittance: exact factor times exp(-a (d*-1)^b)")
      ->check(CLI::IsMember(correlation_form_names()))
      ->capture_default_str();
  sub.add_option("--report", command->report, "HTML page of the fit");
  sub.add_option("--cutoff", command->options.pp_cutoff, "largest d* of a pair")
      ->check(number_in(1.5, largest_pp_cutoff))
      ->capture_default_str();
  sub.add_option("--pairs", text->pairs, "all: invisible pairs count as F = 0; visible: they are left out")
      ->check(CLI::IsMember({"all", "visible"}))
      ->capture_default_str();
  sub.add_option("--fit-walls", command->options.walls,
                 "names of the walls F_pw is fitted on, or all; default: the largest")
      ->delimiter(',');
  sub.add_option("--wall-distance", text->wall_distance, "what d* of a wall is (cubic only: h_plus_r_over_d)")
      ->check(CLI::IsMember({"centre_to_plane_over_d", "h_plus_r_over_d"}))
      ->capture_default_str();
  sub.add_option("--wall-reach", command->options.pw_reach,
                 "walls farther than this h/d are left out of the fit")
      ->check(number_in(1, largest_pw_cutoff))
      ->capture_default_str();
  sub.add_option("--choices", text->choices,
                 "paper: cubic, all pairs, --cutoff 20, --fit-walls all, --wall-distance h_plus_r_over_d, "
                 "--wall-reach 20, where no option says otherwise")
      ->check(CLI::IsMember({"own", "paper"}))
      ->capture_default_str();
  sub.callback([&body, &sub, command, text] {
    body = [&sub, command, text](Verbosity verbosity) {
      command->options = fit_options(sub, *text, command->options);
      return run_fit(*command, verbosity);
    };
  });
}

}  // namespace granrad
