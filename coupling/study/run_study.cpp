#include "coupling/study/run_study.h"

#include <fmt/core.h>

#include "coupling/study/claims_book.h"
#include "coupling/study/study_page.h"
#include "coupling/study/study_tables.h"
#include "dem/base/error.h"
#include "dem/base/files/text_file.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

void write_results(const Study& study, const fs::path& folder, const StudyOptions& options,
                   const std::string& table_name) {
  const auto rows = collect(study, folder);
  write_text_file(folder / table_name, study_csv(rows));
  const auto curves = fit_curves(study, rows, folder);
  std::vector<Judgement> judged;
  if (!study.claims.empty()) {
    judged = judge(study.claims, study, rows, curves);
    write_text_file(folder / "claims.csv", claims_csv(judged));
  }
  const StudyOutcome outcome{study, folder, rows, curves, judged};
  write_study_page(folder / "report.html", outcome);
  if (!options.book.empty()) write_text_file(options.book, claims_book(outcome));
  if (!options.run.quiet())
    fmt::print("{}   {}\n", (folder / table_name).string(), (folder / "report.html").string());
}

void check_folder(const fs::path& folder) {
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw InputError(advised(fmt::format("-o {} (is a file)", folder.string()), "name a folder"));
}

}  // namespace

void read_study_keys(TomlDocument& document) {
  read_study(document, "study.toml");
}

int run_study(const fs::path& file, const fs::path& folder, const StudyOptions& options,
              const std::string& table_name) {
  const Study study = read_study(file, options.quick);
  check_folder(folder);
  if (!options.only.empty()) {
    bool known = false;
    for (const auto& one : study.cases) known = known || one.name == options.only;
    if (!known)
      throw InputError(fmt::format("--case {}: there is no such case; --list names them", options.only));
    return run_cases(study, folder, options);
  }
  if (options.list_only) {
    write_job_files(study, folder);
    if (!options.run.quiet())
      fmt::print("{} cases; one command a line in {}\n", study.cases.size(), (folder / "jobs.txt").string());
    return exit_ok;
  }
  const int code = run_cases(study, folder, options);
  write_job_files(study, folder);
  write_results(study, folder, options, table_name);
  return code;
}

}  // namespace granrad
